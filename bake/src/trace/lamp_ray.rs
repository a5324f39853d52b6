//! Shadow rays of finite length: towards a lamp in the scene.
//!
//! They start a run-up before their origin, like all shadow rays, and end a run-up before the lamp, measured
//! perpendicular to the surface that they meet. So a lamp that moves exactly along a wall is seen from both sides of
//! the wall, instead of from a side that rounding chooses.

use super::{Direction, Occluder, Tracer};
use glam::DVec3;

/// A ray to a lamp, tracer space.
struct LampRay {
    start: DVec3,
    direction: Direction,
    /// Distance of the lamp from the start.
    length: f64,
}

impl Tracer {
    /// A solid triangle between a point and a lamp, not necessarily the nearest. Nothing hides a lamp at the point
    /// itself.
    pub fn occluder_before(&self, origin_m: DVec3, lamp_m: DVec3) -> Option<Occluder> {
        let ray = self.lamp_ray(origin_m, lamp_m)?;
        // The traversal is in `f32`: the margin is more than its rounding.
        let far = (ray.length * (1.0 + 1e-6)) as f32;
        self.any(ray.start, &ray.direction, far, |id| self.ends_beyond(&ray, id))
    }

    /// Whether a given triangle lies between a point and a lamp.
    pub fn is_hidden_by(&self, occluder: Occluder, origin_m: DVec3, lamp_m: DVec3) -> bool {
        self.lamp_ray(origin_m, lamp_m).is_some_and(|ray| self.ends_beyond(&ray, occluder.0 as usize))
    }

    fn lamp_ray(&self, origin_m: DVec3, lamp_m: DVec3) -> Option<LampRay> {
        let to_lamp = (lamp_m - origin_m) * self.tracer_from_bake;
        let direction = Direction::new(to_lamp.try_normalize()?);
        let start = self.shadow_start(origin_m, &direction);
        Some(LampRay { start, direction, length: to_lamp.length() + self.run_up })
    }

    /// Whether a ray meets a triangle and ends beyond it.
    fn ends_beyond(&self, ray: &LampRay, id: usize) -> bool {
        let Some((distance, _)) = self.intersect(ray.start, &ray.direction, id) else { return false };
        let [a, b, c] = self.corners[id].map(|corner| corner.as_dvec3());
        let normal = (b - a).cross(c - a).normalize_or_zero();
        (ray.length - distance) * normal.dot(ray.direction.unit()).abs() >= self.run_up
    }
}
