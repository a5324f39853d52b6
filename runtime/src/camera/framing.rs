//! A camera that shows a scene well: the file's first one or, if it has none, one that looks from above and aside.
//!
//! Points are sampled on the surfaces. Triangles are weighted by the square root of their area, up to a limit, so that
//! one huge ground plane does not outweigh the town on it; the outermost few in a hundred are left out. Candidates look
//! at the middle of the points from several bearings and elevations, each from as far away as it takes to have the
//! points in the picture. The candidate that sees most points wins, with a preference for the south-east and an
//! elevation of 25 degrees, so that the sun is behind the camera for most of the day. A camera inside a house or behind
//! a hill sees next to nothing and loses.

use super::Camera;
use crate::stage::Stage;
use glam::DVec3;
use rayon::prelude::*;

/// Vertical field of view, in degrees.
pub(crate) const FOV_Y_DEG: f64 = 38.0;
/// How many points are sampled.
const POINTS: usize = 1500;
/// Largest weight of a triangle, as a multiple of the median weight.
const MOST_WEIGHT: f64 = 4.0;
/// Share of points left out at either end of each axis.
const OUTLIERS: f64 = 0.05;
/// Share of points that must be in the picture.
const INSIDE: f64 = 0.95;
/// How much farther away a camera stands than those points need.
const MARGIN: f64 = 1.15;
/// Elevations of candidates in degrees, each with its weight.
const ELEVATIONS_DEG: [(f64, f64); 4] = [(15.0, 0.86), (25.0, 1.0), (38.0, 0.93), (60.0, 0.7)];
/// How many bearings are tried.
const BEARINGS: u32 = 24;

impl Camera {
    /// The camera that shows a stage when none is asked for. `aspect` is the picture's width over its height.
    pub fn default_of(stage: &Stage, aspect: f64) -> Self {
        match stage.scene.cameras.first() {
            Some(camera) => Self::from_scene(camera),
            None => framed(stage, aspect),
        }
    }
}

fn framed(stage: &Stage, aspect: f64) -> Camera {
    let points = detail(stage);
    let middle = middle(&points);
    let candidates: Vec<(f64, f64)> = (0..BEARINGS)
        .flat_map(|i| ELEVATIONS_DEG.map(|(elevation, _)| (f64::from(i) * 360.0 / f64::from(BEARINGS), elevation)))
        .collect();
    // The tracer is built before the parallel loop uses it.
    stage.eye_tracer();
    let scored = candidates.par_iter().filter_map(|&(bearing_deg, elevation_deg)| {
        let camera = standing_back(&points, middle, towards(bearing_deg, elevation_deg), aspect)?;
        Some((preference(bearing_deg, elevation_deg) * seen(stage, &camera, &points) as f64, camera))
    });
    let best = scored.collect::<Vec<_>>().into_iter().reduce(|a, b| if b.0 > a.0 { b } else { a });
    best.map_or_else(|| camera_of_empty(stage), |(_, camera)| camera)
}

/// A camera for a scene in which nothing is drawn.
fn camera_of_empty(stage: &Stage) -> Camera {
    let reach = stage.scene.half_extent_m.max_element().max(1.0);
    Camera {
        eye_m: DVec3::new(0.0, 0.5, 2.0) * reach,
        forward: DVec3::NEG_Z,
        right: DVec3::X,
        up: DVec3::Y,
        fov_y_rad: FOV_Y_DEG.to_radians(),
    }
}

/// Unit vector from the scene to a camera. Bearings run from north over east.
pub(crate) fn towards(bearing_deg: f64, elevation_deg: f64) -> DVec3 {
    let (sin_b, cos_b) = bearing_deg.to_radians().sin_cos();
    let (sin_e, cos_e) = elevation_deg.to_radians().sin_cos();
    DVec3::new(sin_b * cos_e, sin_e, -cos_b * cos_e)
}

fn preference(bearing_deg: f64, elevation_deg: f64) -> f64 {
    let off_south_east = (bearing_deg - 150.0 + 180.0).rem_euclid(360.0) - 180.0;
    let height = ELEVATIONS_DEG.iter().find(|(deg, _)| *deg == elevation_deg).map_or(1.0, |(_, weight)| *weight);
    height * (1.0 - 0.25 * (off_south_east.abs() / 180.0))
}

