//! J1, and further claims about shadows that are projected on the ground. These tests need a GPU adapter, and fail
//! without one.

use glam::{DVec3, Vec2, Vec3};
use sunbake::testing::{SceneBuilder, block, floor};
use sunbake_runtime::gpu::Gpu;
use sunbake_runtime::shadow_maps::{MapSettings, Variant};
use sunbake_runtime::technique::{LightKind, ShadowMaps, Technique, Truth};
use sunbake_runtime::testing::maps::surface_points;
use sunbake_runtime::testing::masks::{OBLIQUE_SUN, gpu, ground, mask, oblique_view, under_sun};
use sunbake_runtime::{Shot, Stage};

fn seen(gpu: &Gpu, shot: &Shot, variant: Variant) -> Vec<f32> {
    let mut maps = ShadowMaps::new(gpu, shot.stage, MapSettings::new(variant)).unwrap();
    maps.visibility(shot, &shot.stage.moment(0.5)).unwrap().pixels
}

/// Pixels that show the ground, whose height is zero.
fn on_ground(shot: &Shot) -> Vec<(usize, DVec3)> {
    surface_points(shot).into_iter().filter(|(_, p)| p.y.abs() < 1e-3).collect()
}

#[test]
fn j1_a_light_level_with_the_plane_gives_finite_numbers() {
    let gpu = gpu();
    for height in [0.0, 1e-30, 1e-12, 1e-6, 1e-3, 0.02] {
        let scene = ground().block(Vec3::new(-0.5, 0.0, -0.5), Vec3::new(0.5, 1.0, 0.5)).build();
        let stage = under_sun(scene, DVec3::new(-1.0, height, 0.2));
        let shot = Shot::new(&stage, oblique_view(&stage));
        let seen = seen(&gpu, &shot, Variant::Planar);
        assert!(seen.iter().all(|v| *v == 0.0 || *v == 1.0), "{height}");
        let is_up = stage.moment(0.5).sun_direction.y > 0.0;
        for (i, place) in on_ground(&shot) {
            let is_behind = place.x > 0.6 && place.x < 5.0 && (place.z + 0.2 * place.x).abs() < 0.2;
            // Below a level sun the ground is not lit at all.
            assert!(seen[i] == 0.0 || (is_up && !is_behind), "{height}: {place}");
        }
    }
}

#[test]
fn j1_a_caster_below_the_plane_casts_nothing_on_it() {
    let gpu = gpu();
    // A caster below would be projected up on to the plane, against the light.
    let scene = ground().block(Vec3::new(-1.0, -3.0, -1.0), Vec3::new(1.0, -1.0, 1.0)).build();
    let stage = under_sun(scene, OBLIQUE_SUN);
    let shot = Shot::new(&stage, oblique_view(&stage));
    for variant in [Variant::Planar, Variant::Ground] {
        let seen = seen(&gpu, &shot, variant);
        assert!(on_ground(&shot).iter().all(|(i, _)| seen[*i] == 1.0), "{variant}");
    }
    // Of a caster that crosses the plane only the part above it casts.
    let half = ground().block(Vec3::new(-1.0, -3.0, -1.0), Vec3::new(1.0, 1.0, 1.0)).build();
    let stage = under_sun(half, OBLIQUE_SUN);
    let shot = Shot::new(&stage, oblique_view(&stage));
    let truth = mask(&mut Truth::Hard, &shot, &stage.moment(0.5), LightKind::Sun).pixels;
    let seen = seen(&gpu, &shot, Variant::Planar);
    let differ = on_ground(&shot).into_iter().filter(|(i, _)| seen[*i] != truth[*i]).count();
    assert!(differ <= 8, "{differ}");
}

#[test]
fn j1_casters_that_overlap_do_not_darken_twice() {
    let gpu = gpu();
    let roof = |y: f32| block(Vec3::new(-1.0, y, -1.0), Vec3::new(1.0, y + 0.1, 1.0));
    let light_of = |count: usize| {
        let roofs: Vec<_> = (0..count).flat_map(|i| roof(3.0 + i as f32)).collect();
        let stage = under_sun(ground().soup(&roofs).build(), DVec3::Y);
        let shot = Shot::new(&stage, oblique_view(&stage));
        let mut maps = ShadowMaps::new(&gpu, &stage, MapSettings::new(Variant::Planar)).unwrap();
        let lit = maps.color(&shot, &stage.moment(0.5)).unwrap();
        // In the middle of the shadow.
        let (i, _) = on_ground(&shot).into_iter().find(|(_, p)| p.x.abs() < 0.2 && p.z.abs() < 0.2).unwrap();
        lit.pixels[i]
    };
    assert_eq!(light_of(1), light_of(5));
}

