//! Closing a query's gaps with triangles, eight at a time.

use super::alpha_mask::MaskedTriangleView;
use super::arc::ArcFrame;
use super::follow::{Follower, SolidSpan};
use super::gaps::Gaps;
use super::near::hidden_near;
use super::seeds::SeedBatches;
use super::solve::{HiddenSpans, TriangleBatch, hide};
use crate::trace::Tracer;
use crate::trace::bvh16::bits;
use fearless_simd::Simd;
use glam::DVec3;

/// Solid spans of a mask that are shorter than this, in diamond angle, are due to rounding: a corner that is just
/// touched.
const LEAST_SOLID: f64 = 1e-10;

/// A point, one of its sides, and the spans of the arc that are still lit there.
#[derive(Debug, Clone, Default)]
pub(super) struct Query {
    /// Where its rays start, arc frame.
    pub origin: DVec3,
    /// Unit vector that the side faces, arc frame.
    pub side: DVec3,
    /// One for each lane.
    pub gaps: Vec<Gaps>,
}

impl Query {
    pub fn is_done(&self) -> bool {
        self.gaps.iter().all(Gaps::is_empty)
    }
}

/// Closes gaps on one arc, and keeps the triangles to test first.
pub(super) struct GapCloser<'a> {
    pub tracer: &'a Tracer,
    frame: &'a ArcFrame,
    /// Triangles that closed gaps at the previous point: solid ones, and alpha-masked ones.
    seeds: [SeedBatches; 2],
    /// Triangles that close gaps at this point.
    next_seeds: [SeedBatches; 2],
    /// Triangles that closed gaps since the last query's start.
    pub useful: Vec<u32>,
    /// Memory for one answer a lane.
    hidden: Vec<HiddenSpans>,
    follower: Follower<'a>,
}

impl<'a> GapCloser<'a> {
    pub fn new(tracer: &'a Tracer, frame: &'a ArcFrame) -> Self {
        Self {
            tracer,
            frame,
            seeds: Default::default(),
            next_seeds: Default::default(),
            useful: Vec::new(),
            hidden: vec![HiddenSpans::default(); frame.lanes.len()],
            follower: Follower::default(),
        }
    }

    /// Rotates the triangles of a batch into the arc's frame and closes what they occlude. True if they close
    /// anything.
    pub fn rotate_and_close<S: Simd>(&mut self, simd: S, batch: &mut TriangleBatch, query: &mut Query) -> bool {
        batch.rotate(simd, &self.frame.arc_from_bake);
        self.close(simd, batch, query)
    }

    /// Closes gaps with the triangles of the previous point: solid ones, then alpha-masked ones, which cost more.
    /// Returns how many were tested.
    pub fn close_with_seeds<S: Simd>(&mut self, simd: S, query: &mut Query) -> u64 {
        std::mem::swap(&mut self.seeds, &mut self.next_seeds);
        self.next_seeds.iter_mut().for_each(SeedBatches::clear);
        self.useful.clear();
        let seeds = std::mem::take(&mut self.seeds);
        let mut triangles = 0;
        for batch in seeds.iter().flat_map(SeedBatches::batches) {
            triangles += batch.count as u64;
            if self.close(simd, batch, query) && query.is_done() {
                break;
            }
        }
        self.seeds = seeds;
        triangles
    }

    /// Closes what some triangles occlude, and keeps those that closed anything. True if any did.
    pub fn close<S: Simd>(&mut self, simd: S, batch: &TriangleBatch, query: &mut Query) -> bool {
        let TriangleBatch { corners, ids, count } = batch;
        let run_up = self.tracer.run_up();
        let near = hide(simd, corners, query.origin, run_up * run_up, &self.frame.lanes, &query.gaps, &mut self.hidden);
        let real = (1u32 << *count) - 1;
        let mut useful = 0;
        for lane in 0..self.frame.lanes.len() {
            for index in bits(self.hidden[lane].mask & real & !near) {
                let hidden = &self.hidden[lane];
                let closes = match hidden.whole(index) {
                    Some([start, end]) if start >= end => false,
                    Some(span) if !self.tracer.has_alpha_mask(ids[index]) => query.gaps[lane].close(span),
                    _ => self.close_pieces(batch, [index, lane], &self.hidden[lane].pieces(index), query),
                };
                useful |= u32::from(closes) << index;
            }
            for index in bits(near & real) {
                let corners = batch.corners_of(index).map(|corner| corner - query.origin);
                let spans = hidden_near(self.frame, lane, corners, run_up);
                useful |= u32::from(self.close_pieces(batch, [index, lane], &spans, query)) << index;
            }
        }
        if !self.follower.is_empty() {
            self.follower.follow();
            for &SolidSpan { index_in_batch: index, lane, span } in &self.follower.found {
                useful |= u32::from(span[1] - span[0] > LEAST_SOLID && query.gaps[lane].close(span)) << index;
            }
            self.follower.clear();
        }
        for index in bits(useful) {
            let kind = usize::from(self.tracer.has_alpha_mask(ids[index]));
            self.next_seeds[kind].add(ids[index], batch.corners_of(index));
            self.useful.push(ids[index]);
        }
        useful != 0
    }

    /// Closes what a triangle occludes in several spans; an alpha-masked one is added to be followed.
    fn close_pieces(&mut self, batch: &TriangleBatch, at: [usize; 2], spans: &[[f64; 2]], query: &mut Query) -> bool {
        let [index, lane] = at;
        let gaps = &mut query.gaps[lane];
        let Some(mask) = self.tracer.mask(batch.ids[index]) else {
            return spans.iter().fold(false, |closes, &span| gaps.close(span) | closes);
        };
        let both = |span: &[f64; 2], gap: &[f64; 2]| [span[0].max(gap[0]), span[1].min(gap[1])];
        let open = spans.iter().flat_map(|span| gaps.as_slice().iter().map(move |gap| both(span, gap)));
        let mut open = open.filter(|span| span[0] < span[1]).peekable();
        if open.peek().is_some() {
            let corners = batch.corners_of(index).map(|corner| corner - query.origin);
            self.follower.add(MaskedTriangleView::new(mask, at, corners, self.frame.lanes[lane]), open);
        }
        false
    }
}
