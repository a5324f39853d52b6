//! Rays from one point towards single positions of the sun, shared by the engines that trace rays.

use crate::atlas::SurfacePoint;
use crate::trace::{Direction, Occluder, Tracer};
use glam::DVec3;

/// A side of a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum SurfaceSide {
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

    /// What occludes the sun from a side, if anything does. The guesses are tested before the hierarchy is walked.
    #[inline]
    pub fn occluder(&self, side: SurfaceSide, sun: &Direction, guesses: [Option<Occluder>; 2]) -> Option<Occluder> {
        let origin = self.origins[side as usize];
        let occludes = |guess: &Occluder| self.tracer.is_occluded_by(*guess, origin, sun);
        let guessed = guesses.into_iter().flatten().find(occludes);
        guessed.or_else(|| self.tracer.occluder(origin, sun))
    }
}

/// The side of a point that faces the sun; none where a single-sided surface faces away.
#[inline]
pub(super) fn side_towards(point: &SurfacePoint, sun: DVec3) -> Option<SurfaceSide> {
    let above = point.normal.dot(sun);
    match above {
        above if above > 0.0 => Some(SurfaceSide::Front),
        above if above < 0.0 && point.is_double_sided => Some(SurfaceSide::Back),
        _ => None,
    }
}