#[test]
fn j1_a_finite_ground_clips_its_shadows_and_nothing_else_is_shaded() {
    let gpu = gpu();
    // A platform, and a tall block whose shadow reaches far beyond its edge, over a wall that stands aside.
    let scene = SceneBuilder::new()
        .soup(&floor(Vec2::splat(-2.0), Vec2::splat(2.0), 0.0))
        .block(Vec3::new(-0.5, 0.0, -0.5), Vec3::new(0.5, 6.0, 0.5))
        .block(Vec3::new(-5.0, -1.0, -4.0), Vec3::new(-4.0, 2.0, 4.0))
        .build();
    let stage = under_sun(scene, DVec3::new(1.0, 0.8, 0.1));
    let shot = Shot::new(&stage, oblique_view(&stage));
    let seen = seen(&gpu, &shot, Variant::Planar);
    let moment = stage.moment(0.5);
    let truth = mask(&mut Truth::Hard, &shot, &moment, LightKind::Sun).pixels;
    let mut dark = 0;
    for (pixel, hit) in shot.hits().iter().enumerate() {
        let Some(hit) = hit else {
            assert_eq!(seen[pixel], 1.0, "there is nothing to be shaded at {pixel}");
            continue;
        };
        let place = stage.geometry.point(hit.triangle as usize, hit.barycentric) + stage.scene.centre_m;
        let is_ground = place.y.abs() < 1e-3 && place.x.abs().max(place.z.abs()) < 1.99;
        let normal = stage.geometry.normal(hit.triangle as usize);
        if is_ground && (place.z - 0.1 * place.x).abs() < 0.4 && place.x < -0.6 {
            assert_eq!((seen[pixel], truth[pixel]), (0.0, 0.0), "{place}");
            dark += 1;
        } else if place.y.abs() > 1e-3 && normal.dot(moment.sun_direction.as_dvec3()) > 0.1 {
            assert_eq!(seen[pixel], 1.0, "{place} is no ground");
        }
    }
    assert!(dark > 50, "{dark}");
}

#[test]
fn without_a_level_plane_there_is_no_ground_and_nothing_is_shaded_or_built() {
    let gpu = gpu();
    let slope = [[Vec3::new(-3.0, 0.0, -3.0), Vec3::new(0.0, 1.0, 3.0), Vec3::new(3.0, 0.5, -3.0)]];
    let stage: Stage = under_sun(SceneBuilder::new().soup(&slope).build(), DVec3::new(0.1, 1.0, 0.2));
    let shot = Shot::new(&stage, oblique_view(&stage));
    let mut maps = ShadowMaps::new(&gpu, &stage, MapSettings::new(Variant::Planar)).unwrap();
    let seen = maps.visibility(&shot, &stage.moment(0.5)).unwrap();
    let census = maps.census().unwrap();
    assert!(seen.pixels.contains(&1.0) && maps.notes().iter().any(|line| line.contains("there is no ground")));
    assert_eq!((census.shadow_masks, census.shadow_pipelines, census.passes), (0, 0, 2));
}

#[test]
fn a_ground_that_lies_there_twice_or_turned_over_does_not_shade_itself() {
    let gpu = gpu();
    let level = floor(Vec2::splat(-6.0), Vec2::splat(6.0), 0.0);
    let turned: Vec<[Vec3; 3]> = level.iter().map(|&[a, b, c]| [a, c, b]).collect();
    for twin in [level.clone(), turned] {
        let scene = || SceneBuilder::new().soup(&level).soup(&twin);
        let stage = under_sun(scene().block(Vec3::new(-0.5, 0.0, -0.5), Vec3::new(0.5, 1.0, 0.5)).build(), OBLIQUE_SUN);
        let shot = Shot::new(&stage, oblique_view(&stage));
        let truth = mask(&mut Truth::Hard, &shot, &stage.moment(0.5), LightKind::Sun).pixels;
        for variant in [Variant::Planar, Variant::Ground, Variant::Cascades] {
            let seen = seen(&gpu, &shot, variant);
            let differ = on_ground(&shot).into_iter().filter(|(i, _)| (seen[*i] - truth[*i]).abs() > 0.6).count();
            assert!(differ <= 30, "{variant}: {differ}");
        }
    }
}

#[test]
fn a_roof_is_no_ground() {
    let roof = block(Vec3::new(-8.0, 5.0, -8.0), Vec3::new(8.0, 5.2, 8.0));
    let stage = under_sun(ground().soup(&roof).build(), OBLIQUE_SUN);
    let found = sunbake_runtime::shadow_maps::Ground::new(&stage).height_m.unwrap() + stage.scene.centre_m.y;
    assert!(found.abs() < 1e-3, "{found}");
}
