//! Shadow rays with a far end: towards a lamp in the scene.
//!
//! They start a run-up before their origin, as all shadow rays do, and end a run-up before the lamp, measured square to
//! what they meet: a lamp that glides along a wall is seen from both of its sides, and not by the last bit of rounding.

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
    /// Something solid between a point and a lamp, not always the nearest. Nothing hides a lamp that is at the point.
    pub fn occluder_before(&self, origin_m: DVec3, lamp_m: DVec3) -> Option<Occluder> {
        let reach = self.reach(origin_m, lamp_m)?;
        // The walk is in f32: its end is moved out by more than that rounds.
        let walked = (reach.length * (1.0 + 1e-6)) as f32;
        self.any(reach.start, &reach.direction, walked, |id| self.ends_beyond(&reach, id))
    }

    /// Whether one given triangle lies between a point and a lamp.
    pub fn is_hidden_by(&self, occluder: Occluder, origin_m: DVec3, lamp_m: DVec3) -> bool {
        self.reach(origin_m, lamp_m).is_some_and(|reach| self.ends_beyond(&reach, occluder.0 as usize))
    }

    fn reach(&self, origin_m: DVec3, lamp_m: DVec3) -> Option<LampRay> {
        let way = (lamp_m - origin_m) * self.tracer_from_bake;
        let direction = Direction::new(way.try_normalize()?);
        let start = self.shadow_start(origin_m, &direction);
        Some(LampRay { start, direction, length: way.length() + self.run_up })
    }

    /// Whether a ray meets a triangle and goes on beyond it.
    fn ends_beyond(&self, reach: &LampRay, id: usize) -> bool {
        let Some((distance, _)) = self.meet(reach.start, &reach.direction, id) else { return false };
        let [a, b, c] = self.corners[id].map(|corner| corner.as_dvec3());
        let normal = (b - a).cross(c - a).normalize_or_zero();
        (reach.length - distance) * normal.dot(reach.direction.unit()).abs() >= self.run_up
    }
}
