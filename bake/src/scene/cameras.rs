//! Cameras, and the directional light that serves as the sun if no place is given.

use super::{
    Node, SceneCamera,
    document::{self, Document, place},
    limits::WarningLog,
    nodes::NodeTree,
};
use glam::{DMat4, DVec3};
use serde_json::Value;

/// Perspective cameras under drawn nodes. One that cannot be used is left out with a warning, since a bake does not
/// need it.
pub(super) fn read(doc: &Document, tree: &NodeTree, centre_m: DVec3, log: &mut WarningLog) -> Vec<SceneCamera> {
    let mut cameras = Vec::new();
    for (node, placed) in tree.nodes.iter().enumerate().filter(|(_, placed)| !placed.is_copy(&tree.nodes)) {
        let Some(camera) = tree.file_node(placed).and_then(|file| file.camera) else { continue };
        let place = place::<document::JsonCamera>(camera);
        let (camera, bake_from_camera) = match doc.get::<document::JsonCamera>(camera) {
            Ok(camera) => (camera, rigid(&placed.world_from_node, centre_m)),
            Err(error) => {
                log.warn(format!("left out ({error})"), place);
                continue;
            }
        };
        match camera.perspective.map(|p| p.yfov) {
            None => log.warn("only perspective cameras are read; left out", place),
            Some(fov_y_rad) if fov_y_rad > 0.0 && fov_y_rad < std::f64::consts::PI => {
                let name = camera.name.or_else(|| placed.name.clone());
                cameras.push(SceneCamera { name, node, bake_from_camera, fov_y_rad });
            }
            Some(_) => log.warn("its field of view is not between 0 and 180 degrees; left out", place),
        }
    }
    cameras
}

/// The node's position and view direction, without its scale, shear or mirroring.
fn rigid(world_from_node: &DMat4, centre_m: DVec3) -> DMat4 {
    let back = world_from_node.z_axis.truncate().normalize_or(DVec3::Z);
    let right = world_from_node.y_axis.truncate().cross(back).normalize_or(back.any_orthonormal_vector());
    let position = world_from_node.w_axis.truncate() - centre_m;
    DMat4::from_cols(right.extend(0.0), back.cross(right).extend(0.0), back.extend(0.0), position.extend(1.0))
}

/// Towards the first directional light of `KHR_lights_punctual` in node order. A light shines along its node's -Z.
pub(super) fn sun_direction(doc: &Document, tree: &NodeTree) -> Option<DVec3> {
    let lights = doc.root.get("extensions")?.get("KHR_lights_punctual")?.get("lights")?;
    let light_of = |node: &Node| {
        let extensions = tree.file_node(node)?.extensions.as_ref()?;
        lights.get(extensions.get("KHR_lights_punctual")?.get("light")?.as_u64()? as usize)
    };
    let is_directional = |node: &&Node| {
        light_of(node).and_then(|light| light.get("type")).and_then(Value::as_str) == Some("directional")
    };
    tree.nodes.iter().find(is_directional)?.world_from_node.z_axis.truncate().try_normalize()
}
