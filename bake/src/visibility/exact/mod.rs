//! Lit intervals in closed form: one walk of a hierarchy a point instead of many rays.
//!
//! **Theory.** Seen from one point, the suns of an arc lie on a cone about its axis, and for any vector n the product
//! `n . dir(h)` is `A cos h + B sin h + C`, not negative on one span of hour angle whose ends are known in closed form
//! (`arc.rs`). The horizon, the surface's plane and each edge of a triangle, joined with the point to a plane, are such
//! spans. A triangle occludes the intersection of the spans of its three edges (`solve.rs`), and all triangles occlude
//! the union. So every rise and fall time is exact to the rounding of an `f64`, and nothing is too short to be found.
//!
//! **Practice.** A query starts with what of the arc lies above the horizon and in front of the surface, as a list of
//! gaps (`gaps.rs`), and occluders close them. First come those that closed gaps at the point before (`seeds.rs`). Then
//! a sixteen-wide hierarchy (`trace/bvh16.rs`) is walked, near things first (`walk.rs`), past boxes and triangles that
//! cannot occlude anything still lit: sixteen at once, in `f32`, padded, by products with planes (`boxes.rs`).
//! Triangles that pass are collected and solved eight at a time in `f64`. Lanes of a disc differ by declination alone:
//! one walk serves all, with a shell of cones for its cone. Across alpha-masked triangles the sun is followed from
//! texel to texel (`alpha_mask.rs`, `follow.rs`). Triangles within the run-up of shadow rays are handled separately
//! (`near.rs`). SIMD is chosen at run time and changes no bit: nothing is fused, every operation rounds alike.
//!
//! **What was tried**, what it gained and what is left to gain is listed in `docs/decisions.md`.

mod alpha_mask;
mod arc;
mod boxes;
mod cover;
mod follow;
mod gaps;
mod near;
mod occluders;
mod seeds;
mod solve;
mod walk;

use super::start::{RayStart, ray_starts};
use super::{Engine, Hiders, IntervalTable, Intervals, Session, Work};
use crate::atlas::SurfacePoint;
use crate::scene::Components;
use crate::sun::SunPath;
use crate::trace::Tracer;
use crate::trace::bvh16::Bvh16;
use arc::ArcFrame;
use boxes::BoxFrames;
use cover::{GapCloser, Query};
use fearless_simd::{Level, Simd, dispatch};
use glam::{DMat3, DVec3};
pub use occluders::{Alone, OccluderFinder, OccluderSession};
use walk::Walk;

/// Growth of every box, tracer space (whose half size is 512 to 1024): four times the steps of an `f32` that turning a
/// box into another frame can amount to.
const BOX_PADDING: f32 = 1.0 / 256.0;

/// Lit intervals in closed form.
pub struct ExactEngine<'a> {
    tracer: &'a Tracer,
    bvh: Bvh16,
    arcs: Vec<Arc>,
    lane_count: usize,
    level: Level,
    /// For each triangle of the tracer, its part, if what hides the sun is noted.
    parts: Option<Vec<u32>>,
}

struct Arc {
    frame: ArcFrame,
    frames: BoxFrames,
}

impl<'a> ExactEngine<'a> {
    /// Prepares the arcs of a path, and of the lanes beside it.
    pub fn new(tracer: &'a Tracer, lanes: &[SunPath]) -> Self {
        let frames = ArcFrame::of_path(lanes);
        let axes = frames.first().map_or(DMat3::IDENTITY, |frame| frame.arc_from_bake);
        // Rays start a run-up behind their point, which may be far where a file's coordinates are coarse.
        let padding = BOX_PADDING + tracer.run_up() as f32;
        let bvh = Bvh16::new(tracer, axes, padding);
        let arc = |frame| Arc { frames: BoxFrames::new(&frame, axes, padding), frame };
        let arcs = frames.into_iter().map(arc).collect();
        Self { tracer, bvh, arcs, lane_count: lanes.len(), level: Level::new(), parts: None }
    }

    /// The same engine, whose sessions note which parts hide the sun. Those with alpha masks are left out.
    pub fn noting(self, parts: &Components) -> Self {
        Self { parts: Some(parts_of(self.tracer, parts)), ..self }
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
        let closer = |arc| GapCloser::new(self.tracer, arc);
        let closers = self.arcs.iter().map(|arc| std::array::from_fn(|_| closer(&arc.frame))).collect();
        Box::new(ExactSession { engine: self, closers, scratch: PointScratch::default() })
    }
}

struct ExactSession<'a> {
    engine: &'a ExactEngine<'a>,
    /// For each arc, one for each kind of start: seeds of the front are not those of the back.
    closers: Vec<[GapCloser<'a>; RayStart::KINDS]>,
    scratch: PointScratch,
}

/// Memory that is reused by every point.
#[derive(Default)]
struct PointScratch {
    walk: Walk,
    query: Query,
    /// For each lane, when the point sees the sun.
    lit: Vec<Vec<[f64; 2]>>,
    /// The parts that hide it.
    parts: Vec<u32>,
    /// Those of the points before.
    hiders: Hiders,
}

impl Session for ExactSession<'_> {
    fn lit(&mut self, points: &[SurfacePoint], answers: &mut IntervalTable) {
        let level = self.engine.level;
        dispatch!(level, simd => self.lit_with(simd, points, answers));
    }

    fn work(&self) -> Work {
        self.scratch.walk.work
    }

    fn take_hiders(&mut self) -> Hiders {
        std::mem::take(&mut self.scratch.hiders)
    }
}

