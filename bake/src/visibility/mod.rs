//! Lit intervals: when each surface point sees the sun or a lamp.
//!
//! `V(x, t)` is 1 where the sun's centre is above the world horizon, above the surface's plane, and not occluded. An
//! [`Engine`] finds all lit intervals of a point at once. For a double-sided surface, rays start on the side that faces
//! the sun. So one list serves both of its faces: at any moment the sun is in front of exactly one of them, and the
//! runtime knows which. On smooth surfaces the shading normal says in front of which (`start.rs`).

mod bisect;
mod buried;
mod exact;
mod hiders;
mod lamp;
mod probe;
mod rays;
mod start;

pub use crate::intervals::{IntervalTable, Intervals};
pub use bisect::BisectEngine;
pub(crate) use buried::{Answers, BuriedPoints, fill_buried};
pub use exact::{Alone, ExactEngine, OccluderFinder, OccluderSession};
pub use hiders::Hiders;
pub use lamp::{LampEngine, LampRays};
pub use rays::RayEngine;
pub use start::{RayStart, SurfaceSide, ray_starts};

use crate::atlas::SurfacePoint;
use rayon::prelude::*;

/// A way to find lit intervals, along one path or along several side by side (the lanes of a disc). Implementations:
/// [`ExactEngine`], [`RayEngine`] and [`BisectEngine`] for the sun, [`LampEngine`] and [`LampRays`] for a lamp.
pub trait Engine: Sync {
    /// Its name with its parameters, as on the command line.
    fn name(&self) -> String;

    /// How many paths it finds intervals for.
    fn lane_count(&self) -> usize;

    /// Starts a run of neighbouring points. A session may reuse what it found at one point for the next, as long as no
    /// answer depends on it: the same point has the same answer in any session.
    fn session(&self) -> Box<dyn Session + '_>;
}

/// A run of an engine over neighbouring points.
pub trait Session {
    /// Adds the lit intervals of each point, in the order of the points; for each point one list a lane.
    fn lit(&mut self, points: &[SurfacePoint], answers: &mut IntervalTable);

    /// Work done since the session started.
    fn work(&self) -> Work;

    /// What hid the sun from each point so far, if the engine notes that.
    fn take_hiders(&mut self) -> Hiders {
        Hiders::default()
    }
}

/// Work done, by kind.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Work {
    /// Rays traced.
    pub rays: u64,
    /// Hierarchy nodes visited.
    pub nodes: u64,
    /// Triangles tested.
    pub triangles: u64,
}

impl std::ops::Add for Work {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            rays: self.rays + other.rays,
            nodes: self.nodes + other.nodes,
            triangles: self.triangles + other.triangles,
        }
    }
}

/// Lit intervals of one point, along each of the engine's lanes.
pub fn lit_at(engine: &dyn Engine, point: &SurfacePoint) -> Vec<Intervals> {
    let mut answers = IntervalTable::default();
    engine.session().lit(std::slice::from_ref(point), &mut answers);
    answers.iter().collect()
}

/// How many neighbouring points a session is given.
const RUN: usize = 1024;

/// What an engine found of some points.
pub struct Solved {
    /// Lit intervals in the order of the points: for each point one list for each of the engine's lanes.
    pub tables: Vec<IntervalTable>,
    /// What hides the sun from each point, if the engine notes that.
    pub hiders: Hiders,
    /// What it took.
    pub work: Work,
}

/// Finds the lit intervals of every point, on all threads of the current pool. `on_progress` gets the number of points
/// that were done and returns false to stop; then there is no answer.
pub fn solve_visibility(
    engine: &dyn Engine,
    point_count: usize,
    point: impl Fn(usize) -> SurfacePoint + Sync,
    on_progress: impl Fn(usize) -> bool + Sync,
) -> Option<Solved> {
    let find_run = |run| {
        let range = run * RUN..point_count.min((run + 1) * RUN);
        let mut session = engine.session();
        let points: Vec<SurfacePoint> = range.clone().map(&point).collect();
        let mut table = IntervalTable::default();
        session.lit(&points, &mut table);
        on_progress(range.len()).then(|| (table, session.take_hiders(), session.work()))
    };
    let runs: Vec<(IntervalTable, Hiders, Work)> =
        (0..point_count.div_ceil(RUN)).into_par_iter().map(find_run).collect::<Option<_>>()?;
    let work = runs.iter().fold(Work::default(), |sum, (.., work)| sum + *work);
    let (tables, hiders) = runs.into_iter().map(|(table, hiders, _)| (table, hiders)).unzip();
    Some(Solved { tables, hiders: Hiders::joined(hiders), work })
}
