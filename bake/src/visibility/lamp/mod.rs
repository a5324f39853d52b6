//! Lit intervals of a lamp that moves through the scene.
//!
//! From a point, all rays to the lamp on one straight segment of its path lie in one triangle. One walk of the
//! hierarchy against that triangle (`walk.rs`) finds every occluder of the segment, and each occludes a span of it in
//! closed form, which may end where the lamp passes through the occluder's plane (`hide.rs`); alpha masks are followed
//! texel by texel (`alpha_mask.rs`). The walk skips boxes that can occlude only what is occluded already, and stops
//! when nothing is open (`open.rs`). The occluders of the previous point are tested first (`seeds.rs`).
//!
//! A lamp has no horizon. The condition that it is in front of the surface's planes is linear in s, too. Rays start
//! where [`super::ray_starts`] says. [`LampRays`] traces rays to evenly spaced
//! positions of the lamp, for comparison.

mod alpha_mask;
mod hide;
mod open;
mod rays;
mod seeds;
mod span;
mod walk;

pub use rays::LampRays;

use super::start::{RayStart, ray_starts};
use super::{Engine, IntervalTable, Intervals, Session, Work};
use crate::atlas::SurfacePoint;
use crate::lamp::{LampPath, LampSegment};
use crate::trace::Tracer;
use alpha_mask::{MaskedTriangleView, SolidSpans};
use glam::DVec3;
use hide::SegmentFromPoint;
use open::OpenSpans;
use seeds::SeedTriangles;
use span::{Span, common, not_negative};
use walk::{NextLeaf, PointSegmentTriangle, Tree};

/// Lit intervals of a lamp in closed form.
pub struct LampEngine<'a> {
    tracer: &'a Tracer,
    tree: Tree,
    segments: Vec<LampSegment>,
}

impl<'a> LampEngine<'a> {
    /// Prepares a path, bake space.
    pub fn new(tracer: &'a Tracer, path: &LampPath) -> Self {
        Self { tracer, tree: Tree::new(tracer), segments: path.segments().collect() }
    }
}

impl Engine for LampEngine<'_> {
    fn name(&self) -> String {
        "exact".into()
    }

    fn lane_count(&self) -> usize {
        1
    }

    fn session(&self) -> Box<dyn Session + '_> {
        let seeds = self.segments.iter().map(|_| Default::default()).collect();
        Box::new(LampSession { engine: self, seeds, work: Work::default(), stack: Vec::new() })
    }
}

struct LampSession<'a> {
    engine: &'a LampEngine<'a>,
    /// For each segment, one for each kind of start.
    seeds: Vec<[SeedTriangles; RayStart::KINDS]>,
    work: Work,
    stack: Vec<u32>,
}

impl Session for LampSession<'_> {
    fn lit(&mut self, points: &[SurfacePoint], answers: &mut IntervalTable) {
        for point in points {
            let mut lit = Vec::new();
            let starts = ray_starts(point);
            for index in 0..self.engine.segments.len() {
                starts.iter().for_each(|start| self.lit_on(index, point, start, &mut lit));
            }
            answers.push(&Intervals::from_unsorted(lit));
        }
    }

    fn work(&self) -> Work {
        self.work
    }
}

impl LampSession<'_> {
    /// Adds the times at which rays from one start of a point reach the lamp on a segment.
    fn lit_on(&mut self, index: usize, point: &SurfacePoint, start: &RayStart, lit: &mut Vec<[f64; 2]>) {
        let LampEngine { tracer, segments, .. } = self.engine;
        let segment = &segments[index];
        let in_front_of = |normal: DVec3| in_front_of_plane(segment, point.position_m, normal);
        let in_front = in_front_of(start.normal);
        let mut open = OpenSpans::new(match start.also {
            Some(also) => in_front.and_then(|span| common(span, in_front_of(also)?)),
            None => in_front,
        });
        if open.is_empty() {
            return;
        }
        let scale = tracer.tracer_from_bake();
        let origin = start.origin_m(tracer, point) * scale;
        let from_point =
            SegmentFromPoint { ends: segment.ends_m.map(|end| end * scale - origin), run_up: tracer.run_up() };
        self.close(index, start.kind(), origin, &from_point, &mut open);
        lit.extend(open.as_slice().iter().map(|span| span.map(|s| t_of(segment, s))));
    }

    /// Closes all that is occluded.
    fn close(&mut self, index: usize, kind: usize, origin: DVec3, from_point: &SegmentFromPoint, open: &mut OpenSpans) {
        let tracer = self.engine.tracer;
        let seeds = &mut self.seeds[index][kind];
        seeds.next_point();
        self.work.triangles += seeds.try_all(|id| (close_with(tracer, id, origin, from_point, open), open.is_empty()));
        if open.is_empty() {
            return;
        }
        let mut triangle = PointSegmentTriangle::new(origin, from_point, open);
        self.engine.tree.start(&mut self.stack);
        while let NextLeaf::Leaf(ids) = self.engine.tree.next_leaf(&triangle, &mut self.stack, &mut self.work.nodes) {
            self.work.triangles += ids.len() as u64;
            let mut is_useful = false;
            for &id in ids.iter().filter(|&&id| close_with(tracer, id, origin, from_point, open)) {
                seeds.add(id);
                is_useful = true;
            }
            if open.is_empty() {
                return;
            }
            if is_useful {
                triangle.update(open);
            }
        }
    }
}

/// Where on a segment the lamp is in front of a side of a plane.
fn in_front_of_plane(segment: &LampSegment, position_m: DVec3, normal: DVec3) -> Option<Span> {
    let heights = segment.ends_m.map(|end| normal.dot(end - position_m));
    not_negative(heights).filter(|_| heights.iter().any(|height| *height > 0.0))
}

/// Path time on a segment; its ends are exactly the segment's.
fn t_of(segment: &LampSegment, s: f64) -> f64 {
    let [start, end] = segment.t;
    if s == 1.0 { end } else { start + s * (end - start) }
}

/// Closes what a triangle occludes. True if any of it was open.
fn close_with(tracer: &Tracer, id: u32, origin: DVec3, from_point: &SegmentFromPoint, open: &mut OpenSpans) -> bool {
    let corners = tracer.corners()[id as usize].map(|corner| corner.as_dvec3() - origin);
    let hidden = from_point.hidden_by(corners);
    if hidden.is_empty() {
        return false;
    }
    match tracer.mask(id) {
        None => hidden.iter().fold(false, |any, &span| open.close(span) | any),
        Some(mask) => {
            let pierced = MaskedTriangleView::new(mask, from_point, corners);
            let mut solid = SolidSpans::new();
            for &span in &hidden {
                open.as_slice().iter().filter_map(|&still| common(span, still)).for_each(|part| {
                    pierced.solid_parts(part, &mut solid);
                });
            }
            solid.iter().fold(false, |any, &span| open.close(span) | any)
        }
    }
}
