//! Rays from one point towards single positions of the sun, shared by the engines that trace rays.

use super::start::{RayStart, ray_starts};
use crate::atlas::SurfacePoint;
use crate::trace::{Direction, Occluder, Tracer};
use glam::DVec3;
use smallvec::SmallVec;

/// A point, and where its rays start.
pub(super) struct Probe<'a> {
    tracer: &'a Tracer,
    starts: SmallVec<[(RayStart, DVec3); RayStart::KINDS]>,
}

impl<'a> Probe<'a> {
    pub fn new(tracer: &'a Tracer, point: &SurfacePoint) -> Self {
        let starts = ray_starts(point).into_iter().map(|start| (start, start.origin_m(tracer, point)));
        Self { tracer, starts: starts.collect() }
    }

    /// The starts, in an order in which [`Probe::occluder`] knows them.
    pub fn starts(&self) -> impl Iterator<Item = &RayStart> {
        self.starts.iter().map(|(start, _)| start)
    }

    /// The start of rays to a light in this direction; none where the surface faces away.
    #[inline]
    pub fn start_towards(&self, direction: DVec3) -> Option<usize> {
        self.starts.iter().position(|(start, _)| start.faces(direction))
    }

    /// Where rays of a start begin.
    pub fn origin_m(&self, start: usize) -> DVec3 {
        self.starts[start].1
    }

    /// What occludes the sun from a start, if anything does. The guesses are tested before the hierarchy is walked.
    #[inline]
    pub fn occluder(&self, start: usize, sun: &Direction, guesses: [Option<Occluder>; 2]) -> Option<Occluder> {
        let origin = self.origin_m(start);
        let occludes = |guess: &Occluder| self.tracer.is_occluded_by(*guess, origin, sun);
        let guessed = guesses.into_iter().flatten().find(occludes);
        guessed.or_else(|| self.tracer.occluder(origin, sun))
    }
}
