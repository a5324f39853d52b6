//! What a surface does with light beyond its material: whether it casts shadows, takes them, and how dense its texels
//! are.
//!
//! A file says it in `extras`, which most programs that write glTF call custom properties:
//!
//! | key | value | what it means |
//! |---|---|---|
//! | `sunbake_leave_out` | true or false | not there at all: not drawn, not baked, casts nothing |
//! | `sunbake_no_cast` | true or false | drawn and baked, and lets all light through |
//! | `sunbake_no_receive` | true or false | drawn, and casts; nothing shades it, and it has no texels |
//! | `sunbake_density` | 0.000001 to 1000000 | texels a metre, whatever the scene's density is |
//! | `sunbake_density_around` | the same | at least as many, on it and on what is within its own size of it |
//!
//! They stand on a node, a mesh or a material. A node's hold for all nodes below it. What is nearest to the surface's
//! place decides: the node's own, then those of the nodes above it, then the mesh's, then the material's. A material
//! that transmits light starts out as neither casting nor taking shadows.

use super::document::{Document, JsonMaterial, JsonMesh, JsonNode, ListItem, place};
use super::{Alpha, LoadError, Scene};
use serde_json::{Map, Value};

/// What a surface does with light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Role {
    /// Whether it hides the light from what lies behind it.
    pub casts: bool,
    /// Whether others shade it. What takes no shadows has no texels: it is lit wherever it faces the light.
    pub receives: bool,
    /// Texels a metre, if not the scene's.
    pub texels_per_metre: Option<f64>,
    /// Least texels a metre on it and on all triangles nearer to its box than the box is long: where its shadow falls.
    /// Meshes that several nodes draw, and those with a `TEXCOORD_1` of their own that is kept, stay as they are.
    pub texels_per_metre_around: Option<f64>,
}

impl Default for Role {
    fn default() -> Self {
        Self { casts: true, receives: true, texels_per_metre: None, texels_per_metre_around: None }
    }
}

impl Scene {
    /// Whether an instance is there at all: its material is not [`Alpha::Invisible`].
    pub fn is_there(&self, instance: usize) -> bool {
        self.material(instance).alpha != Alpha::Invisible
    }

    /// Whether an instance hides light.
    pub fn casts(&self, instance: usize) -> bool {
        self.is_there(instance) && self.instances[instance].role.casts
    }

    /// Whether an instance can be shaded, and so has texels.
    pub fn receives(&self, instance: usize) -> bool {
        self.is_there(instance) && self.instances[instance].role.receives
    }
}

/// What extras, or their absence, say of a place.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Wishes {
    leave_out: Option<bool>,
    no_cast: Option<bool>,
    no_receive: Option<bool>,
    density: Option<f64>,
    density_around: Option<f64>,
}

impl Wishes {
    /// These, and what they leave open from what is farther away.
    fn or(self, farther: Self) -> Self {
        Self {
            leave_out: self.leave_out.or(farther.leave_out),
            no_cast: self.no_cast.or(farther.no_cast),
            no_receive: self.no_receive.or(farther.no_receive),
            density: self.density.or(farther.density),
            density_around: self.density_around.or(farther.density_around),
        }
    }
}

/// The start of our keys.
const PREFIX: &str = "sunbake_";

