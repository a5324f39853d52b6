//! N rays a point to N places of a lamp: a baseline for the closed form, as `visibility/rays.rs` is for the sun.
//!
//! The path is cut into N equal steps of time, and a ray is traced to the lamp's place at the middle of each; the step is
//! lit or dark as its ray is. Edges are off by half a step at most, and what is thinner than a step may be missed. What
//! hid the place before and what last hid this place are tried before the hierarchy is walked.

use super::super::probe::side_towards;
use super::{Engine, IntervalTable, Intervals, Session, Work};
use crate::atlas::SurfacePoint;
use crate::lamp::LampPath;
use crate::trace::{Occluder, Tracer};
use glam::DVec3;

/// N evenly spaced places of a lamp.
pub struct LampRays<'a> {
    tracer: &'a Tracer,
    places_m: Vec<DVec3>,
}

impl<'a> LampRays<'a> {
    /// Places the lamp `count` times along its path, bake space.
    pub fn new(tracer: &'a Tracer, path: &LampPath, count: usize) -> Self {
        let middle = |step: usize| (step as f64 + 0.5) / count as f64;
        Self { tracer, places_m: (0..count).map(|step| path.position_m(middle(step))).collect() }
    }
}

impl Engine for LampRays<'_> {
    fn name(&self) -> String {
        format!("rays:{}", self.places_m.len())
    }

    fn lane_count(&self) -> usize {
        1
    }

    fn session(&self) -> Box<dyn Session + '_> {
        Box::new(RaySession { engine: self, last: vec![None; self.places_m.len()], work: Work::default() })
    }
}

struct RaySession<'a> {
    engine: &'a LampRays<'a>,
    /// For each place, what last hid it.
    last: Vec<Option<Occluder>>,
    work: Work,
}

impl Session for RaySession<'_> {
    fn lit(&mut self, points: &[SurfacePoint], answers: &mut IntervalTable) {
        let count = self.engine.places_m.len();
        let t = |step: usize| step as f64 / count as f64;
        for point in points {
            let origins_m =
                [1.0, -1.0].map(|s| self.engine.tracer.lift(point.position_m, point.normal * s, point.triangle));
            let mut before = None;
            let is_lit = |&step: &usize| self.is_lit(point, &origins_m, step, &mut before);
            // Neighbouring steps share an end, computed alike, and are joined.
            let lit = (0..count).filter(is_lit);
            let steps = lit.map(|step| [t(step), t(step + 1)]);
            answers.push(&Intervals::from_unsorted(steps.collect()));
        }
    }

    fn work(&self) -> Work {
        self.work
    }
}

impl RaySession<'_> {
    /// `before` is what hid the place before this one, and then this one.
    fn is_lit(
        &mut self,
        point: &SurfacePoint,
        origins_m: &[DVec3; 2],
        step: usize,
        before: &mut Option<Occluder>,
    ) -> bool {
        let LampRays { tracer, places_m } = self.engine;
        let place_m = places_m[step];
        let Some(side) = side_towards(point, place_m - point.position_m) else { return false };
        self.work.rays += 1;
        let origin_m = origins_m[side as usize];
        let last = &mut self.last[step];
        let hides = |guess: &Occluder| tracer.is_hidden_by(*guess, origin_m, place_m);
        let guessed = [*last, *before].into_iter().flatten().find(hides);
        let occluder = guessed.or_else(|| tracer.occluder_before(origin_m, place_m));
        *before = occluder;
        *last = occluder.or(*last);
        occluder.is_none()
    }
}
