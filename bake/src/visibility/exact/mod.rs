//! Lit intervals in closed form: one walk of a hierarchy a point instead of many rays.
//!
//! **Theory.** Seen from one point, the suns of an arc lie on a cone about its axis, and for any vector n the product
//! `n . dir(h)` is `A cos h + B sin h + C`, not negative on one span of hour angle whose ends are known in closed form
//! (`arc.rs`). The horizon, the surface's plane and each edge of a triangle, joined with the point to a plane, are such
//! spans. What a triangle hides is where those of its three edges meet (`solve.rs`), and what all triangles hide is the
//! union. So every rise and fall time is exact to the rounding of an `f64`, and nothing is too short to be found.
//!
//! **Practice.** A query starts with what of the arc lies above the horizon and before the surface, as a list of gaps
//! (`gaps.rs`), and occluders close them. First come those that closed gaps at the point before (`seeds.rs`). Then an
//! eight-wide hierarchy with a box for every triangle (`wide.rs`) is walked, near things first (`walk.rs`), past boxes that
//! no sun still lit can meet (`boxes.rs`, `f32`, padded); triangles that pass are collected and solved eight at a time in
//! `f64`. Lanes of a disc differ by declination alone: one walk serves all, with a shell of cones for its cone. Triangles
//! with holes are followed from texel to texel (`holes.rs`), triangles within the run-up of shadow rays have a case of
//! their own (`near.rs`). SIMD is chosen at run time and changes no bit: nothing is fused, every operation rounds alike.
//!
//! **What was tried.** Ratios are from scenes of 36,000 to 600,000 triangles, before and after, on shared cores.
//!
//! * Eight triangles at a time in `f64`: 70 ns for eight where the scalar prototype took 120 to 150 ns for one.
//! * A box for every triangle instead of leaves of eight: a third fewer triangles solved and twice as many nodes; 0.7 of the
//!   time on an open city, no change on dense scenes.
//! * The last point's occluders first, copied as they are found: a third fewer triangles than a list that ages.
//! * Squares of equal texels around holes (a distance map of the mask): 0.6 of the time where there is foliage.
//! * Leaving off the turn into the arc's frame where boxes already lie along it: 0.95.
//! * One list of candidates for a block of 16 or 64 texels, gathered where a few scouts saw light, the rest presumed dark and
//!   checked: **lost**, 1 to 1.5 times the time. Near surfaces are seen from a block under all angles at once, so lists hold
//!   hundreds of triangles just where scenes are dense. Bounding each candidate's span over the block (edge functions are
//!   linear in the point) took only a tenth off the lists.
//! * Testing the boxes of a leaf's triangles before solving the leaf as a whole: **lost**, some box is nearly always met.
//! * Working on gaps kept on the heap: half of all time went to allocation; they are held in place.
//!
//! * Boxes in 8 bits, two cache lines a node instead of four: no change, so left out.
//! * Triangles with holes solved after solid ones, and packets not copied: 0.9 of the time in shade.
//!
//! **What is left.** Where there is foliage a third of the time goes to following holes, once a lane; a sixth to solving, a
//! sixth to a third to boxes, an eighth to lists of gaps. Against rays the gain is least in shade, since a ray that knows
//! its occluder costs 30 ns, and greatest in the open. Not tried: the triangles across the edges of those that bound a gap
//! before the hierarchy is asked (most walks in shade close a slit that has opened between two points); what a large occluder
//! hides from a whole tile; sixteen boxes at a time; leaf cards cut to their outlines when they are loaded.

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
use walk::{Room, close_by_walk};
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
        // Rays start a run-up behind their point, which may be far where a file's coordinates are coarse.
        let padding = BOX_PADDING + tracer.run_up() as f32;
        let wide = Wide::new(tracer, axes, padding);
        let arc = |frame| Arc { frames: Frames::new(&frame, axes, padding), frame };
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
        Box::new(ExactSession { engine: self, coverers, work: Work::default(), room: Room::default() })
    }
}

struct ExactSession<'a> {
    engine: &'a ExactEngine<'a>,
    /// For each arc, one for each side of a surface: seeds of the front are not those of the back.
    coverers: Vec<[Coverer<'a>; 2]>,
    work: Work,
    room: Room,
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
            let work = close_by_walk(simd, &self.engine.wide, wanted, coverer, query, &mut self.room);
            self.work = self.work + work;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Geometry;
    use crate::testing::{SceneBuilder, block, floor, icosphere};
    use glam::{Vec2, Vec3};

    /// A floor under a stone and a post, looked at along three lanes of two arcs.
    fn answers(level: impl Fn() -> Level) -> IntervalTable {
        let stone: Vec<[Vec3; 3]> = icosphere(3).iter().map(|t| t.map(|v| v + Vec3::Y * 0.6)).collect();
        let post = block(Vec3::new(1.2, 0.0, -0.1), Vec3::new(1.3, 3.0, 0.0));
        let scene =
            SceneBuilder::new().soup(&floor(Vec2::splat(-4.0), Vec2::splat(4.0), 0.0)).soup(&stone).soup(&post).build();
        let geometry = Geometry::new(&scene);
        let tracer = Tracer::new(&scene, &geometry);
        let keys = r#"{ "keys": [{ "direction": [1, 0.1, 0.2] }, { "direction": [0, 1, 0.5] }, { "direction": [-1, 0.1, 0] }] }"#;
        let path = crate::sun::parse_keyed(keys, 0.0).expect("a path");
        let lanes = [-0.01, 0.0, 0.01].map(|offset_rad| path.lane(offset_rad));
        let engine = ExactEngine { level: level(), ..ExactEngine::new(&tracer, &lanes) };
        let point = |i: usize| SurfacePoint {
            position_m: geometry.point(0, [0.02 * (i % 20) as f64, 0.02 * (i / 20) as f64]),
            normal: geometry.normal(0),
            is_double_sided: true,
            triangle: 0,
        };
        let points: Vec<SurfacePoint> = (0..400).map(point).collect();
        let mut answers = IntervalTable::default();
        engine.session().lit(&points, &mut answers);
        answers
    }

    #[test]
    fn wider_simd_changes_no_bit() {
        let widest = answers(Level::new);
        assert!(widest.iter().any(|lit| lit.as_slice().len() > 1), "nothing casts a shadow");
        assert_eq!(answers(Level::baseline), widest);
    }
}
