//! How wide the edges of soft shadow maps are, in closed form. These tests need a GPU adapter, and fail without one.

use glam::{DVec3, Vec2, Vec3};
use sunbake::testing::{SceneBuilder, block, floor};
use sunbake_runtime::gpu::Gpu;
use sunbake_runtime::shadow_maps::{MapSettings, Variant};
use sunbake_runtime::technique::{LightKind, ShadowMaps, Technique, Truth};
use sunbake_runtime::testing::maps::surface_points;
use sunbake_runtime::testing::masks::{gpu, mask};
use sunbake_runtime::testing::{standing_sun, view};
use sunbake_runtime::{Shot, Stage};

/// Radius of a sun that makes wide edges.
const RADIUS_RAD: f64 = 0.05;

/// The edge of a roof `height_m` above the ground, under a sun overhead: lit east of x = 0.
fn under_roof(height_m: f32) -> Stage {
    let roof = block(Vec3::new(-4.0, height_m, -4.0), Vec3::new(0.0, height_m + 0.2, 4.0));
    let scene = SceneBuilder::new().soup(&floor(Vec2::splat(-4.0), Vec2::splat(4.0), 0.0)).soup(&roof);
    Stage::plain(scene.build(), Some(standing_sun(DVec3::Y, RADIUS_RAD)))
}

/// Distance in metres from where a quarter of the light arrives to where three quarters do, along x at z = 0.
fn edge_m(gpu: &Gpu, stage: &Stage, variant: Variant, size_texels: u32) -> f64 {
    // The view looks past the roof's edge, so that the roof does not cover its shadow.
    let shot = Shot::new(stage, view(stage, DVec3::new(0.9, 0.35, 0.0), DVec3::new(0.0, 0.0, 0.0), [32, 256]));
    let mut maps = ShadowMaps::new(gpu, stage, MapSettings { size_texels, ..MapSettings::new(variant) }).unwrap();
    let seen = maps.visibility(&shot, &stage.moment(0.5)).unwrap().pixels;
    let near = |low: f32, high: f32| {
        let within = |(i, p): &(usize, DVec3)| p.y.abs() < 1e-3 && p.z.abs() < 0.8 && (low..high).contains(&seen[*i]);
        let all: Vec<f64> = surface_points(&shot).into_iter().filter(within).map(|(_, p)| p.x).collect();
        assert!(!all.is_empty(), "{variant}: nothing between {low} and {high}");
        all.iter().sum::<f64>() / all.len() as f64
    };
    near(0.65, 0.85) - near(0.15, 0.35)
}

#[test]
fn penumbras_are_as_wide_as_the_sun_makes_them() {
    let gpu = gpu();
    for height_m in [0.5f32, 1.0, 2.0] {
        let stage = under_roof(height_m);
        let found = edge_m(&gpu, &stage, Variant::Pcss, 2048);
        // A straight edge leaves a quarter of a disc at 0.404 of its radius, and three quarters as far on the other
        // side. A shadow map holds the roof's upper side, a fifth of a metre higher.
        let expected = 0.808 * (f64::from(height_m) + 0.2) * RADIUS_RAD.tan();
        assert!((found / expected - 1.0).abs() < 0.15, "{height_m} m: {found} for {expected}");
    }
}

#[test]
fn the_blur_on_the_ground_is_some_texels_wide() {
    let gpu = gpu();
    let stage = under_roof(1.0);
    for size_texels in [128, 256] {
        let texel_m = 4.0 / f64::from(size_texels - 24);
        let found = edge_m(&gpu, &stage, Variant::Ground, size_texels) / texel_m;
        // A binomial of nine has a deviation of 1.4 texels: from a quarter to three quarters it is 1.9, and filtering
        // adds some.
        assert!((1.2..3.2).contains(&found), "{size_texels}: {found} texels");
    }
}

#[test]
fn a_sun_on_the_horizon_lights_a_wall_by_the_half_that_has_risen() {
    let gpu = gpu();
    for sine in [-0.02, 0.0, 0.02, 0.045] {
        let wall = block(Vec3::new(-2.0, 0.0, -2.0), Vec3::new(-1.5, 3.0, 2.0));
        let scene = SceneBuilder::new().soup(&wall).block(Vec3::new(8.0, -3.0, -1.0), Vec3::new(9.0, -2.5, 1.0));
        let stage = Stage::plain(scene.build(), Some(standing_sun(DVec3::new(1.0, sine, 0.0), RADIUS_RAD)));
        let shot = Shot::new(&stage, view(&stage, DVec3::new(3.0, 1.5, 0.3), DVec3::new(-1.5, 1.5, 0.0), [32, 32]));
        let moment = stage.moment(0.5);
        let truth = mask(&mut Truth::Soft { rays: 1024 }, &shot, &moment, LightKind::Sun).pixels;
        let mut maps = ShadowMaps::new(&gpu, &stage, MapSettings::new(Variant::Pcss)).unwrap();
        let seen = maps.visibility(&shot, &moment).unwrap().pixels;
        let middle = 16 * 32 + 16;
        // The share of a disc above a line, taken as linear across it, is off by a tenth at most.
        assert!((seen[middle] - truth[middle]).abs() < 0.11, "{sine}: {} for {}", seen[middle], truth[middle]);
        assert!(sine > 0.03 || truth[middle] < 0.9, "{}", truth[middle]);
    }
}
