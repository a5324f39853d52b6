//! Writes meshes: the primitives of a node form one glTF mesh, shared by all nodes with the same primitives.

use super::binary::Binary;
use crate::scene::Scene;
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;

/// The scene's meshes grouped into glTF meshes.
pub(super) struct Groups {
    /// For each glTF mesh, its primitives: indices in [`Scene::meshes`].
    pub meshes: Vec<Vec<usize>>,
    /// For each node, its glTF mesh.
    pub mesh_of_node: Vec<Option<usize>>,
    /// For each instance, its glTF mesh and its primitive there.
    pub primitives_of_instances: Vec<(usize, usize)>,
}

impl Groups {
    pub fn new(scene: &Scene) -> Self {
        let mut drawn = vec![Vec::new(); scene.nodes.len()];
        let mut primitives = Vec::with_capacity(scene.instances.len());
        for instance in &scene.instances {
            primitives.push((instance.node, drawn[instance.node].len()));
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
        let mesh_of_node: Vec<Option<usize>> =
            drawn.into_iter().map(|list| (!list.is_empty()).then(|| group(list))).collect();
        let of_instance = |(node, primitive): (usize, usize)| (mesh_of_node[node].unwrap_or_default(), primitive);
        let primitives_of_instances = primitives.into_iter().map(of_instance).collect();
        Self { meshes, mesh_of_node, primitives_of_instances }
    }
}

pub(super) fn write(scene: &Scene, groups: &Groups, binary: &mut Binary) -> Vec<Value> {
    let mut known: Vec<Option<Value>> = vec![None; scene.meshes.len()];
    let mut write_group = |group: &Vec<usize>| {
        let mut written = Map::new();
        if let Some(name) = group.first().and_then(|&first| scene.meshes[first].name.as_ref()) {
            written.insert("name".into(), json!(name));
        }
        let mut one = |&mesh: &usize| known[mesh].get_or_insert_with(|| primitive(scene, mesh, binary)).clone();
        written.insert("primitives".into(), group.iter().map(&mut one).collect());
        Value::from(written)
    };
    groups.meshes.iter().map(&mut write_group).collect()
}

fn primitive(scene: &Scene, index: usize, binary: &mut Binary) -> Value {
    let mesh = &scene.meshes[index];
    let mut attributes = Map::new();
    let mut add = |name: &str, accessor: usize| attributes.insert(name.into(), json!(accessor));
    add("POSITION", binary.add_positions(mesh.positions.iter().map(|p| p.to_array())));
    if let Some(normals) = &mesh.normals {
        add("NORMAL", binary.add_vectors(normals.iter().map(|n| n.to_array())));
    }
    for (set, texcoords) in mesh.texcoords.iter().enumerate().filter_map(|(set, all)| Some((set, all.as_ref()?))) {
        add(&format!("TEXCOORD_{set}"), binary.add_vectors(texcoords.iter().map(|uv| uv.to_array())));
    }
    if let Some(colors) = &mesh.colors {
        add("COLOR_0", binary.add_vectors(colors.iter().map(|c| c.to_array())));
    }
    json!({ "attributes": attributes, "indices": binary.add_indices(&mesh.indices), "material": mesh.material })
}
