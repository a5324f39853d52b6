//! How materials look, beyond what shadows depend on: metal, roughness, normal maps, emission, blending.
//!
//! Based on: Khronos Group, *glTF 2.0 Specification*, section 3.9, and the extensions `KHR_materials_transmission` and
//! `KHR_materials_unlit`.
//!
//! They are read on demand, from the file that a scene keeps, by what draws. A bake reads none of them, so its time and
//! memory do not depend on them. Nothing here fails: what cannot be read is left out with a warning.
//!
//! Not read: the occlusion texture (a bake brings its own), clear coat, sheen, index of refraction and the like. The
//! older specular-glossiness model keeps its diffuse colour and has no highlights. A transmission texture is not read:
//! the factor holds everywhere.

use super::{
    Image, LoadLimits, Material, Mesh, Scene, SceneWarning, TextureRef,
    accessors::Reader,
    document::{Document, JsonMesh, JsonNode, ListItem, TextureInfo, place},
    images::{self, Decoded},
    limits::{MemoryBudget, WarningLog},
    materials::texture_ref,
};
use glam::Vec4;
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};

/// The looks of a scene.
#[derive(Debug, Clone, Default)]
pub struct Looks {
    /// One for each of [`Scene::materials`].
    pub materials: Vec<Look>,
    /// One for each of [`Scene::meshes`].
    pub meshes: Vec<MeshLook>,
    /// Decoded images, only those that some look uses. Their alpha is 255.
    pub images: Vec<Image>,
    /// What could not be read.
    pub warnings: Vec<SceneWarning>,
}

/// How a material looks. Where a texture is named, its image is an index in [`Looks::images`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Look {
    /// From 0, not metallic, to 1.
    pub metallic: f32,
    /// From 0, a mirror, to 1.
    pub roughness: f32,
    /// Multiplied with both: roughness in green, metal in blue. Linear.
    pub metallic_roughness_texture: Option<TextureRef>,
    /// Normals in tangent space. Linear.
    pub normal_texture: Option<TextureRef>,
    /// Scale of the x and y of these normals.
    pub normal_scale: f32,
    /// Multiplied with [`Material::emissive`]. sRGB.
    pub emissive_texture: Option<TextureRef>,
    /// Share of the light behind it that a surface lets through, from 0 to 1.
    pub transmission: f32,
    /// Whether the file says `BLEND`.
    pub says_blend: bool,
}

/// How a mesh looks.
#[derive(Debug, Clone, Default)]
pub struct MeshLook {
    /// Whether it is blended with what lies behind: some of it is seen through. To shadows, what is at least half
    /// opaque is solid.
    pub is_blended: bool,
    /// For each vertex, the file's unit tangent in object space, and 1 or -1: the bitangent is the cross product of
    /// normal and tangent, times that. None where there is no normal map, or the file has no tangents for it.
    pub tangents: Option<Vec<Vec4>>,
}

impl Look {
    /// What a surface without metal and highlights has.
    pub const PLAIN: Self = Self {
        metallic: 0.0,
        roughness: 1.0,
        metallic_roughness_texture: None,
        normal_texture: None,
        normal_scale: 1.0,
        emissive_texture: None,
        transmission: 0.0,
        says_blend: false,
    };

    /// Whether it only scatters light. The specification gives the roughest of surfaces that are not metallic a
    /// highlight of less than a hundredth of the light, and it is left out.
    pub fn is_diffuse(&self) -> bool {
        self.metallic_roughness_texture.is_none() && self.metallic == 0.0 && self.roughness >= 1.0
    }
}

impl Looks {
    /// Plain looks: every surface is solid, and only scatters light.
    pub fn plain(scene: &Scene) -> Self {
        Self {
            materials: vec![Look::PLAIN; scene.materials.len()],
            meshes: vec![MeshLook::default(); scene.meshes.len()],
            ..Self::default()
        }
    }

    /// The looks of a loaded scene. A scene made by code has plain ones. Images are decoded within `limits`.
    pub fn read(scene: &Scene, limits: &LoadLimits) -> Self {
        let Some(file) = &scene.file else { return Self::plain(scene) };
        let (doc, buffers, pictures) = file.parts();
        let mut log = WarningLog::default();
        let mut materials: Vec<Look> = scene.materials.iter().map(|material| look(doc, material, &mut log)).collect();
        let needed: BTreeSet<usize> = materials.iter_mut().flat_map(textures).map(|texture| texture.image).collect();
        let budget = MemoryBudget::new(limits);
        let (mut images, decoded) = images::read_what_can_be(doc, buffers, pictures, &budget, &needed);
        images.iter_mut().flat_map(|image| &mut image.rgba).for_each(|texel| texel[3] = 255);
        for look in &mut materials {
            finish(look, &decoded, &mut log);
        }
        let reader = Reader { doc, buffers, budget: &budget };
        let mesh = |mesh: &Mesh| mesh_look(scene, reader, mesh, &materials[mesh.material], &mut log);
        let meshes = scene.meshes.iter().map(mesh).collect();
        Self { materials, meshes, images, warnings: log.into_warnings() }
    }
}

