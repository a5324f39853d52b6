//! When each surface point sees the sun.
//!
//! `V(x, t)` is 1 where the sun's centre is above the world horizon, above the surface's plane, and not occluded. An
//! [`Engine`] answers with all lit intervals of a point at once. A double-sided surface is asked about from whichever
//! side the sun is on, so one list serves both of its faces: at any moment the sun stands before just one of them, and
//! the run time knows which.

pub mod intervals;
mod rays;

pub use intervals::{IntervalTable, Intervals};
pub use rays::RayEngine;

use crate::atlas::SurfacePoint;
use rayon::prelude::*;

/// A way to find lit intervals. Implementations: [`RayEngine`].
pub trait Engine: Sync {
    /// Its name with its parameters, as on the command line.
    fn name(&self) -> String;

    /// Starts on a run of neighbouring points. What a session learns from one point it may use for the next, so long as
    /// no answer depends on it: the same point has the same answer in any session.
    fn session(&self) -> Box<dyn Session + '_>;
}

/// An engine at work on neighbouring points, one after the other.
pub trait Session {
    /// When the point sees the sun.
    fn lit(&mut self, point: &SurfacePoint) -> Intervals;

    /// Work done since the session started.
    fn work(&self) -> Work;
}

/// Work done, by kind.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Work {
    /// Rays traced.
    pub rays: u64,
}

/// How many neighbouring points a session is given.
const RUN: usize = 1024;

/// Asks an engine about every point, on all threads of the current pool; answers come in the order of the points.
/// `on_progress` gets the number of points that were done and returns false to stop; then there is no answer.
pub fn find_lit(
    engine: &dyn Engine,
    point_count: usize,
    point: impl Fn(usize) -> SurfacePoint + Sync,
    on_progress: impl Fn(usize) -> bool + Sync,
) -> Option<(Vec<IntervalTable>, Work)> {
    let find_run = |run| {
        let range = run * RUN..point_count.min((run + 1) * RUN);
        let mut session = engine.session();
        let mut table = IntervalTable::default();
        for index in range.clone() {
            table.push(&session.lit(&point(index)));
        }
        on_progress(range.len()).then(|| (table, session.work()))
    };
    let runs: Vec<(IntervalTable, Work)> =
        (0..point_count.div_ceil(RUN)).into_par_iter().map(find_run).collect::<Option<_>>()?;
    let work = Work { rays: runs.iter().map(|(_, work)| work.rays).sum() };
    Some((runs.into_iter().map(|(table, _)| table).collect(), work))
}
