//! N rays a point: the method of *GPU Gems* chapter 13, and the baseline for the others.
//!
//! Based on section 13.3.2 of that chapter. The path is divided into N equal steps, and a ray is traced at the
//! middle of each; the step is lit or dark as its ray is, so edges land half-way between rays. What lies between two
//! rays and touches neither is missed: errors are up to 1/(2N) of the path an edge, and features thinner than 1/N may
//! vanish.
//!
//! Positions of the sun below the horizon or behind the surface cost no ray. Two guesses are tested before the
//! hierarchy is walked: the last occluder of the same position, since neighbours are mostly shaded by the same thing,
//! and the occluder of the previous position, since shade mostly lasts for a while. On pages of 256 with 256 suns, the
//! second makes scenes full of shade faster (littlest_tokyo by 3.5 times, two_cylinder_engine by 2.1) and leaves those
//! with open ground as they were (gas_station, truck_town). The other order makes no measurable difference.

use super::probe::Probe;
use super::{Engine, IntervalTable, Intervals, Session, Work};
use crate::atlas::SurfacePoint;
use crate::sun::SunPath;
use crate::trace::{Direction, Occluder, Tracer};

/// N evenly spaced suns.
pub struct RayEngine<'a> {
    tracer: &'a Tracer,
    /// For each lane, the sun at the middle of each step; none where it is below the horizon.
    suns: Vec<Vec<Option<Direction>>>,
}

impl<'a> RayEngine<'a> {
    /// Places `count` suns along each lane's path.
    pub fn new(tracer: &'a Tracer, lanes: &[SunPath], count: usize) -> Self {
        let middle = |step: usize| (step as f64 + 0.5) / count as f64;
        let sun = |path: &SunPath, step| Some(path.direction(middle(step))).filter(|d| d.y > 0.0).map(Direction::new);
        let suns = |path| (0..count).map(|step| sun(path, step)).collect();
        Self { tracer, suns: lanes.iter().map(suns).collect() }
    }
}

impl Engine for RayEngine<'_> {
    fn name(&self) -> String {
        format!("rays:{}", self.suns.first().map_or(0, Vec::len))
    }

    fn lane_count(&self) -> usize {
        self.suns.len()
    }

    fn session(&self) -> Box<dyn Session + '_> {
        let last_occluder = self.suns.iter().map(|suns| vec![None; suns.len()]).collect();
        Box::new(RaySession { engine: self, last_occluder, work: Work::default() })
    }
}

struct RaySession<'a> {
    engine: &'a RayEngine<'a>,
    /// For each lane and sun.
    last_occluder: Vec<Vec<Option<Occluder>>>,
    work: Work,
}

impl Session for RaySession<'_> {
    fn lit(&mut self, points: &[SurfacePoint], answers: &mut IntervalTable) {
        for point in points {
            let probe = Probe::new(self.engine.tracer, point);
            for lane in 0..self.engine.suns.len() {
                answers.push(&self.lit_along(lane, &probe));
            }
        }
    }

    fn work(&self) -> Work {
        self.work
    }
}

impl RaySession<'_> {
    fn lit_along(&mut self, lane: usize, probe: &Probe) -> Intervals {
        let count = self.engine.suns[lane].len();
        let mut lit = Vec::new();
        let mut start = None;
        let mut before = None;
        for step in 0..count {
            match (self.is_lit(lane, probe, step, &mut before), start) {
                (true, None) => start = Some(step),
                (false, Some(first)) => {
                    lit.push([first as f64 / count as f64, step as f64 / count as f64]);
                    start = None;
                }
                _ => {}
            }
        }
        lit.extend(start.map(|first| [first as f64 / count as f64, 1.0]));
        Intervals::from_unsorted(lit)
    }

    /// `before` is the occluder of the previous position of the sun; it becomes that of this one.
    fn is_lit(&mut self, lane: usize, probe: &Probe, step: usize, before: &mut Option<Occluder>) -> bool {
        let Some(sun) = &self.engine.suns[lane][step] else { return false };
        let Some(start) = probe.start_towards(sun.unit()) else { return false };
        self.work.rays += 1;
        let last = &mut self.last_occluder[lane][step];
        let occluder = probe.occluder(start, sun, [*last, *before]);
        *before = occluder;
        *last = occluder.or(*last);
        occluder.is_none()
    }
}
