//! Closing a query's gaps with triangles, eight at a time.

use super::arc::ArcFrame;
use super::gaps::Gaps;
use super::holes::{Parts, Pierced};
use super::near::{hidden_near, meet};
use super::seeds::Seeds;
use super::solve::{Hidden, Packet, hide, turned};
use super::walk::bits;
use crate::trace::Tracer;
use fearless_simd::Simd;
use glam::DVec3;
use smallvec::SmallVec;

/// A point, one of its sides, and what of the arc is still lit there.
#[derive(Debug, Clone)]
pub(super) struct Query {
    /// Where its rays start, arc frame.
    pub origin: DVec3,
    /// Unit vector that the side faces, arc frame.
    pub side: DVec3,
    /// One for each lane.
    pub gaps: SmallVec<[Gaps; 3]>,
}

impl Query {
    pub fn is_done(&self) -> bool {
        self.gaps.iter().all(Gaps::is_empty)
    }
}

/// What it takes to close gaps on one arc, and the triangles to try first.
pub(super) struct Coverer<'a> {
    pub tracer: &'a Tracer,
    frame: &'a ArcFrame,
    /// What was of use at the point before: solid triangles, and those with holes.
    seeds: [Seeds; 2],
    /// What is of use at this point.
    next_seeds: [Seeds; 2],
    /// Room for one answer a lane.
    hidden: Vec<Hidden>,
}

impl<'a> Coverer<'a> {
    pub fn new(tracer: &'a Tracer, frame: &'a ArcFrame) -> Self {
        Self {
            tracer,
            frame,
            seeds: Default::default(),
            next_seeds: Default::default(),
            hidden: vec![Hidden::default(); frame.lanes.len()],
        }
    }

    /// Adds a triangle to a packet.
    #[inline]
    pub fn add_to(&self, packet: &mut Packet, id: u32) {
        packet.push(id, self.tracer.corners()[id as usize].map(|corner| turned(corner, &self.frame.arc_from_bake)));
    }

    /// Closes what was of use at the point before: solid triangles, then those with holes, which cost more. Returns how many
    /// were looked at.
    pub fn close_with_seeds<S: Simd>(&mut self, simd: S, query: &mut Query) -> u64 {
        std::mem::swap(&mut self.seeds, &mut self.next_seeds);
        self.next_seeds.iter_mut().for_each(Seeds::clear);
        let seeds = std::mem::take(&mut self.seeds);
        let mut triangles = 0;
        for packet in seeds.iter().flat_map(Seeds::packets) {
            triangles += packet.count as u64;
            if self.close(simd, packet, query) && query.is_done() {
                break;
            }
        }
        self.seeds = seeds;
        triangles
    }

    /// Closes what some triangles hide, and notes which did; whether any.
    pub fn close<S: Simd>(&mut self, simd: S, packet: &Packet, query: &mut Query) -> bool {
        let Packet { corners, ids, count } = packet;
        let lanes = self.frame.lanes.len();
        let run_up = self.tracer.run_up();
        let near = hide(simd, corners, query.origin, run_up * run_up, &self.frame.lanes, &query.gaps, &mut self.hidden);
        let real = (1u32 << *count) - 1;
        let mut useful = 0;
        for lane in 0..lanes {
            for slot in bits(self.hidden[lane].mask & real & !near) {
                let hidden = &self.hidden[lane];
                let closed = if hidden.split & (1 << slot) == 0 && !self.tracer.has_holes(ids[slot]) {
                    query.gaps[lane].close([hidden.low[slot], hidden.high[slot]])
                } else {
                    self.close_pieces(simd, ids[slot], &pieces(hidden, slot), lane, query)
                };
                useful |= u32::from(closed > 0.0) << slot;
            }
            for slot in bits(near & real) {
                let corners = self.relative(ids[slot], query.origin);
                let spans = hidden_near(self.frame, lane, corners, run_up);
                useful |= u32::from(self.close_pieces(simd, ids[slot], &spans, lane, query) > 0.0) << slot;
            }
        }
        for slot in bits(useful) {
            let kind = usize::from(self.tracer.has_holes(ids[slot]));
            self.next_seeds[kind].add(ids[slot], packet.corners_of(slot));
        }
        useful != 0
    }

    /// Corners of a triangle relative to a point, arc frame.
    fn relative(&self, id: u32, origin: DVec3) -> [DVec3; 3] {
        self.tracer.corners()[id as usize].map(|corner| turned(corner, &self.frame.arc_from_bake) - origin)
    }

    /// Closes what a triangle hides in several spans, or with holes.
    fn close_pieces<S: Simd>(&self, simd: S, id: u32, spans: &[[f64; 2]], lane: usize, query: &mut Query) -> f64 {
        let open = meet(spans, query.gaps[lane].as_slice());
        if open.is_empty() || !self.tracer.has_holes(id) {
            return open.iter().map(|&span| query.gaps[lane].close(span)).sum();
        }
        let Some(cut) = self.tracer.cut(id) else { return 0.0 };
        let pierced = Pierced::new(cut, self.relative(id, query.origin), self.frame.lanes[lane]);
        let mut solid = Parts::new();
        open.iter().for_each(|&span| pierced.solid_parts(simd, span, &mut solid));
        solid.iter().map(|&span| query.gaps[lane].close(span)).sum()
    }
}

/// The hidden span of a triangle less its cuts.
fn pieces(hidden: &Hidden, slot: usize) -> Vec<[f64; 2]> {
    let mut left = Gaps::from_unsorted(&mut [[hidden.low[slot], hidden.high[slot]]]);
    if hidden.split & (1 << slot) != 0 {
        for cut in &hidden.cuts {
            let [start, end] = [cut[0][slot], cut[1][slot]];
            if start < end {
                left.close([start, end]);
            }
        }
    }
    left.as_slice().to_vec()
}
