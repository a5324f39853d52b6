//! Exact intervals: one query a point instead of many rays.

mod arc;
mod boxes;
mod cover;
mod gaps;
mod holes;
mod near;
mod seeds;
mod solve;
mod walk;
mod wide;

use super::{Engine, IntervalTable, Intervals, Session, Work};
use crate::atlas::SurfacePoint;
use crate::sun::SunPath;
use crate::trace::Tracer;
use arc::ArcFrame;
use boxes::{Frames, Wanted};
use cover::{Coverer, Query};
use fearless_simd::{Level, Simd, dispatch};
use gaps::Gaps;
use glam::{DMat3, DVec3};
use smallvec::SmallVec;
use walk::{Pending, close_by_walk};
use wide::Wide;

/// Growth of every box, tracer space (whose half size is 512 to 1024): four times the steps of an `f32` that turning a
/// box into another frame can amount to.
const BOX_PADDING: f32 = 1.0 / 256.0;

/// Lit intervals in closed form.
pub struct ExactEngine<'a> {
    tracer: &'a Tracer,
    wide: Wide,
    arcs: Vec<Arc>,
    lane_count: usize,
    level: Level,
}

struct Arc {
    frame: ArcFrame,
    frames: Frames,
}

impl<'a> ExactEngine<'a> {
    /// Prepares the arcs of a path, and of the lanes beside it.
    pub fn new(tracer: &'a Tracer, lanes: &[SunPath]) -> Self {
        let frames = ArcFrame::of_path(lanes);
        let axes = frames.first().map_or(DMat3::IDENTITY, |frame| frame.arc_from_bake);
        let wide = Wide::new(tracer, axes, BOX_PADDING);
        let arc = |frame| Arc { frames: Frames::new(&frame, axes, BOX_PADDING), frame };
        let arcs = frames.into_iter().map(arc).collect();
        Self { tracer, wide, arcs, lane_count: lanes.len(), level: Level::new() }
    }
}

impl Engine for ExactEngine<'_> {
    fn name(&self) -> String {
        "exact".into()
    }

    fn lane_count(&self) -> usize {
        self.lane_count
    }

    fn session(&self) -> Box<dyn Session + '_> {
        let coverer = |arc| Coverer::new(self.tracer, arc);
        let coverers = self.arcs.iter().map(|arc| [coverer(&arc.frame), coverer(&arc.frame)]).collect();
        Box::new(ExactSession { engine: self, coverers, work: Work::default(), stack: Vec::new() })
    }
}

struct ExactSession<'a> {
    engine: &'a ExactEngine<'a>,
    /// For each arc, one for each side of a surface: seeds of the front are not those of the back.
    coverers: Vec<[Coverer<'a>; 2]>,
    work: Work,
    stack: Vec<Pending>,
}

impl Session for ExactSession<'_> {
    fn lit(&mut self, points: &[SurfacePoint], answers: &mut IntervalTable) {
        let level = self.engine.level;
        dispatch!(level, simd => self.lit_with(simd, points, answers));
    }

    fn work(&self) -> Work {
        self.work
    }
}

impl ExactSession<'_> {
    fn lit_with<S: Simd>(&mut self, simd: S, points: &[SurfacePoint], answers: &mut IntervalTable) {
        let mut lit: SmallVec<[Vec<[f64; 2]>; 3]> = (0..self.engine.lane_count).map(|_| Vec::new()).collect();
        for point in points {
            for index in 0..self.engine.arcs.len() {
                for side in 0..=usize::from(point.is_double_sided) {
                    let Some(mut query) = self.query(index, point, side) else { continue };
                    self.answer(simd, index, side, &mut query);
                    let frame = &self.engine.arcs[index].frame;
                    for (gaps, times) in query.gaps.iter().zip(&mut lit) {
                        times.extend(gaps.as_slice().iter().map(|span| span.map(|u| frame.t_of(u))));
                    }
                }
            }
            for times in &mut lit {
                answers.push(&Intervals::from_unsorted(std::mem::take(times)));
            }
        }
    }

    /// What is asked of an arc at one side of a point; nothing if its sun is never before it.
    fn query(&self, index: usize, point: &SurfacePoint, side: usize) -> Option<Query> {
        let ArcFrame { arc_from_bake, lanes, .. } = &self.engine.arcs[index].frame;
        let normal = if side == 0 { point.normal } else { -point.normal };
        let (up, facing) = (*arc_from_bake * DVec3::Y, *arc_from_bake * normal);
        let open = |lane: usize| {
            let frame = &self.engine.arcs[index].frame;
            let above = frame.half_space(up, 0.0, lane);
            Gaps::of_both(above.as_slice(), frame.half_space(facing, 0.0, lane).as_slice())
        };
        let gaps: SmallVec<[Gaps; 3]> = (0..lanes.len()).map(open).collect();
        if gaps.iter().all(Gaps::is_empty) {
            return None;
        }
        let tracer = self.engine.tracer;
        let start = tracer.lift(point.position_m, normal, point.triangle) * tracer.tracer_from_bake();
        Some(Query { origin: *arc_from_bake * start, side: facing, gaps })
    }

    /// Closes all that is hidden.
    fn answer<S: Simd>(&mut self, simd: S, index: usize, side: usize, query: &mut Query) {
        if self.engine.wide.nodes.is_empty() {
            return;
        }
        let coverer = &mut self.coverers[index][side];
        self.work.triangles += coverer.close_with_seeds(simd, query);
        if !query.is_done() {
            let wanted = Wanted::new(&self.engine.arcs[index].frames, query);
            close_by_walk(simd, &self.engine.wide, wanted, coverer, query, &mut self.stack, &mut self.work);
        }
    }
}
