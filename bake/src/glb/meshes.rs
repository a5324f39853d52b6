//! Writes meshes: the primitives of a node form one glTF mesh, shared by all nodes with the same primitives.

use super::Occlusion;
use super::binary::Binary;
use crate::settings::VertexAttribute;
use crate::{
    atlas::Layout,
    scene::{Mesh, Scene},
};
use glam::{Vec2, Vec4};
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;

/// The scene's meshes grouped into glTF meshes.
pub(super) struct Groups {
    /// For each glTF mesh, its primitives.
    pub meshes: Vec<Vec<MeshPrimitive>>,
    /// For each node, its glTF mesh.
    pub mesh_of_node: Vec<Option<usize>>,
    /// For each instance, its node and the index of its primitive in that node's mesh.
    pub primitives_of_instances: Vec<(usize, usize)>,
}

/// A primitive: one of [`Scene::meshes`] and, if each instance has its own primitive, the instance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct MeshPrimitive {
    mesh: usize,
    instance: Option<usize>,
}

/// Baked data that differs between the instances of a mesh.
pub(super) enum PerInstance<'a> {
    /// None: coordinates are the layout's, the material is the mesh's.
    Nothing,
    /// Occlusion textures on page coordinates, with the material index of every instance.
    Occlusion(Occlusion<'a>, Vec<usize>),
    /// Ambient visibility (0 to 1) of every instance's vertices, and no baked coordinates.
    VertexVisibility(VertexAttribute, &'a [Vec<f32>]),
}

impl Groups {
    /// `by_instance`: every instance gets its own primitive.
    pub fn new(scene: &Scene, by_instance: bool) -> Self {
        let mut drawn = vec![Vec::new(); scene.nodes.len()];
        let mut primitives_of_instances = Vec::with_capacity(scene.instances.len());
        for (index, instance) in scene.instances.iter().enumerate() {
            primitives_of_instances.push((instance.node, drawn[instance.node].len()));
            drawn[instance.node].push(MeshPrimitive { mesh: instance.mesh, instance: by_instance.then_some(index) });
        }
        let mut meshes = Vec::new();
        let mut known = BTreeMap::new();
        let mut group = |primitives: Vec<MeshPrimitive>| {
            let next = meshes.len();
            *known.entry(primitives).or_insert_with_key(|primitives| {
                meshes.push(primitives.clone());
                next
            })
        };
        let mesh_of_node = drawn.into_iter().map(|list| (!list.is_empty()).then(|| group(list))).collect();
        Self { meshes, mesh_of_node, primitives_of_instances }
    }
}

pub(super) fn write(
    scene: &Scene,
    layouts: &[Layout],
    groups: &Groups,
    per_instance: &PerInstance,
    binary: &mut Binary,
) -> Vec<Value> {
    let mut shared: Vec<Option<SharedData>> = scene.meshes.iter().map(|_| None).collect();
    let mut write_group = |group: &Vec<MeshPrimitive>| {
        let mut written = Map::new();
        if let Some(name) = group.first().and_then(|first| scene.meshes[first.mesh].name.as_ref()) {
            written.insert("name".into(), json!(name));
        }
        let mut one = |&MeshPrimitive { mesh, instance }: &MeshPrimitive| {
            let layout = &layouts[mesh];
            let shared = shared[mesh].get_or_insert_with(|| SharedData::new(scene, mesh, layout, binary));
            let material = scene.meshes[mesh].material;
            let mut add_uvs = |uvs: &[Vec2]| binary.add_vectors(uvs.iter().map(Vec2::to_array));
            match (per_instance, instance) {
                (PerInstance::Occlusion(occlusion, materials), Some(instance)) => {
                    shared.primitive(add_uvs(&occlusion.page_uvs(scene, instance)), materials[instance])
                }
                (PerInstance::VertexVisibility(attribute, open), Some(instance)) => {
                    let accessor = add_ambient_visibility(&scene.meshes[mesh], *attribute, &open[instance], binary);
                    shared.with(attribute.name(), accessor, material)
                }
                _ => shared.primitive(add_uvs(&layout.uvs), material),
            }
        };
        written.insert("primitives".into(), group.iter().map(&mut one).collect());
        Value::from(written)
    };
    groups.meshes.iter().map(&mut write_group).collect()
}

/// Adds ambient visibility as a vertex attribute.
fn add_ambient_visibility(mesh: &Mesh, attribute: VertexAttribute, open: &[f32], binary: &mut Binary) -> usize {
    let color = |(vertex, &open): (usize, &f32)| {
        let color = mesh.colors.as_ref().map_or(Vec4::ONE, |colors| colors[vertex]);
        (color.truncate() * open).extend(color.w).to_array()
    };
    match attribute {
        VertexAttribute::Color => binary.add_vectors(open.iter().enumerate().map(color)),
        VertexAttribute::Ao => binary.add_scalars(open.iter().copied()),
    }
}

/// Attributes and indices that all instances of a mesh share.
struct SharedData {
    attributes: Map<String, Value>,
    indices: usize,
}

impl SharedData {
    fn new(scene: &Scene, index: usize, layout: &Layout, binary: &mut Binary) -> Self {
        let mesh = &scene.meshes[index];
        let source = || layout.vertices.iter().map(|&vertex| vertex as usize);
        let mut attributes = Map::new();
        let mut add = |name: &str, accessor: usize| attributes.insert(name.into(), json!(accessor));
        add("POSITION", binary.add_positions(source().map(|v| mesh.positions[v].to_array())));
        if let Some(normals) = &mesh.normals {
            add("NORMAL", binary.add_vectors(source().map(|v| normals[v].to_array())));
        }
        match first_texcoords(scene, mesh) {
            FirstTexcoords::Set(texcoords) => {
                add("TEXCOORD_0", binary.add_vectors(source().map(|v| texcoords[v].to_array())));
            }
            FirstTexcoords::Origin => {
                add("TEXCOORD_0", binary.add_vectors(source().map(|_| [0.0; 2])));
            }
            FirstTexcoords::None => {}
        }
        if let Some(colors) = &mesh.colors {
            add("COLOR_0", binary.add_vectors(source().map(|v| colors[v].to_array())));
        }
        Self { attributes, indices: binary.add_indices(&layout.indices) }
    }

    /// A primitive with one more attribute.
    fn with(&self, name: &str, accessor: usize, material: usize) -> Value {
        let mut attributes = self.attributes.clone();
        attributes.insert(name.into(), json!(accessor));
        json!({ "attributes": attributes, "indices": self.indices, "material": material })
    }

    /// A primitive with baked coordinates in set 1. Without texture coordinates they are set 0 as well, because set 1
    /// is invalid without set 0.
    fn primitive(&self, baked: usize, material: usize) -> Value {
        let mut attributes = self.attributes.clone();
        attributes.entry("TEXCOORD_0").or_insert_with(|| json!(baked));
        Self { attributes, indices: self.indices }.with("TEXCOORD_1", baked, material)
    }
}

/// The content of `TEXCOORD_0`.
enum FirstTexcoords<'a> {
    /// The set that the base colour uses, or else the file's first.
    Set(&'a [Vec2]),
    /// Zeros: the base colour has a texture, but the mesh has no coordinates, so it shows a single texel.
    Origin,
    /// No set is needed.
    None,
}

fn first_texcoords<'a>(scene: &Scene, mesh: &'a Mesh) -> FirstTexcoords<'a> {
    let texture = &scene.materials[mesh.material].base_color_texture;
    let set = texture.as_ref().map_or(0, |texture| texture.texcoord);
    match (&mesh.texcoords[set], texture) {
        (Some(texcoords), _) => FirstTexcoords::Set(texcoords),
        (None, Some(_)) => FirstTexcoords::Origin,
        (None, None) => FirstTexcoords::None,
    }
}