/// The textures that a look names.
fn textures(look: &mut Look) -> impl Iterator<Item = &mut TextureRef> {
    let Look { metallic_roughness_texture, normal_texture, emissive_texture, .. } = look;
    [metallic_roughness_texture, normal_texture, emissive_texture].into_iter().flatten()
}

#[derive(Deserialize, Default)]
#[serde(rename_all = "camelCase", default)]
struct JsonLook {
    pbr_metallic_roughness: JsonMetal,
    normal_texture: Option<JsonNormalMap>,
    emissive_texture: Option<TextureInfo>,
    alpha_mode: Option<String>,
    extensions: JsonLookExtensions,
}

#[derive(Deserialize, Default)]
#[serde(rename_all = "camelCase", default)]
struct JsonMetal {
    metallic_factor: Option<f32>,
    roughness_factor: Option<f32>,
    metallic_roughness_texture: Option<TextureInfo>,
    base_color_factor: Option<serde::de::IgnoredAny>,
    base_color_texture: Option<serde::de::IgnoredAny>,
}

#[derive(Deserialize)]
struct JsonNormalMap {
    scale: Option<f32>,
    #[serde(flatten)]
    texture: TextureInfo,
}

#[derive(Deserialize, Default)]
#[serde(default)]
struct JsonLookExtensions {
    #[serde(rename = "KHR_materials_unlit")]
    unlit: Option<serde::de::IgnoredAny>,
    #[serde(rename = "KHR_materials_transmission")]
    transmission: Option<JsonTransmission>,
    #[serde(rename = "KHR_materials_pbrSpecularGlossiness")]
    specular_glossiness: Option<serde::de::IgnoredAny>,
}

#[derive(Deserialize, Default)]
#[serde(rename_all = "camelCase", default)]
struct JsonTransmission {
    transmission_factor: Option<f32>,
    transmission_texture: Option<serde::de::IgnoredAny>,
}

impl ListItem for JsonLook {
    const LIST: &'static str = "materials";
}

/// A look before its images are decoded: textures name images of the file.
fn look(doc: &Document, material: &Material, log: &mut WarningLog) -> Look {
    // Without a material, the file means glTF's default one, which is a rough metal.
    let json = match material.gltf.map(|index| doc.get::<JsonLook>(index)) {
        None => JsonLook::default(),
        Some(Ok(json)) => json,
        Some(Err(error)) => {
            log.warn(format!("how it looks cannot be read ({error}); drawn plainly"), label(material));
            return Look::PLAIN;
        }
    };
    let mut texture = |info: Option<TextureInfo>, kind: &str| match texture_ref(doc, &info?) {
        Ok(texture) => Some(texture),
        Err(cause) => {
            log.warn(format!("its {kind} texture cannot be used ({cause}); drawn without it"), label(material));
            None
        }
    };
    let JsonLook { pbr_metallic_roughness: metal, normal_texture, emissive_texture, extensions, .. } = json;
    let says_blend = json.alpha_mode.as_deref() == Some("BLEND");
    let transmission = extensions.transmission.unwrap_or_default();
    let shared = Look { says_blend, transmission: unit(transmission.transmission_factor, 0.0), ..Look::PLAIN };
    let look = if extensions.unlit.is_some() {
        return Look { transmission: 0.0, ..shared };
    } else if extensions.specular_glossiness.is_some()
        && metal.base_color_factor.is_none()
        && metal.base_color_texture.is_none()
    {
        shared
    } else {
        Look {
            metallic: unit(metal.metallic_factor, 1.0),
            roughness: unit(metal.roughness_factor, 1.0),
            metallic_roughness_texture: texture(metal.metallic_roughness_texture, "metallic-roughness"),
            ..shared
        }
    };
    let normal_scale = normal_texture.as_ref().and_then(|map| map.scale).filter(|scale| scale.is_finite());
    // What emits nothing needs no picture of it.
    let emissive_texture = emissive_texture.filter(|_| material.emissive != glam::Vec3::ZERO);
    let look = Look {
        normal_texture: texture(normal_texture.map(|map| map.texture), "normal"),
        normal_scale: normal_scale.unwrap_or(1.0),
        emissive_texture: texture(emissive_texture, "emissive"),
        ..look
    };
    if transmission.transmission_texture.is_some() {
        log.warn("its transmission texture is not read; its transmission factor holds everywhere", label(material));
    }
    look
}

