//! A lamp at a moment: where it is, how bright it is, and which stretch of its path represents it.
//!
//! The lamp is a sphere. It is represented by the stretch of its path within one radius of its centre, ahead and
//! behind: its visibility is the lit share of the time in which the centre passes there. That window is the diameter
//! over the speed, cut off at the path's start and end, and it follows the path's bends.
//!
//! **Brightness.** Sets do not say how bright a lamp is, so it is as bright as makes a picture readable: at half the
//! scene's half diagonal it lights a surface that faces it like the noon sun, and it falls off with the square of
//! distance.

use crate::shade::Reflector;
use glam::{DVec3, Vec3};
use sunbake::lamp::LampPath;
use sunbake_shaders::LampUniform;

/// Light of the lamp at its reference distance: a warm white, as bright as the sun at noon.
const REFERENCE_LIGHT: Vec3 = Vec3::new(1.9, 1.55, 1.1);
/// The reference distance, as a share of the scene's half diagonal.
const REFERENCE_SHARE: f64 = 0.5;
/// [`LampMoment::inverse_diameter_per_m`] of a point lamp: it is wholly above or below any plane.
const POINT_INVERSE_DIAMETER_PER_M: f32 = 1e9;

/// A lamp at a moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LampMoment {
    /// Its centre, bake space, in metres.
    pub position_m: Vec3,
    /// The middle of its window, path time.
    pub t: f32,
    /// Length of its window, path time.
    pub width_t: f32,
    /// Its radius in metres; 0 for a point.
    pub radius_m: f32,
    /// Its light on a surface that faces it from one metre away: linear RGB.
    pub light: Vec3,
    /// Distance in metres beyond which it gives no light: [`WITHOUT_END`], unless it is cut off to save work.
    pub range_m: f32,
}

/// Range of a lamp that is not cut off. Its square is still finite in `f32`.
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
    pub fn inverse_diameter_per_m(&self) -> f32 {
        if self.radius_m > 0.0 { 0.5 / self.radius_m } else { POINT_INVERSE_DIAMETER_PER_M }
    }

    /// The uniform that shaders read.
    pub fn uniform(&self) -> LampUniform {
        LampUniform {
            position_m: self.position_m.into(),
            t: self.t,
            light: self.light.into(),
            width_t: self.width_t,
            radius_m: self.radius_m,
            inverse_diameter_per_m: self.inverse_diameter_per_m(),
            range_m: self.range_m,
            pad: 0.0,
        }
    }

    /// Its light that a surface reflects, at a visibility from 0 to 1. Twin of `lamp/shade.wgsl`.
    pub fn on(&self, surface: &Reflector, to_lamp_m: Vec3, visibility: f32) -> Vec3 {
        let distance2 = to_lamp_m.length_squared().max(1e-12);
        if distance2 > self.range_m * self.range_m {
            return Vec3::ZERO;
        }
        let share = surface.reflected(to_lamp_m / distance2.sqrt());
        share * self.light * (visibility / (distance2 + self.radius_m * self.radius_m))
    }

    /// Its visibility where nothing hides it: the share of its sphere in front of the surface's plane; 0 beyond its
    /// range. Twin of `lamp/open.wgsl`.
    pub fn open_visibility(&self, geometric_normal: Vec3, to_lamp_m: Vec3) -> f32 {
        let sphere_share = (0.5 + geometric_normal.dot(to_lamp_m) * self.inverse_diameter_per_m()).clamp(0.0, 1.0);
        if to_lamp_m.length_squared() > self.range_m * self.range_m { 0.0 } else { sphere_share }
    }
}
