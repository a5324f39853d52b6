//! Meshes: the primitives that a node draws, as one glTF mesh, shared by all nodes that draw the same.

use super::binary::Binary;
use crate::{
    atlas::Layout,
    scene::{Mesh, Scene},
};
use glam::Vec2;
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;

/// Which of the scene's meshes form the primitives of which glTF mesh.
pub(super) struct Groups {
    /// For each glTF mesh, its primitives as indices in [`Scene::meshes`].
    pub meshes: Vec<Vec<usize>>,
    /// For each node, its glTF mesh.
    pub mesh_of_node: Vec<Option<usize>>,
    /// For each instance, its node and primitive.
    pub places: Vec<(usize, usize)>,
}

impl Groups {
    pub fn new(scene: &Scene) -> Self {
        let mut drawn = vec![Vec::new(); scene.nodes.len()];
        let mut places = Vec::with_capacity(scene.instances.len());
        for instance in &scene.instances {
            places.push((instance.node, drawn[instance.node].len()));
            drawn[instance.node].push(instance.mesh);
        }
        let mut meshes = Vec::new();
        let mut known = BTreeMap::new();
        let mut group = |primitives: Vec<usize>| {
            let next = meshes.len();
            *known.entry(primitives).or_insert_with_key(|primitives| {
                meshes.push(primitives.clone());
                next
            })
        };
        let mesh_of_node = drawn.into_iter().map(|list| (!list.is_empty()).then(|| group(list))).collect();
        Self { meshes, mesh_of_node, places }
    }
}

pub(super) fn write(scene: &Scene, layouts: &[Layout], groups: &Groups, binary: &mut Binary) -> Vec<Value> {
    let mut primitives: Vec<Option<Value>> = vec![None; scene.meshes.len()];
    let mut write_group = |group: &Vec<usize>| {
        let mut written = Map::new();
        if let Some(name) = group.first().and_then(|&mesh| scene.meshes[mesh].name.as_ref()) {
            written.insert("name".into(), json!(name));
        }
        let mut one = |&mesh: &usize| {
            primitives[mesh].get_or_insert_with(|| primitive(scene, mesh, &layouts[mesh], binary)).clone()
        };
        written.insert("primitives".into(), group.iter().map(&mut one).collect());
        Value::from(written)
    };
    groups.meshes.iter().map(&mut write_group).collect()
}

fn primitive(scene: &Scene, index: usize, layout: &Layout, binary: &mut Binary) -> Value {
    let mesh = &scene.meshes[index];
    let source = || layout.vertices.iter().map(|&vertex| vertex as usize);
    let mut attributes = Map::new();
    let mut add = |name: &str, accessor: usize| attributes.insert(name.into(), json!(accessor));
    add("POSITION", binary.add_positions(source().map(|v| mesh.positions[v].to_array())));
    if let Some(normals) = &mesh.normals {
        add("NORMAL", binary.add_vectors(source().map(|v| normals[v].to_array())));
    }
    let baked = binary.add_vectors(layout.uvs.iter().map(Vec2::to_array));
    let pictured = match picture_texcoords(scene, mesh) {
        Picture::Set(texcoords) => binary.add_vectors(source().map(|v| texcoords[v].to_array())),
        Picture::Origin => binary.add_vectors(source().map(|_| [0.0; 2])),
        Picture::None => baked,
    };
    add("TEXCOORD_0", pictured);
    add("TEXCOORD_1", baked);
    if let Some(colors) = &mesh.colors {
        add("COLOR_0", binary.add_vectors(source().map(|v| colors[v].to_array())));
    }
    let indices = binary.add_indices(&layout.indices);
    json!({ "attributes": attributes, "indices": indices, "material": mesh.material })
}

/// What `TEXCOORD_0` holds.
enum Picture<'a> {
    /// The set that the base colour uses, or the file's first.
    Set(&'a [Vec2]),
    /// The base colour has a texture and the mesh has no coordinates for it: all of it shows one texel.
    Origin,
    /// Nothing wants it: the baked set stands in, because set 1 must not be without set 0.
    None,
}

fn picture_texcoords<'a>(scene: &Scene, mesh: &'a Mesh) -> Picture<'a> {
    let texture = &scene.materials[mesh.material].base_color_texture;
    let set = texture.as_ref().map_or(0, |texture| texture.texcoord);
    match (&mesh.texcoords[set], texture) {
        (Some(texcoords), _) => Picture::Set(texcoords),
        (None, Some(_)) => Picture::Origin,
        (None, None) => Picture::None,
    }
}
