//! The true answer at points of surfaces: how much of the sun's disc each sees at which time, and how much of the sky.
//!
//! Points are drawn evenly by area over everything that is baked: one in each of equal shares of the area. The sun is
//! found by the exact engine along [`LANES`] lanes at the point itself, not at a texel; the sky by [`RAYS`] rays with a
//! seed that no bake uses. Points inside solids are left out.

use super::budget::Budget;
use super::metric;
use super::workload::Workload;
use crate::ambient::{AmbientPoint, Estimates};
use crate::atlas::SurfacePoint;
use crate::maps::Lane;
use crate::progress::Progress;
use crate::sun::SunPath;
use crate::texels::uniform;
use crate::visibility::{ExactEngine, Intervals};
use glam::DVec3;
use rayon::prelude::*;

/// Lanes across the disc. Near an edge they differ from the disc's true share by a thousandth on average.
pub(super) const LANES: usize = 17;
/// Rays of sky per point of the exact answer.
pub(super) const RAYS: u32 = 4096;
/// Seed of the rays, which no bake uses.
pub(super) const SEED: u32 = 0x7a57;

/// A point of a surface, seen from one of its sides.
#[derive(Debug, Clone, Copy)]
pub(super) struct SurfaceSample {
    pub surface: SurfacePoint,
    /// Weights of its triangle's second and third corner.
    pub barycentric: [f64; 2],
    /// Whether the surface is viewed from the back.
    pub is_back: bool,
    /// Where its moments start, see [`metric::moments`].
    pub start: f64,
    /// Unit shading normal, on the surface's front.
    pub shading_normal: DVec3,
}

impl SurfaceSample {
    /// Unit normal of the plane, towards the viewed side.
    pub fn geometric_normal(&self) -> DVec3 {
        if self.is_back { -self.surface.normal } else { self.surface.normal }
    }
}

/// Points with the true answers there.
pub(super) struct GroundTruth {
    pub points: Vec<SurfaceSample>,
    /// Of each point, the visible share of the disc at each moment.
    pub sun: Vec<Vec<f32>>,
    /// Of each point, the ambient visibility of its side.
    pub ambient: Vec<f32>,
    /// How many points were left out because they lie inside solids.
    pub buried: usize,
}

impl GroundTruth {
    /// Draws this many points and finds the answers; none if it was stopped.
    pub fn find(workload: &Workload, count: usize, budget: &Budget) -> Option<Self> {
        budget.task("the exact answers");
        let mut points = draw(workload, count);
        let (mut ambient, buried) = sky(workload, &points, budget)?;
        let mut keep = buried.iter().map(|is_buried| !is_buried);
        points.retain(|_| keep.next().unwrap_or(true));
        let mut keep = buried.iter().map(|is_buried| !is_buried);
        ambient.retain(|_| keep.next().unwrap_or(true));
        let sun = sun(workload, &points, budget)?;
        Some(Self { points, sun, ambient, buried: buried.iter().filter(|is_buried| **is_buried).count() })
    }
}

/// Points drawn evenly by area, in the order of their triangles.
fn draw(workload: &Workload, count: usize) -> Vec<SurfaceSample> {
    let (scene, geometry) = (workload.scene(), &workload.geometry);
    let area = |index: usize| {
        let [a, b, c] = geometry.triangles[index].map(|v| v.as_dvec3());
        if geometry.receives(scene, index) { (b - a).cross(c - a).length() } else { 0.0 }
    };
    let mut sum = 0.0;
    let below: Vec<f64> = (0..geometry.triangles.len())
        .map(|index| {
            sum += area(index);
            sum
        })
        .collect();
    let mut state = 0x0c05_7000;
    let mut place = |k: usize| {
        let target = (k as f64 + uniform(&mut state)) / count as f64 * sum;
        let triangle = below.partition_point(|&area| area <= target).min(below.len() - 1) as u32;
        // A point of the unit square, folded over its diagonal into a triangle.
        let [u, v] = [uniform(&mut state), uniform(&mut state)];
        let barycentric = if u + v > 1.0 { [1.0 - u, 1.0 - v] } else { [u, v] };
        let is_back = uniform(&mut state) < 0.5;
        place_at(workload, triangle, barycentric, is_back, uniform(&mut state))
    };
    if sum > 0.0 { (0..count).map(&mut place).collect() } else { Vec::new() }
}

fn place_at(workload: &Workload, triangle: u32, barycentric: [f64; 2], is_back: bool, start: f64) -> SurfaceSample {
    let geometry = &workload.geometry;
    let surface = SurfacePoint::of_triangle(workload.scene(), geometry, triangle as usize, barycentric);
    let shading_normal = workload.shading_normal(triangle, barycentric);
    SurfaceSample { surface, barycentric, is_back: is_back && surface.is_double_sided, start, shading_normal }
}

/// Ambient visibility of each point, and whether it lies inside a solid.
fn sky(workload: &Workload, points: &[SurfaceSample], budget: &Budget) -> Option<(Vec<f32>, Vec<bool>)> {
    let point = |place: &SurfaceSample| AmbientPoint { surface: place.surface, shading_normal: place.shading_normal };
    let asked: Vec<AmbientPoint> = points.iter().map(point).collect();
    let engine = workload.ambient_engine(RAYS, SEED);
    let (runs, _) = workload.solve_ambient_at(&engine, &asked, budget)?;
    let buried = runs.iter().flat_map(|run| run.buried.iter().copied()).collect();
    let sides: Vec<[f32; 2]> = runs.iter().flat_map(sides).collect();
    Some((
        points.iter().zip(sides).map(|(place, [front, back])| if place.is_back { back } else { front }).collect(),
        buried,
    ))
}

/// Ambient visibility of the fronts and backs of a run; single-sided points have their front's twice.
pub(super) fn sides(run: &Estimates) -> Vec<[f32; 2]> {
    let mut sides: Vec<[f32; 2]> = run.front.iter().map(|front| [front.visibility; 2]).collect();
    run.back.iter().for_each(|(k, back)| sides[*k as usize][1] = back.visibility);
    sides
}

/// Visible share of the disc for each point's side, at its moments.
fn sun(workload: &Workload, points: &[SurfaceSample], budget: &Budget) -> Option<Vec<Vec<f32>>> {
    let (lanes, paths) = workload.lanes(LANES);
    let engine = ExactEngine::new(&workload.tracer, &paths);
    let surfaces: Vec<SurfacePoint> = points.iter().map(|place| place.surface).collect();
    let (answers, _) = workload.solve_visibility(&engine, &surfaces, budget)?;
    let of_place =
        |(place, answers): (&SurfaceSample, &[Intervals])| of_side(place, answers, &lanes, &paths, workload.path());
    Some(workload.on_threads(|| points.par_iter().zip(answers.par_chunks(lanes.len())).map(of_place).collect()))
}

/// For a double-sided surface the list tells when either side is lit; a side is lit only while the sun is in front of
/// it.
fn of_side(
    place: &SurfaceSample,
    answers: &[Intervals],
    lanes: &[Lane],
    paths: &[SunPath],
    path: &SunPath,
) -> Vec<f32> {
    if !place.surface.is_double_sided {
        return metric::disc_visibility(answers, lanes, path, place.start);
    }
    let in_front =
        answers.iter().zip(paths).map(|(lit, path)| lit.intersection(&path.above_plane(place.geometric_normal())));
    metric::disc_visibility(&in_front.collect::<Vec<_>>(), lanes, path, place.start)
}
