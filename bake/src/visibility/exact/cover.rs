//! Closing a query's gaps with triangles, eight at a time.

use super::arc::ArcFrame;
use super::gaps::Gaps;
use super::holes::{Parts, Pierced};
use super::near::{hidden_near, meet};
use super::seeds::Seeds;
use super::solve::{Hidden, Packet, hide, turned};
use super::walk::bits;
use super::wide::WIDTH;
use crate::trace::Tracer;
use fearless_simd::Simd;
use glam::DVec3;
use smallvec::SmallVec;

/// Most lanes across a disc.
pub(super) const MOST_LANES: usize = 8;

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
    tracer: &'a Tracer,
    frame: &'a ArcFrame,
    /// What was of use at the point before.
    seeds: Seeds,
    /// What is of use at this point.
    next_seeds: Seeds,
    /// Triangles to be solved next.
    collected: Packet,
    /// Room for one answer a lane.
    hidden: [Hidden; MOST_LANES],
    /// Triangles of the packet at hand that closed something.
    useful: u32,
}

impl<'a> Coverer<'a> {
    pub fn new(tracer: &'a Tracer, frame: &'a ArcFrame) -> Self {
        Self {
            tracer,
            frame,
            seeds: Seeds::default(),
            next_seeds: Seeds::default(),
            collected: Packet::default(),
            hidden: [Hidden::default(); MOST_LANES],
            useful: 0,
        }
    }

    /// Puts a triangle among those to be solved next; whether there are then enough.
    #[inline]
    pub fn collect(&mut self, id: u32) -> bool {
        let corners = self.tracer.corners()[id as usize].map(|corner| turned(corner, &self.frame.arc_from_bake));
        self.collected.push(id, corners);
        self.collected.count == WIDTH
    }

    /// Closes what the collected triangles hide; whether that was anything.
    pub fn close_with_collected<S: Simd>(&mut self, simd: S, query: &mut Query) -> bool {
        let collected = std::mem::take(&mut self.collected);
        self.close(simd, &collected, query);
        self.collected = collected;
        self.collected.count = 0;
        self.useful != 0
    }

    /// Closes what was of use at the point before. Returns how many triangles were looked at.
    pub fn close_with_seeds<S: Simd>(&mut self, simd: S, query: &mut Query) -> u64 {
        std::mem::swap(&mut self.seeds, &mut self.next_seeds);
        self.next_seeds.clear();
        let seeds = std::mem::take(&mut self.seeds);
        let mut triangles = 0;
        for packet in seeds.packets() {
            triangles += packet.count as u64;
            self.close(simd, packet, query);
            if self.useful != 0 && query.is_done() {
                break;
            }
        }
        self.seeds = seeds;
        triangles
    }

    /// Closes what some triangles hide, and notes which did.
    fn close<S: Simd>(&mut self, simd: S, packet: &Packet, query: &mut Query) {
        let Packet { corners, ids, count } = packet;
        let lanes = self.frame.lanes.len();
        let run_up = self.tracer.run_up();
        let near = hide(
            simd,
            corners,
            query.origin,
            run_up * run_up,
            &self.frame.lanes,
            &query.gaps,
            &mut self.hidden[..lanes],
        );
        let real = (1u32 << *count) - 1;
        self.useful = 0;
        for lane in 0..lanes {
            for slot in bits(self.hidden[lane].mask & real & !near) {
                let hidden = &self.hidden[lane];
                let closed = if hidden.split & (1 << slot) == 0 && !self.tracer.has_holes(ids[slot]) {
                    query.gaps[lane].close([hidden.low[slot], hidden.high[slot]])
                } else {
                    self.close_pieces(simd, ids[slot], &pieces(hidden, slot), lane, query)
                };
                self.useful |= u32::from(closed > 0.0) << slot;
            }
            for slot in bits(near & real) {
                let corners = self.relative(ids[slot], query.origin);
                let spans = hidden_near(self.frame, lane, corners, run_up);
                self.useful |= u32::from(self.close_pieces(simd, ids[slot], &spans, lane, query) > 0.0) << slot;
            }
        }
        for slot in bits(self.useful) {
            self.next_seeds.add(ids[slot], packet.corners_of(slot));
        }
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
