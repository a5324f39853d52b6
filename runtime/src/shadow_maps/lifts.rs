//! How far smooth shapes rise above their facets, where shadow maps are compared with them.
//!
//! A bake and truth trace from each point how far it may rise ([`sunbake::trace::Tracer::free_share`]). A pixel cannot
//! trace. So each facet is asked at a few points, and all of it rises by the least share of them: nothing then rises
//! through a wall or through what lies on it, but for things that lie between these points.

use crate::stage::Stage;
use glam::Vec3;
use rayon::prelude::*;

/// Weights of the second and third corner of the points that are asked: the middle, and three near edges and corners.
const ASKED: [[f64; 2]; 7] =
    [[1.0 / 3.0; 2], [0.45, 0.1], [0.45, 0.45], [0.1, 0.45], [0.15, 0.15], [0.7, 0.15], [0.15, 0.7]];

/// For each of some smooth triangles, the vectors of its edges ([`sunbake::scene::Geometry::edge_lifts_m`]), times how
/// much of them is free.
pub fn free_edge_lifts_m(stage: &Stage, triangles: &[usize]) -> Vec<[Vec3; 3]> {
    let tracer = stage.tracer();
    let of_triangle = |&triangle: &usize| {
        let Some(lifts_m) = stage.geometry.edge_lifts_m(triangle) else { return [Vec3::ZERO; 3] };
        let face = stage.geometry.normal(triangle);
        let share = |barycentric: &[f64; 2]| {
            let smooth = stage.geometry.smooth_point(triangle, *barycentric)?;
            let point_m = stage.geometry.point(triangle, *barycentric);
            let sides = smooth.lift_m.into_iter().zip([face, -face]).filter(|(lift_m, _)| lift_m.length() > 0.0);
            sides.map(|(lift_m, side)| tracer.free_share(point_m, side, triangle as u32, lift_m)).reduce(f64::min)
        };
        let share = ASKED.iter().filter_map(share).fold(1.0, f64::min);
        lifts_m.map(|lift_m| (lift_m * share).as_vec3())
    };
    triangles.par_iter().with_min_len(64).map(of_triangle).collect()
}