fn unit(factor: Option<f32>, default: f32) -> f32 {
    factor.filter(|factor| factor.is_finite()).unwrap_or(default).clamp(0.0, 1.0)
}

fn label(material: &Material) -> String {
    let place = material.gltf.map_or("the default material".to_owned(), place::<JsonLook>);
    material.name.as_ref().map_or(place.clone(), |name| format!("{place} \"{name}\""))
}

/// Sets final image indices. What could not be decoded is left out.
fn finish(look: &mut Look, decoded: &BTreeMap<usize, Decoded>, log: &mut WarningLog) {
    let mut checked = |texture: &mut Option<TextureRef>, kind: &str| match texture.map(|t| decoded.get(&t.image)) {
        Some(Some(Decoded::Ready { index, .. })) => texture.iter_mut().for_each(|texture| texture.image = *index),
        Some(Some(Decoded::Failed { name, cause, .. })) => {
            log.warn(format!("it cannot be used as a {kind} texture ({cause}); drawn without it"), name.as_str());
            *texture = None;
        }
        Some(None) | None => *texture = None,
    };
    checked(&mut look.metallic_roughness_texture, "metallic-roughness");
    checked(&mut look.normal_texture, "normal");
    checked(&mut look.emissive_texture, "emissive");
}

fn mesh_look(scene: &Scene, reader: Reader, mesh: &Mesh, look: &Look, log: &mut WarningLog) -> MeshLook {
    let is_blended = look.transmission > 0.0 || (look.says_blend && least_alpha(scene, mesh) < 1.0);
    let tangents = look.normal_texture.filter(|_| !is_posed(scene, reader.doc, mesh)).and_then(|texture| {
        let found = tangents(reader, mesh, &texture)?;
        if found.is_none() {
            log.warn("its tangents are not unit vectors, one for each vertex; they are computed", mesh.label());
        }
        found
    });
    MeshLook { is_blended, tangents }
}

/// The least alpha that a mesh can have.
fn least_alpha(scene: &Scene, mesh: &Mesh) -> f32 {
    let material = &scene.materials[mesh.material];
    let of_texels = |texture: TextureRef| scene.images[texture.image].rgba.iter().map(|texel| texel[3]).min();
    let texels = material.base_color_texture.and_then(of_texels).map_or(1.0, |code| f32::from(code) / 255.0);
    let vertices = mesh.colors.iter().flatten().map(|color| color.w).fold(1.0, f32::min);
    material.base_color.w * texels * vertices
}

/// Whether some node poses a mesh by a skin or by morph targets, so that the file's tangents do not fit it.
fn is_posed(scene: &Scene, doc: &Document, mesh: &Mesh) -> bool {
    let json: Option<JsonMesh> = doc.get(mesh.gltf.0).ok();
    let has_targets = json.and_then(|json| json.primitives).into_iter().flatten().any(|p| p.targets.is_some());
    let draws = scene.instances.iter().filter(|instance| scene.meshes[instance.mesh].gltf == mesh.gltf);
    has_targets
        || draws
            .map(|instance| scene.nodes[instance.node].gltf)
            .any(|node| doc.get::<JsonNode>(node).is_ok_and(|node| node.skin.is_some() || node.weights.is_some()))
}

/// The file's tangents. None where it has none for this texture; some none where they are no tangents.
fn tangents(reader: Reader, mesh: &Mesh, texture: &TextureRef) -> Option<Option<Vec<Vec4>>> {
    let turn = texture.image_from_texcoord;
    // The tangents are those of the coordinates before they are turned or mirrored.
    let is_upright = turn.x_axis.x > 0.0 && turn.y_axis.y > 0.0 && turn.x_axis.y == 0.0 && turn.y_axis.x == 0.0;
    let json: JsonMesh = reader.doc.get(mesh.gltf.0).ok()?;
    let accessor = *json.primitives?.get(mesh.gltf.1)?.attributes.get("TANGENT").filter(|_| is_upright)?;
    let all = reader.floats::<4>(accessor).unwrap_or_default();
    let is_tangent = |t: &Vec4| t.is_finite() && (t.truncate().length() - 1.0).abs() < 0.1 && t.w.abs() > 0.5;
    let of_vertex = |vertex: usize| all.get(mesh.file_vertex(vertex as u32) as usize).copied().map(Vec4::from_array);
    let found = (0..mesh.positions.len()).map(|vertex| of_vertex(vertex).filter(is_tangent));
    Some(found.map(|t| t.map(|t| t.truncate().normalize().extend(t.w.signum()))).collect())
}
