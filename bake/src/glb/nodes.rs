//! Nodes: those of the file, and new ones for the copies of a mesh that `EXT_mesh_gpu_instancing` gives to one node.

use super::{counted, list, made};
use crate::scene::{GPU_INSTANCING, Scene};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Turns copies into nodes of the file: children of the node whose mesh they draw, before its other children. Gives,
/// for each of [`Scene::nodes`], its node in the file, and says what is no longer there.
pub(super) fn expand_copies(scene: &Scene, root: &mut Value) -> (Vec<usize>, Vec<String>) {
    let mut written: Vec<usize> = scene.nodes.iter().map(|node| node.gltf).collect();
    let mut copies: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (index, node) in scene.nodes.iter().enumerate().filter(|(_, node)| node.is_copy(&scene.nodes)) {
        copies.entry(node.gltf).or_default().push(index);
    }
    let nodes = list(root, "nodes");
    for (&parent, copies) in &copies {
        let Some(object) = nodes.get_mut(parent).and_then(Value::as_object_mut) else { continue };
        let mesh = object.remove("mesh");
        let mut children: Vec<Value> = Vec::new();
        let mut added = Vec::new();
        let first = nodes.len();
        for (child, &index) in (first..).zip(copies) {
            let mut node = made::transform(&scene.nodes[index]);
            node.extend(mesh.clone().map(|mesh| ("mesh".into(), mesh)));
            added.push(Value::from(node));
            children.push(json!(child));
            written[index] = child;
        }
        let object = nodes[parent].as_object_mut().expect("it was one");
        if let Some(Value::Array(old)) = object.remove("children") {
            children.extend(old);
        }
        object.insert("children".into(), children.into());
        remove_extension(object, GPU_INSTANCING);
        nodes.extend(added);
    }
    let note = format!("copies by {GPU_INSTANCING} are nodes of their own, of {}", counted(copies.len(), "node"));
    (written, (!copies.is_empty()).then_some(note).into_iter().collect())
}

/// Takes an extension away from an object, and the list of extensions with the last of them.
pub(super) fn remove_extension(object: &mut serde_json::Map<String, Value>, name: &str) -> bool {
    let Some(Value::Object(extensions)) = object.get_mut("extensions") else { return false };
    let was_there = extensions.remove(name).is_some();
    if was_there && extensions.is_empty() {
        object.remove("extensions");
    }
    was_there
}
