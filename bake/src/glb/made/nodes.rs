//! Writes nodes and cameras.

use super::meshes::Groups;
use crate::scene::{Node, Scene};
use glam::{DMat4, DVec4};
use serde_json::{Map, Value, json};

/// Indices of nodes without a parent.
pub(super) fn roots(scene: &Scene) -> Vec<usize> {
    (0..scene.nodes.len()).filter(|&node| scene.nodes[node].parent.is_none()).collect()
}

pub(super) fn write(scene: &Scene, groups: &Groups) -> Vec<Value> {
    let mut nodes: Vec<Map<String, Value>> = scene.nodes.iter().map(transform).collect();
    for (node, mesh) in groups.mesh_of_node.iter().enumerate() {
        if let Some(mesh) = mesh {
            nodes[node].insert("mesh".into(), json!(mesh));
        }
    }
    for (index, camera) in scene.cameras.iter().enumerate() {
        nodes[camera.node].insert("camera".into(), json!(index));
    }
    for (index, parent) in scene.nodes.iter().enumerate().filter_map(|(i, node)| Some((i, node.parent?))) {
        let children = nodes[parent].entry("children").or_insert_with(|| json!([]));
        children.as_array_mut().into_iter().for_each(|list| list.push(json!(index)));
    }
    nodes.into_iter().map(Value::from).collect()
}

/// Name and transform: a translation if that is all, else the matrix. Both keep the exact `f64` numbers.
pub fn transform(node: &Node) -> Map<String, Value> {
    let mut written = Map::new();
    if let Some(name) = &node.name {
        written.insert("name".into(), json!(name));
    }
    let matrix = node.parent_from_node;
    let is_shift = DMat4::from_cols(matrix.x_axis, matrix.y_axis, matrix.z_axis, DVec4::W) == DMat4::IDENTITY;
    if !is_shift {
        written.insert("matrix".into(), json!(matrix.to_cols_array()));
    } else if matrix.w_axis != DVec4::W {
        written.insert("translation".into(), json!(matrix.w_axis.truncate().to_array()));
    }
    written
}

/// Cameras with a near plane at a ten-thousandth of the scene's half size and no far plane.
pub(super) fn cameras(scene: &Scene) -> Vec<Value> {
    let near = (scene.half_extent_m.max_element() * 1e-4).max(1e-6);
    let camera = |camera: &crate::scene::SceneCamera| {
        let mut written = Map::new();
        if let Some(name) = &camera.name {
            written.insert("name".into(), json!(name));
        }
        written.insert("type".into(), json!("perspective"));
        written.insert("perspective".into(), json!({ "yfov": camera.fov_y_rad, "znear": near }));
        Value::from(written)
    };
    scene.cameras.iter().map(camera).collect()
}
