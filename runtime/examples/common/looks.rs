//! Narrow things of our own scene, seen close by.

use super::common::Anything;
use glam::DVec3;
use sunbake_runtime::{Camera, Shot, Stage, View};

/// Vertical field of view.
const FOV_RAD: f64 = 0.9;

/// An object, and how it is looked at.
pub struct Look {
    /// Its node's name.
    pub object: &'static str,
    /// Where the eye is and what it looks at, from the object's foot, metres.
    from_foot: [[f64; 3]; 2],
}

const fn look(object: &'static str, eye: [f64; 3], target: [f64; 3]) -> Look {
    Look { object, from_foot: [eye, target] }
}

/// What `track_sheet` and `track_sweep` show.
pub const LOOKS: [Look; 6] = [
    look("fence west 1", [3.2, 1.5, -3.6], [-0.2, 0.2, 0.4]),
    look("wind pump tower", [6.0, 2.2, 5.0], [1.0, 0.0, 0.0]),
    look("pergola", [5.0, 2.6, 4.5], [0.0, 0.0, 0.0]),
    look("tree 0 wood", [5.0, 2.5, 5.0], [0.5, 0.0, 0.0]),
    look("post south 0", [3.0, 1.6, 3.0], [1.0, 0.0, 0.0]),
    look("water tank", [6.0, 2.4, 5.0], [1.0, 0.0, 0.0]),
];

impl Look {
    /// What a camera there sees.
    pub fn shot<'a>(&self, stage: &'a Stage, size: [u32; 2]) -> Result<Shot<'a>, Anything> {
        let foot_m = foot(stage, self.object).ok_or_else(|| format!("the scene has no {}", self.object))?;
        let [eye, target] = self.from_foot.map(|from_foot| foot_m + DVec3::from(from_foot));
        let camera = Camera::look_at(eye, target, FOV_RAD).ok_or("a camera that looks nowhere")?;
        Ok(Shot::new(stage, View::new(&camera, size, &stage.scene)))
    }
}

/// The middle of the lowest part of an object, bake space.
fn foot(stage: &Stage, name: &str) -> Option<DVec3> {
    let scene = &stage.scene;
    let is_it = |node: &sunbake::scene::Node| node.name.as_deref() == Some(name);
    let instance = scene.instances.iter().position(|instance| is_it(&scene.nodes[instance.node]))?;
    let first = &stage.geometry.first_triangle;
    let corners = || stage.geometry.triangles[first[instance] as usize..first[instance + 1] as usize].iter().flatten();
    let low = corners().fold(glam::Vec3::INFINITY, |a, b| a.min(*b)).as_dvec3();
    let high = corners().fold(glam::Vec3::NEG_INFINITY, |a, b| a.max(*b)).as_dvec3();
    Some(((low + high) * 0.5).with_y(low.y))
}
