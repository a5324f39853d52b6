//! A lamp at a moment: where it is, how bright it is, and which stretch of its path stands for it.
//!
//! The lamp is a ball, taken as the stretch of its own path within one radius of its centre, before and behind: what is
//! seen of it is the lit share of the time in which its centre passes there. That window is a diameter over the speed,
//! less what lies before the path's start and after its end, and it bends with the path.
//!
//! **Brightness.** Nobody says how bright a lamp is, so it is as bright as makes a picture readable: half the scene's half
//! diagonal away it lights a surface that faces it as the noon sun would, and it falls with the square of distance.

use glam::{DVec3, Vec3};
use sunbake::lamp::LampPath;
use sunbake_shaders::LampUniform;

/// Light of the lamp at its reference distance: a warm white, as bright as the sun at noon.
const REFERENCE_LIGHT: Vec3 = Vec3::new(1.9, 1.55, 1.1);
/// The reference distance, as a share of the scene's half diagonal.
const REFERENCE_SHARE: f64 = 0.5;
/// Balls a metre of a lamp that is a point.
const POINT: f32 = 1e9;

/// A lamp, as a frame needs it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LampMoment {
    /// Where its centre is, bake space.
    pub position_m: Vec3,
    /// The middle of its window, path time.
    pub t: f32,
    /// Length of its window, path time.
    pub width_t: f32,
    /// Its radius.
    pub radius_m: f32,
    /// Its light on a surface that faces it from a metre away.
    pub light: Vec3,
    /// How far its light goes, beyond which none of it is seen: [`WITHOUT_END`], unless it is cut off to save work.
    pub range_m: f32,
}

/// Range of a lamp that lights all that sees it. Its square is a number still.
pub const WITHOUT_END: f32 = 1e18;

impl LampMoment {
    /// The lamp at `t` of its path (bake space), in a scene of this half size.
    pub fn new(path: &LampPath, t: f64, half_extent_m: DVec3) -> Self {
        let [start, end] = path.window_t(t);
        let reference_m = REFERENCE_SHARE * half_extent_m.length();
        Self {
            position_m: path.position_m(t).as_vec3(),
            t: (0.5 * (start + end)) as f32,
            width_t: (end - start) as f32,
            radius_m: path.radius_m() as f32,
            light: REFERENCE_LIGHT * (reference_m * reference_m) as f32,
            range_m: WITHOUT_END,
        }
    }

    /// One over its diameter; very large for a point.
    pub fn balls_per_metre(&self) -> f32 {
        if self.radius_m > 0.0 { 0.5 / self.radius_m } else { POINT }
    }

    /// What the GPU needs to know of it.
    pub fn uniform(&self) -> LampUniform {
        LampUniform {
            position_m: self.position_m.into(),
            t: self.t,
            light: self.light.into(),
            width_t: self.width_t,
            radius_m: self.radius_m,
            balls_per_metre: self.balls_per_metre(),
            range_m: self.range_m,
            pad: 0.0,
        }
    }

    /// Its light on a matt surface, a share `seen` of it: twin of `lamp_shade.wgsl`.
    pub fn on(&self, base_color: Vec3, normal: Vec3, way_m: Vec3, seen: f32) -> Vec3 {
        let distance2 = way_m.length_squared().max(1e-12);
        if distance2 > self.range_m * self.range_m {
            return Vec3::ZERO;
        }
        let lambert = (normal.dot(way_m) / distance2.sqrt()).max(0.0);
        base_color * self.light * (seen * lambert / (distance2 + self.radius_m * self.radius_m))
    }
}
