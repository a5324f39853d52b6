//! Which parts of a scene hide the sun from a point, and when each of them would hide it alone.
//!
//! Theory: the closed form gives the spans in which one triangle occludes; the union over the triangles of one part
//! ([`Components`]) is that part's shade, whether or not something else stands in the same light. Shade by one part
//! moves smoothly from point to point, which the merged shade of many does not.
//!
//! Practice: the parts that matter at a point are those whose triangles closed gaps in an ordinary query: noted by a
//! bake's own ([`ExactEngine::noting`]), or asked for ([`OccluderSession::find`]). A part is asked alone
//! ([`OccluderSession::alone`]) by a query that only its own triangles close: small parts one triangle after the other,
//! large ones through a hierarchy of their own. What a surface's own plane and the horizon hide is no part's: it is
//! what [`Alone::facing`] leaves out.

use super::arc::ArcFrame;
use super::cover::{GapCloser, Query};
use super::solve::{SIMD_WIDTH, TriangleBatch};
use super::walk::Walk;
use super::{BOX_PADDING, ExactEngine, parts_of, solid};
use crate::atlas::SurfacePoint;
use crate::intervals::Intervals;
use crate::scene::Components;
use crate::trace::bvh16::Bvh16;
use crate::visibility::start::{RayStart, ray_starts};
use fearless_simd::{Simd, dispatch};
use glam::DMat3;

/// Triangles from which on a part has a hierarchy of its own.
const LARGE: usize = 48;

/// Finds what parts of a scene hide, along the first lane of an engine.
pub struct OccluderFinder<'a> {
    engine: &'a ExactEngine<'a>,
    /// For each triangle of the tracer, its part.
    part: Vec<u32>,
    /// The triangles of all parts, part by part, and where each begins.
    triangles: Vec<u32>,
    first: Vec<u32>,
    /// Hierarchies of large parts, and which of them a part has.
    hierarchies: Vec<Bvh16>,
    hierarchy: Vec<Option<u32>>,
}

impl<'a> OccluderFinder<'a> {
    /// Sorts an engine's triangles by their parts.
    pub fn new(engine: &'a ExactEngine<'a>, parts: &Components) -> Self {
        let tracer = engine.tracer;
        let part = parts_of(tracer, parts);
        let mut triangles: Vec<u32> = (0..part.len() as u32).collect();
        triangles.sort_by_key(|&id| part[id as usize]);
        let first: Vec<u32> = (0..=parts.count as u32)
            .map(|number| triangles.partition_point(|&id| part[id as usize] < number) as u32)
            .collect();
        let axes = engine.arcs.first().map_or(DMat3::IDENTITY, |arc| arc.frame.arc_from_bake);
        let padding = BOX_PADDING + tracer.run_up() as f32;
        let mut hierarchies = Vec::new();
        let hierarchy = first
            .windows(2)
            .map(|range| {
                let own = &triangles[range[0] as usize..range[1] as usize];
                (own.len() >= LARGE).then(|| {
                    hierarchies.push(Bvh16::over(tracer, own, axes, padding));
                    hierarchies.len() as u32 - 1
                })
            })
            .collect();
        Self { engine, part, triangles, first, hierarchies, hierarchy }
    }

    /// Starts a run of points.
    pub fn session(&self) -> OccluderSession<'_> {
        let engine = self.engine;
        let closer_of = |arc: &'a super::Arc| GapCloser::new(engine.tracer, &arc.frame);
        OccluderSession {
            finder: self,
            closers: engine.arcs.iter().map(|arc| std::array::from_fn(|_| closer_of(arc))).collect(),
            alone: engine.arcs.iter().map(closer_of).collect(),
            walk: Walk::default(),
            query: Query::default(),
        }
    }

    fn triangles_of(&self, part: u32) -> &[u32] {
        let [start, end] = [part, part + 1].map(|p| self.first[p as usize] as usize);
        &self.triangles[start..end]
    }
}

/// A run of queries.
pub struct OccluderSession<'a> {
    finder: &'a OccluderFinder<'a>,
    /// For each arc: one for each kind of start, and one for parts alone, which are no seeds.
    closers: Vec<[GapCloser<'a>; RayStart::KINDS]>,
    alone: Vec<GapCloser<'a>>,
    walk: Walk,
    query: Query,
}