/// Points on drawn surfaces, more of them where triangles are small.
pub(crate) fn detail(stage: &Stage) -> Vec<DVec3> {
    let geometry = &stage.geometry;
    let edge_m = |triangle: usize| {
        let [a, b, c] = geometry.triangles[triangle].map(|v| v.as_dvec3());
        if stage.sides(triangle).is_none() { 0.0 } else { (b - a).cross(c - a).length().sqrt() }
    };
    let edges_m: Vec<f64> = (0..geometry.triangles.len()).map(edge_m).collect();
    let mut sorted: Vec<f64> = edges_m.iter().copied().filter(|&edge| edge > 0.0).collect();
    sorted.sort_by(f64::total_cmp);
    let Some(median) = sorted.get(sorted.len() / 2) else { return Vec::new() };
    let mut total = 0.0;
    let mut add = |edge: &f64| {
        total += edge.min(MOST_WEIGHT * median);
        total
    };
    let reached: Vec<f64> = edges_m.iter().map(&mut add).collect();
    let point = |i: usize| {
        let share = (i as f64 + 0.5) / POINTS as f64 * total;
        let triangle = reached.partition_point(|&r| r < share).min(reached.len() - 1);
        // A low-discrepancy pair (Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018).
        let [u, v] = [0.754_877_666, 0.569_840_291].map(|step: f64| (step * (i as f64 + 1.0)).fract());
        let folded = if u + v > 1.0 { [1.0 - u, 1.0 - v] } else { [u, v] };
        geometry.point(triangle, folded)
    };
    (0..POINTS).map(point).collect()
}

/// The middle of the points' bounds without outliers.
pub(crate) fn middle(points: &[DVec3]) -> DVec3 {
    let along = |axis: DVec3| middle_along(points, axis);
    DVec3::new(along(DVec3::X), along(DVec3::Y), along(DVec3::Z))
}

/// The middle of the points along an axis, without outliers.
fn middle_along(points: &[DVec3], axis: DVec3) -> f64 {
    let mut all: Vec<f64> = points.iter().map(|p| p.dot(axis)).collect();
    all.sort_by(f64::total_cmp);
    let skip = (all.len() as f64 * OUTLIERS) as usize;
    match (all.get(skip), all.get(all.len().saturating_sub(1 + skip))) {
        (Some(low), Some(high)) => 0.5 * (low + high),
        _ => 0.0,
    }
}

/// The camera in a direction from the middle, as near as it can be with most points in the picture.
pub(crate) fn standing_back(points: &[DVec3], middle: DVec3, towards: DVec3, aspect: f64) -> Option<Camera> {
    let camera = Camera::look_at(middle + towards, middle, FOV_Y_DEG.to_radians())?;
    // The middle of the box is not the middle of the picture, since perspective moves high points up.
    let shift = |axis: DVec3| axis * (middle_along(points, axis) - middle.dot(axis));
    let middle = middle + shift(camera.right) + shift(camera.up);
    let half_up = (0.5 * camera.fov_y_rad).tan();
    let needed = |p: &DVec3| {
        let from_middle = *p - middle;
        let across = (from_middle.dot(camera.right).abs() / aspect).max(from_middle.dot(camera.up).abs());
        across / half_up - from_middle.dot(camera.forward)
    };
    let mut distances: Vec<f64> = points.iter().map(needed).collect();
    distances.sort_by(f64::total_cmp);
    let distance = *distances.get((distances.len() as f64 * INSIDE) as usize)?;
    let distance = if distance > 0.0 { distance } else { return None };
    Some(Camera { eye_m: middle + towards * (MARGIN * distance), ..camera })
}

/// How many of the points can be seen.
fn seen(stage: &Stage, camera: &Camera, points: &[DVec3]) -> usize {
    let is_seen = |p: &&DVec3| {
        let ray = **p - camera.eye_m;
        ray.dot(camera.forward) > 0.0
            && stage.primary_hit(camera.eye_m, ray).is_some_and(|hit| hit.distance_m > ray.length() * 0.999)
    };
    points.iter().filter(is_seen).count()
}