/// Sets the roles of a scene's instances, and takes out what its file leaves out.
///
/// # Errors
///
/// If one of our keys is unknown, or its value of the wrong kind.
pub(super) fn read(doc: &Document, scene: &mut Scene) -> Result<(), LoadError> {
    let mut of_node: Vec<Wishes> = Vec::with_capacity(scene.nodes.len());
    for node in &scene.nodes {
        let above = node.parent.and_then(|parent| of_node.get(parent)).copied().unwrap_or_default();
        of_node.push(wishes::<JsonNode>(doc, Some(node.gltf))?.or(above));
    }
    let of_mesh = scene.meshes.iter().map(|mesh| wishes::<JsonMesh>(doc, Some(mesh.gltf.0)));
    let of_mesh = of_mesh.collect::<Result<Vec<_>, _>>()?;
    let of_material = scene.materials.iter().map(|material| wishes::<JsonMaterial>(doc, material.gltf));
    let of_material = of_material.collect::<Result<Vec<_>, _>>()?;
    let mut left_out = Vec::new();
    for (index, instance) in scene.instances.iter_mut().enumerate() {
        let material = scene.meshes[instance.mesh].material;
        let wishes = of_node[instance.node].or(of_mesh[instance.mesh]).or(of_material[material]);
        let is_clear = scene.materials[material].is_clear;
        instance.role = Role {
            casts: !wishes.no_cast.unwrap_or(is_clear),
            receives: !wishes.no_receive.unwrap_or(is_clear),
            texels_per_metre: wishes.density,
            texels_per_metre_around: wishes.density_around,
        };
        if wishes.leave_out == Some(true) {
            left_out.push(index);
        }
    }
    scene.turn_into_air(&left_out);
    Ok(())
}

/// What the extras of an item of the file ask for.
fn wishes<T: ListItem>(doc: &Document, index: Option<usize>) -> Result<Wishes, LoadError> {
    let mut wishes = Wishes::default();
    let Some((index, extras)) = index.and_then(|index| Some((index, doc.extras::<T>(index)?))) else {
        return Ok(wishes);
    };
    for (key, value) in ours(extras) {
        let wrong = |problem: String| LoadError::Extras { place: place::<T>(index), key: key.clone(), problem };
        let flag = || flag(value).ok_or_else(|| wrong(format!("it is {value}, where true or false is meant")));
        let density = || {
            let density = value.as_f64().filter(|density| is_density(*density));
            density.ok_or_else(|| {
                wrong(format!("it is {value}, and no number of texels a metre from 0.000001 to 1000000"))
            })
        };
        match key.strip_prefix(PREFIX).unwrap_or_default() {
            "leave_out" => wishes.leave_out = Some(flag()?),
            "no_cast" => wishes.no_cast = Some(flag()?),
            "no_receive" => wishes.no_receive = Some(flag()?),
            "density" => wishes.density = Some(density()?),
            "density_around" => wishes.density_around = Some(density()?),
            _ => {
                let known = "leave_out, no_cast, no_receive, density and density_around";
                return Err(wrong(format!("there is none of that name, only {PREFIX} with {known}")));
            }
        }
    }
    let Wishes { no_cast, no_receive, density, density_around, .. } = wishes;
    let is_changed = no_cast == Some(true) || no_receive == Some(true) || density.or(density_around).is_some();
    let is_nothing = wishes.leave_out == Some(true) && is_changed;
    match is_nothing {
        true => Err(LoadError::Extras {
            place: place::<T>(index),
            key: format!("{PREFIX}leave_out"),
            problem: "it leaves out what the other keys beside it would change".into(),
        }),
        false => Ok(wishes),
    }
}

fn ours(extras: &Map<String, Value>) -> impl Iterator<Item = (&String, &Value)> {
    extras.iter().filter(|(key, _)| key.starts_with(PREFIX))
}

/// Some programs store true and false as 1 and 0.
fn flag(value: &Value) -> Option<bool> {
    value.as_bool().or_else(|| match value.as_f64()? {
        0.0 => Some(false),
        1.0 => Some(true),
        _ => None,
    })
}

/// Texels a metre that make sense: from one in a thousand kilometres to one in a thousandth of a millimetre.
const DENSITIES: std::ops::RangeInclusive<f64> = 1e-6..=1e6;

/// Whether a number of texels a metre makes sense: from 0.000001 to 1000000.
pub fn is_density(texels_per_metre: f64) -> bool {
    DENSITIES.contains(&texels_per_metre)
}
