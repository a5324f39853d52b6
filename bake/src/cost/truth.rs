//! What is true at points of surfaces: when each sees how much of the sun's disc, and how much of the sky.
//!
//! Points are drawn evenly by area over everything that is baked: one in each of as many equal shares of the area as there
//! are points, so that none of it is passed over. The sun is found by the exact engine along [`LANES`] lanes at the point
//! itself, not at a texel; the sky by [`RAYS`] rays with a seed that no bake uses. Points inside solids are left out.

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

/// Lanes across the disc. What they see of an edge differs from the disc's share by a thousandth on average.
pub(super) const LANES: usize = 17;
/// Rays of sky.
pub(super) const RAYS: u32 = 4096;
/// Seed of rays that no bake has.
pub(super) const SEED: u32 = 0x7a57;

/// A point of a surface, seen from one of its sides.
#[derive(Debug, Clone, Copy)]
pub(super) struct SurfaceSample {
    pub surface: SurfacePoint,
    /// Weights of its triangle's second and third corner.
    pub barycentric: [f64; 2],
    /// Whether it is seen from the back.
    pub is_back: bool,
    /// Where its moments start, see [`metric::moments`].
    pub start: f64,
    /// Unit normal that the surface is meant to have, on its front.
    pub shading_normal: DVec3,
}

impl SurfaceSample {
    /// Unit normal of the plane, towards who sees it.
    pub fn face(&self) -> DVec3 {
        if self.is_back { -self.surface.normal } else { self.surface.normal }
    }
}

/// Points, and what is true there.
pub(super) struct Truth {
    pub places: Vec<SurfaceSample>,
    /// Share of the disc at each moment.
    pub sun: Vec<Vec<f32>>,
    /// Openness of the side that is seen.
    pub open: Vec<f32>,
    /// How many points were drawn inside solids.
    pub buried: usize,
}

impl Truth {
    /// Draws so many points and finds out; none if it was stopped.
    pub fn find(workload: &Workload, count: usize, budget: &Budget) -> Option<Self> {
        budget.task("what is true");
        let mut places = draw(workload, count);
        let (mut open, buried) = sky(workload, &places, budget)?;
        let mut keep = buried.iter().map(|is_buried| !is_buried);
        places.retain(|_| keep.next().unwrap_or(true));
        let mut keep = buried.iter().map(|is_buried| !is_buried);
        open.retain(|_| keep.next().unwrap_or(true));
        let sun = sun(workload, &places, budget)?;
        Some(Self { places, sun, open, buried: buried.iter().filter(|is_buried| **is_buried).count() })
    }
}

/// Points drawn evenly by area, in the order of their triangles.
fn draw(workload: &Workload, count: usize) -> Vec<SurfaceSample> {
    let (scene, geometry) = (workload.scene(), &workload.geometry);
    let area = |index: usize| {
        let [a, b, c] = geometry.triangles[index].map(|v| v.as_dvec3());
        if geometry.is_solid(scene, index) { (b - a).cross(c - a).length() } else { 0.0 }
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
        // Folded over the diagonal, a square is a triangle.
        let [u, v] = [uniform(&mut state), uniform(&mut state)];
        let barycentric = if u + v > 1.0 { [1.0 - u, 1.0 - v] } else { [u, v] };
        let is_back = uniform(&mut state) < 0.5;
        place_at(workload, triangle, barycentric, is_back, uniform(&mut state))
    };
    if sum > 0.0 { (0..count).map(&mut place).collect() } else { Vec::new() }
}

fn place_at(workload: &Workload, triangle: u32, barycentric: [f64; 2], is_back: bool, start: f64) -> SurfaceSample {
    let geometry = &workload.geometry;
    let instance = geometry.instance[triangle as usize] as usize;
    let is_double_sided = workload.scene().material(instance).is_double_sided;
    let surface = SurfacePoint {
        position_m: geometry.point(triangle as usize, barycentric),
        normal: geometry.normal(triangle as usize),
        is_double_sided,
        triangle,
    };
    let shading_normal = workload.shading_normal(triangle, barycentric);
    SurfaceSample { surface, barycentric, is_back: is_back && is_double_sided, start, shading_normal }
}

/// Openness of each point, and whether it lies inside a solid.
fn sky(workload: &Workload, places: &[SurfaceSample], budget: &Budget) -> Option<(Vec<f32>, Vec<bool>)> {
    let point = |place: &SurfaceSample| AmbientPoint { surface: place.surface, shading_normal: place.shading_normal };
    let points: Vec<AmbientPoint> = places.iter().map(point).collect();
    let engine = workload.sky(RAYS, SEED);
    let (runs, _) = workload.find_open(&engine, &points, budget)?;
    let buried = runs.iter().flat_map(|run| run.buried.iter().copied()).collect();
    let sides: Vec<[f32; 2]> = runs.iter().flat_map(sides).collect();
    Some((
        places.iter().zip(sides).map(|(place, [front, back])| if place.is_back { back } else { front }).collect(),
        buried,
    ))
}

/// Of a run, what fronts and backs see; single-sided points have their front's for both.
pub(super) fn sides(run: &Estimates) -> Vec<[f32; 2]> {
    let mut sides: Vec<[f32; 2]> = run.front.iter().map(|front| [front.open; 2]).collect();
    run.back.iter().for_each(|(k, back)| sides[*k as usize][1] = back.open);
    sides
}

/// Share of the disc that each point's side sees, at its moments.
fn sun(workload: &Workload, places: &[SurfaceSample], budget: &Budget) -> Option<Vec<Vec<f32>>> {
    let (lanes, paths) = workload.lanes(LANES);
    let engine = ExactEngine::new(&workload.tracer, &paths);
    let points: Vec<SurfacePoint> = places.iter().map(|place| place.surface).collect();
    let (answers, _) = workload.solve_visibility(&engine, &points, budget)?;
    let of_place =
        |(place, answers): (&SurfaceSample, &[Intervals])| of_side(place, answers, &lanes, &paths, workload.path());
    Some(workload.on_threads(|| places.par_iter().zip(answers.par_chunks(lanes.len())).map(of_place).collect()))
}

/// Of a two-sided surface a list says when either side is lit; a side is only while the sun stands before it.
fn of_side(
    place: &SurfaceSample,
    answers: &[Intervals],
    lanes: &[Lane],
    paths: &[SunPath],
    path: &SunPath,
) -> Vec<f32> {
    if !place.surface.is_double_sided {
        return metric::of_disc(answers, lanes, path, place.start);
    }
    let before = answers.iter().zip(paths).map(|(lit, path)| lit.intersection(&path.above_plane(place.face())));
    metric::of_disc(&before.collect::<Vec<_>>(), lanes, path, place.start)
}
