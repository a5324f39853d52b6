//! Ray-traced truth against trigonometry.

use glam::{DVec3, Vec2, Vec3};
use sunbake::maps::Bits;
use sunbake::testing::{SceneBuilder, floor};
use sunbake_runtime::technique::{Technique, Truth};
use sunbake_runtime::testing::{bake, standing_sun, view};
use sunbake_runtime::{Moment, Shot, Stage};

fn seen(shot: &Shot, truth: Truth) -> Vec<(DVec3, f32)> {
    let moment = Moment::new(shot.stage.path.as_ref(), 0.5);
    let seen = { truth }.visibility(shot, &moment).unwrap();
    let place = |stage: &Stage, hit: &sunbake::trace::Hit| {
        stage.geometry.point(hit.triangle as usize, hit.barycentric) + stage.scene.centre_m
    };
    let hits = shot.hits().iter().zip(seen.pixels);
    hits.filter_map(|(hit, v)| hit.map(|hit| (place(shot.stage, &hit), v))).collect()
}

#[test]
fn a_poles_shadow_is_as_long_as_the_suns_height_says() {
    for elevation_deg in [15.0, 30.0, 60.0_f64] {
        let (sin, cos) = elevation_deg.to_radians().sin_cos();
        let scene = SceneBuilder::new()
            .soup(&floor(Vec2::splat(-10.0), Vec2::splat(10.0), 0.0))
            .block(Vec3::new(-0.1, 0.0, -0.1), Vec3::new(0.1, 2.0, 0.1))
            .build();
        // The sun stands in the south, so the shadow points north.
        let stage = bake(scene, Some(standing_sun(DVec3::new(0.0, sin, cos), 0.0)), 4, Bits::Eight);
        let shot = Shot::new(&stage, view(&stage, DVec3::new(0.0, 20.0, -3.0), DVec3::new(0.0, 0.0, -3.0), [256, 256]));
        let tip = -0.1 - 2.0 * cos / sin;
        let pixel_m = 0.09;
        for (place, v) in seen(&shot, Truth::Hard) {
            if place.y > 1e-6 {
                continue;
            }
            let is_inside =
                |margin: f64| place.x.abs() < 0.1 - margin && (tip + margin..0.1 - margin).contains(&place.z);
            assert!(!is_inside(0.0) || v == 0.0 || !is_inside(pixel_m), "lit at {place}, {elevation_deg} degrees");
            assert!(is_inside(-1e-3) || v == 1.0, "dark at {place}, {elevation_deg} degrees");
        }
    }
}

#[test]
fn the_penumbra_of_a_straight_edge_is_a_segment_of_the_disc() {
    let radius_rad = 0.05_f64;
    let height = 2.0;
    let roof = floor(Vec2::new(-30.0, -30.0), Vec2::new(0.0, 30.0), height as f32);
    let scene = SceneBuilder::new().soup(&floor(Vec2::splat(-5.0), Vec2::splat(5.0), 0.0)).soup(&roof).build();
    let stage = bake(scene, Some(standing_sun(DVec3::Y, radius_rad)), 4, Bits::Eight);
    let shot = Shot::new(&stage, view(&stage, DVec3::new(0.0, 0.5, 0.0), DVec3::ZERO, [64, 64]));
    let mut penumbra = 0;
    for (place, v) in seen(&shot, Truth::Soft { rays: 1024 }) {
        // The edge's distance from the disc's centre, in radii. The disc is a circle on the plane at the edge's height.
        let u = (place.x / height / radius_rad.tan()).clamp(-1.0, 1.0);
        let free = 1.0 - (u.acos() - u * (1.0 - u * u).sqrt()) / std::f64::consts::PI;
        assert!((f64::from(v) - free).abs() < 0.006, "at {place}: {v} for {free}");
        penumbra += usize::from(u.abs() < 0.99);
    }
    assert!(penumbra > 100, "{penumbra} pixels in the penumbra");
}

#[test]
fn a_sun_half_below_the_horizon_is_half_a_sun() {
    let scene = SceneBuilder::new().block(Vec3::ZERO, Vec3::ONE).build();
    let stage = bake(scene, Some(standing_sun(DVec3::X, 0.01)), 4, Bits::Eight);
    let shot = Shot::new(&stage, view(&stage, DVec3::new(4.0, 0.5, 0.5), DVec3::new(1.0, 0.5, 0.5), [16, 16]));
    for (place, v) in seen(&shot, Truth::Soft { rays: 256 }).into_iter().filter(|(place, _)| place.x > 0.999) {
        assert!((v - 0.5).abs() < 0.02, "{v} at {place}");
    }
}