impl ExactSession<'_> {
    fn lit_with<S: Simd>(&mut self, simd: S, points: &[SurfacePoint], answers: &mut IntervalTable) {
        self.scratch.lit.resize_with(self.engine.lane_count, Vec::new);
        for point in points {
            let starts = ray_starts(point);
            for arc in 0..self.engine.arcs.len() {
                starts.iter().for_each(|start| self.solve_start(simd, arc, start, point));
            }
            for times in &mut self.scratch.lit {
                answers.push(&Intervals::from_unsorted(std::mem::take(times)));
            }
            if self.engine.parts.is_some() {
                self.scratch.hiders.push(&mut self.scratch.parts);
            }
        }
    }

    /// Finds the lit spans of one arc that rays from one start of a point reach.
    fn solve_start<S: Simd>(&mut self, simd: S, arc: usize, start: &RayStart, point: &SurfacePoint) {
        let Self { engine, closers, scratch: PointScratch { walk, query, lit, parts, .. } } = self;
        let Arc { frame, frames } = &engine.arcs[arc];
        if !engine.start_query(frame, point, start, query) {
            return;
        }
        if !engine.bvh.nodes.is_empty() {
            let closer = &mut closers[arc][start.kind()];
            walk.work.triangles += closer.close_with_seeds(simd, query);
            if !query.is_done() {
                walk.close(simd, &engine.bvh, frames, closer, query);
            }
            if let Some(of_triangle) = &engine.parts {
                parts.extend(solid(engine.tracer, &closer.useful).map(|id| of_triangle[id as usize]));
            }
        }
        for (gaps, times) in query.gaps.iter().zip(lit) {
            times.extend(gaps.as_slice().iter().map(|span| span.map(|u| frame.t_of(u))));
        }
    }
}

/// For each triangle of a tracer, its part.
fn parts_of(tracer: &Tracer, parts: &Components) -> Vec<u32> {
    tracer.flat().iter().map(|&flat| parts.of_triangle[flat as usize]).collect()
}

/// Triangles without alpha masks.
fn solid(tracer: &Tracer, triangles: &[u32]) -> impl Iterator<Item = u32> {
    triangles.iter().copied().filter(|&id| !tracer.has_alpha_mask(id))
}

impl ExactEngine<'_> {
    /// Starts a query of an arc at one start of a point. False if the sun is never in front of it.
    fn start_query(&self, frame: &ArcFrame, point: &SurfacePoint, start: &RayStart, query: &mut Query) -> bool {
        let (up, facing) = (frame.arc_from_bake * DVec3::Y, frame.arc_from_bake * start.normal);
        query.gaps.resize_with(frame.lanes.len(), Default::default);
        for (lane, gaps) in query.gaps.iter_mut().enumerate() {
            let above = frame.half_space(up, 0.0, lane);
            gaps.set_intersection(above.as_slice(), frame.half_space(facing, 0.0, lane).as_slice());
            if let Some(also) = start.also {
                gaps.intersect(frame.half_space(frame.arc_from_bake * also, 0.0, lane).as_slice());
            }
        }
        if query.is_done() {
            return false;
        }
        query.origin = frame.arc_from_bake * (start.origin_m(self.tracer, point) * self.tracer.tracer_from_bake());
        query.side = facing;
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Geometry;
    use crate::testing::{SceneBuilder, block, floor, icosphere};
    use glam::{Vec2, Vec3};

    /// Answers for a floor under a stone and a post, along three lanes of two arcs.
    fn answers(level: impl Fn() -> Level) -> IntervalTable {
        let stone: Vec<[Vec3; 3]> = icosphere(3).iter().map(|t| t.map(|v| v + Vec3::Y * 0.6)).collect();
        let post = block(Vec3::new(1.2, 0.0, -0.1), Vec3::new(1.3, 3.0, 0.0));
        let scene =
            SceneBuilder::new().soup(&floor(Vec2::splat(-4.0), Vec2::splat(4.0), 0.0)).soup(&stone).soup(&post).build();
        let geometry = Geometry::new(&scene);
        let tracer = Tracer::new(&scene, &geometry);
        let keys = r#"{ "keys": [
            { "direction": [1, 0.1, 0.2] }, { "direction": [0, 1, 0.5] }, { "direction": [-1, 0.1, 0] }
        ] }"#;
        let path = crate::sun::parse_keyed(keys, 0.0).expect("a path");
        let lanes = [-0.01, 0.0, 0.01].map(|offset_rad| path.lane(offset_rad));
        let engine = ExactEngine { level: level(), ..ExactEngine::new(&tracer, &lanes) };
        let point = |i: usize| SurfacePoint {
            position_m: geometry.point(0, [0.02 * (i % 20) as f64, 0.02 * (i / 20) as f64]),
            normal: geometry.normal(0),
            is_double_sided: true,
            triangle: 0,
            smooth: None,
        };
        let points: Vec<SurfacePoint> = (0..400).map(point).collect();
        let mut answers = IntervalTable::default();
        engine.session().lit(&points, &mut answers);
        answers
    }

    /// B17.
    #[test]
    fn wider_simd_changes_no_bit() {
        let widest = answers(Level::new);
        assert!(widest.iter().any(|lit| lit.as_slice().len() > 1), "nothing casts a shadow");
        assert_eq!(answers(Level::baseline), widest);
    }
}
