//! Ambient light at points of a scene, and closed forms of it.

use crate::Traced;
use glam::DVec3;
use sunbake::ambient::{AmbientEngine, AmbientPoint, AmbientSettings, Estimate, solve_ambient};
use sunbake::atlas::SurfacePoint;

/// Settings with a number of rays, all outputs and no distance limit.
pub fn rays(rays: u32) -> AmbientSettings {
    AmbientSettings { rays, distance_m: None, error: None, wants_bent: true, wants_sky: true, seed: 0 }
}

/// Ambient light at each of these points, on their fronts, and the rays that it took.
pub fn ambient_at(traced: &Traced, points: &[AmbientPoint], settings: AmbientSettings) -> (Vec<Estimate>, u64) {
    let engine = AmbientEngine::new(&traced.scene, &traced.geometry, &traced.tracer, settings);
    let runs = solve_ambient(&engine, points.len(), |i, texel| texel.push(points[i]), |_| true).expect("not stopped");
    let rays = runs.iter().map(|run| run.rays).sum();
    (runs.into_iter().flat_map(|run| run.front).collect(), rays)
}

/// Ambient visibility at each of these points: 1 where nothing hides the hemisphere.
pub fn ambient_visibility(traced: &Traced, points: &[AmbientPoint], settings: AmbientSettings) -> Vec<f64> {
    let (estimates, _) = ambient_at(traced, points, settings);
    estimates.iter().map(|estimate| f64::from(estimate.visibility)).collect()
}

/// A point whose shading normal is its plane's.
pub fn flat(surface: SurfacePoint) -> AmbientPoint {
    AmbientPoint { shading_normal: surface.normal, surface }
}

/// Cosine-weighted share of the hemisphere about a normal that a polygon takes, as seen from `from`: Lambert's
/// formula, of polygons that lie wholly in front of the plane (Arvo, *Analytic Methods for Simulated Light Transport*,
/// 1995, chapter 3).
pub fn share_of_polygon(from: DVec3, normal: DVec3, polygon: &[DVec3]) -> f64 {
    let directions: Vec<DVec3> = polygon.iter().map(|corner| (*corner - from).normalize()).collect();
    let edge = |k: usize| {
        let (a, b) = (directions[k], directions[(k + 1) % directions.len()]);
        a.angle_between(b) * a.cross(b).normalize().dot(normal)
    };
    ((0..directions.len()).map(edge).sum::<f64>() / std::f64::consts::TAU).abs()
}

/// Root of the mean square.
pub fn rms(errors: impl Iterator<Item = f64> + Clone) -> f64 {
    let count = errors.clone().count() as f64;
    (errors.map(|error| error * error).sum::<f64>() / count).sqrt()
}
