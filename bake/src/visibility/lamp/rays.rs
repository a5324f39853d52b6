//! N rays a point to N positions of a lamp: a baseline for the closed form, as `visibility/rays.rs` is for the sun.
//!
//! The path is cut into N equal steps of time, and a ray is traced to the lamp's place at the middle of each; the step
//! is lit or dark as its ray is. Edges are off by half a step at most, and what is thinner than a step may be missed.
//! The occluder of the previous position and the last occluder of this one are tested before the hierarchy is walked.

use super::super::probe::Probe;
use super::{Engine, IntervalTable, Intervals, Session, Work};
use crate::atlas::SurfacePoint;
use crate::lamp::LampPath;
use crate::trace::{Occluder, Tracer};
use glam::DVec3;

/// N evenly spaced positions of a lamp.
pub struct LampRays<'a> {
    tracer: &'a Tracer,
    positions_m: Vec<DVec3>,
}

impl<'a> LampRays<'a> {
    /// Places the lamp `count` times along its path, bake space.
    pub fn new(tracer: &'a Tracer, path: &LampPath, count: usize) -> Self {
        let middle = |step: usize| (step as f64 + 0.5) / count as f64;
        Self { tracer, positions_m: (0..count).map(|step| path.position_m(middle(step))).collect() }
    }
}

impl Engine for LampRays<'_> {
    fn name(&self) -> String {
        format!("rays:{}", self.positions_m.len())
    }

    fn lane_count(&self) -> usize {
        1
    }

    fn session(&self) -> Box<dyn Session + '_> {
        Box::new(LampRaySession { engine: self, last: vec![None; self.positions_m.len()], work: Work::default() })
    }
}

struct LampRaySession<'a> {
    engine: &'a LampRays<'a>,
    /// For each position, its last occluder.
    last: Vec<Option<Occluder>>,
    work: Work,
}

impl Session for LampRaySession<'_> {
    fn lit(&mut self, points: &[SurfacePoint], answers: &mut IntervalTable) {
        let count = self.engine.positions_m.len();
        let t = |step: usize| step as f64 / count as f64;
        for point in points {
            let probe = Probe::new(self.engine.tracer, point);
            let mut before = None;
            let is_lit = |&step: &usize| self.is_lit(point, &probe, step, &mut before);
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

impl LampRaySession<'_> {
    /// `before` is the occluder of the previous position; it becomes that of this one.
    fn is_lit(&mut self, point: &SurfacePoint, probe: &Probe, step: usize, before: &mut Option<Occluder>) -> bool {
        let LampRays { tracer, positions_m } = self.engine;
        let lamp_m = positions_m[step];
        let Some(start) = probe.start_towards(lamp_m - point.position_m) else { return false };
        self.work.rays += 1;
        let origin_m = probe.origin_m(start);
        let last = &mut self.last[step];
        let hides = |guess: &Occluder| tracer.is_hidden_by(*guess, origin_m, lamp_m);
        let guessed = [*last, *before].into_iter().flatten().find(hides);
        let occluder = guessed.or_else(|| tracer.occluder_before(origin_m, lamp_m));
        *before = occluder;
        *last = occluder.or(*last);
        occluder.is_none()
    }
}
