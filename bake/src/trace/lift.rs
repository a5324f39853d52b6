//! How far shadow rays are lifted off their surface.

use crate::scene::{Geometry, Instance, Scene};
use glam::Vec3;

/// Lift of shadow rays off their surface, in rounding steps of its `f32` corners: enough that a flat wall of many
/// triangles, each corner rounded by half a step, does not shade itself.
const LIFT_STEPS: f64 = 4.0;
/// One rounding step of an `f32`, relative to its value.
const STEP: f64 = 1.0 / (1 << 23) as f64;

/// For each instance, the lift of its shadow rays in metres. Corners were rounded twice: in the file (in object space,
/// perhaps at map coordinates of millions) and in bake space. Neighbours' corners were rounded at most like those at
/// the scene's border.
pub(super) fn lifts_m(scene: &Scene, geometry: &Geometry) -> Vec<f64> {
    let largest =
        |points: &mut dyn Iterator<Item = &Vec3>| f64::from(points.map(|p| p.abs().max_element()).fold(0.0, f32::max));
    let in_file: Vec<f64> = scene.meshes.iter().map(|mesh| largest(&mut mesh.positions.iter())).collect();
    let neighbours = 0.25 * largest(&mut geometry.triangles.iter().flatten());
    let lift = |(index, instance): (usize, &Instance)| {
        let range = geometry.first_triangle[index] as usize..geometry.first_triangle[index + 1] as usize;
        let in_bake = largest(&mut geometry.triangles[range].iter().flatten());
        let axes = [0, 1, 2].map(|k| instance.bake_from_object.col(k).truncate().length());
        let scale = axes.into_iter().fold(0.0, f64::max);
        LIFT_STEPS * STEP * (0.5 * (in_bake + in_file[instance.mesh] * scale)).max(neighbours * 0.5)
    };
    scene.instances.iter().enumerate().map(lift).collect()
}