/// What some parts would hide from a point, each if it were alone.
pub struct Alone {
    /// When the sun is above the horizon and in front of the point.
    pub facing: Intervals,
    /// For each part, when the point would see the sun.
    pub lit: Vec<Intervals>,
}

impl OccluderSession<'_> {
    /// When a point sees the sun, and the parts that hide it at other times: ascending, each once. There may be more
    /// than are needed.
    pub fn find(&mut self, point: &SurfacePoint) -> (Intervals, Vec<u32>) {
        let Self { finder, closers, walk, query, .. } = self;
        let engine = finder.engine;
        let (mut lit, mut parts) = (Vec::new(), Vec::new());
        for start in ray_starts(point) {
            for (index, arc) in engine.arcs.iter().enumerate() {
                if engine.start_query(&arc.frame, point, &start, query) {
                    let closer = &mut closers[index][start.kind()];
                    dispatch!(engine.level, simd => finder.close_all(simd, index, closer, walk, query));
                    parts.extend(solid(engine.tracer, &closer.useful).map(|id| finder.part[id as usize]));
                    lit.extend(open_times(query, &arc.frame));
                }
            }
        }
        parts.sort_unstable();
        parts.dedup();
        (Intervals::from_unsorted(lit), parts)
    }

    /// What some parts would hide from a point, each if it were alone.
    pub fn alone(&mut self, point: &SurfacePoint, parts: &[u32]) -> Alone {
        dispatch!(self.finder.engine.level, simd => self.alone_with(simd, point, parts))
    }

    fn alone_with<S: Simd>(&mut self, simd: S, point: &SurfacePoint, parts: &[u32]) -> Alone {
        let Self { finder, alone, walk, query, .. } = self;
        let engine = finder.engine;
        let mut facing = Vec::new();
        let mut lit = vec![Vec::new(); parts.len()];
        for start in ray_starts(point) {
            for (index, arc) in engine.arcs.iter().enumerate() {
                if !engine.start_query(&arc.frame, point, &start, query) {
                    continue;
                }
                facing.extend(open_times(query, &arc.frame));
                let open = query.gaps[0].clone();
                for (&part, lit) in parts.iter().zip(&mut lit) {
                    query.gaps[0].clone_from(&open);
                    finder.close_part(simd, index, part, &mut alone[index], walk, query);
                    lit.extend(open_times(query, &arc.frame));
                }
            }
        }
        let lit = lit.into_iter().map(Intervals::from_unsorted).collect();
        Alone { facing: Intervals::from_unsorted(facing), lit }
    }
}

/// What is still open of a query's first lane, in path time.
fn open_times<'q>(query: &'q Query, frame: &'q ArcFrame) -> impl Iterator<Item = [f64; 2]> + 'q {
    query.gaps[0].as_slice().iter().map(|span| span.map(|u| frame.t_of(u)))
}

impl OccluderFinder<'_> {
    fn close_all<S: Simd>(&self, simd: S, arc: usize, closer: &mut GapCloser, walk: &mut Walk, query: &mut Query) {
        closer.close_with_seeds(simd, query);
        if !query.is_done() && !self.engine.bvh.nodes.is_empty() {
            walk.close(simd, &self.engine.bvh, &self.engine.arcs[arc].frames, closer, query);
        }
    }

    fn close_part<S: Simd>(
        &self,
        simd: S,
        arc: usize,
        part: u32,
        closer: &mut GapCloser,
        walk: &mut Walk,
        query: &mut Query,
    ) {
        if let Some(hierarchy) = self.hierarchy[part as usize] {
            return walk.close(
                simd,
                &self.hierarchies[hierarchy as usize],
                &self.engine.arcs[arc].frames,
                closer,
                query,
            );
        }
        let corners = closer.tracer.corners();
        for some in self.triangles_of(part).chunks(SIMD_WIDTH) {
            let mut batch = TriangleBatch::default();
            some.iter().for_each(|&id| batch.push_unrotated(id, &corners[id as usize]));
            closer.rotate_and_close(simd, &mut batch, query);
        }
    }
}
