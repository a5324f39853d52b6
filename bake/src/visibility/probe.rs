//! Rays from one point towards single suns: what the engines that trace rays share.

use crate::atlas::SurfacePoint;
use crate::trace::{Direction, Occluder, Tracer};
use glam::DVec3;

/// A side of a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    Front,
    Back,
}

/// A point, and where its rays start on either side of it.
pub(super) struct Probe<'a> {
    tracer: &'a Tracer,
    origins: [DVec3; 2],
}

impl<'a> Probe<'a> {
    pub fn new(tracer: &'a Tracer, point: &SurfacePoint) -> Self {
        let sides = [point.normal, -point.normal];
        Self { tracer, origins: sides.map(|side| tracer.lift(point.position_m, side, point.triangle)) }
    }

    /// What hides a sun from a side, if anything does. Each guess is tried before the hierarchy is walked.
    #[inline]
    pub fn occluder(&self, side: Side, sun: &Direction, guesses: [Option<Occluder>; 2]) -> Option<Occluder> {
        let origin = self.origins[side as usize];
        let hides = |guess: &Occluder| self.tracer.is_occluded_by(*guess, origin, sun);
        let guessed = guesses.into_iter().flatten().find(hides);
        guessed.or_else(|| self.tracer.occluder(origin, sun))
    }
}

/// The side of a point from which a sun counts, if it does.
#[inline]
pub(super) fn side_towards(point: &SurfacePoint, sun: DVec3) -> Option<Side> {
    let above = point.normal.dot(sun);
    match above {
        above if above > 0.0 => Some(Side::Front),
        above if above < 0.0 && point.is_double_sided => Some(Side::Back),
        _ => None,
    }
}
