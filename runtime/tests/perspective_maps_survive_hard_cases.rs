//! P1 to P6: perspective shadow maps where they are known to break. These tests need a GPU adapter, and fail without
//! one.

use glam::{DVec3, Vec2, Vec3};
use sunbake::scene::Scene;
use sunbake::testing::{SceneBuilder, block, floor};
use sunbake_runtime::gpu::Gpu;
use sunbake_runtime::shadow_maps::{MapSettings, Variant};
use sunbake_runtime::technique::{ShadowMaps, Technique};
use sunbake_runtime::testing::maps::{ReferenceShot, surface_points};
use sunbake_runtime::testing::masks::{gpu, under_sun};
use sunbake_runtime::testing::view;
use sunbake_runtime::{Shot, Stage, View};

const BOTH: [Variant; 2] = [Variant::Perspective, Variant::Cube];

/// A field of posts, with something below it, so that it could shade itself.
fn field() -> Scene {
    let mut builder = SceneBuilder::new()
        .soup(&floor(Vec2::splat(-60.0), Vec2::splat(60.0), 0.0))
        .block(Vec3::new(-59.0, -2.0, -59.0), Vec3::new(59.0, -1.0, 59.0));
    for i in 0..60u32 {
        let (x, z) = ((i * 37 % 110) as f32 - 55.0, (i * 61 % 110) as f32 - 55.0);
        builder = builder.block(Vec3::new(x, 0.0, z), Vec3::new(x + 1.0, 2.0 + (i % 5) as f32, z + 1.0));
    }
    builder.build()
}

/// From the field's edge across it.
fn across(stage: &Stage) -> View {
    view(stage, DVec3::new(-57.0, 3.0, 2.0), DVec3::new(-20.0, 0.0, 0.0), [128, 128])
}

/// The view's horizontal direction.
const AHEAD: DVec3 = DVec3::new(0.998_5, 0.0, -0.054);

/// Asserts that both forms have neither acne nor leaks under a sun, and bounds their mean error. Returns the numbers
/// of maps.
fn assert_sound(gpu: &Gpu, name: &str, towards: DVec3, most: f64) -> [usize; 2] {
    let stage = under_sun(field(), towards);
    let moment = stage.moment(0.5);
    let seen = ReferenceShot::new(&stage, across(&stage), &moment);
    BOTH.map(|variant| {
        let settings = MapSettings { size_texels: 1024, ..MapSettings::new(variant) };
        let mut maps = ShadowMaps::new(gpu, &stage, settings).unwrap();
        let found = seen.defects(&mut maps, &moment).unwrap();
        let count = maps.renderer().maps().len();
        println!(
            "{name} {variant}: {count} maps, {:.3} % wrong, mean {:.5}",
            found.share_wrong() * 100.0,
            found.mean_error()
        );
        assert_eq!((found.acne.len(), found.leaks.len()), (0, 0), "{name} {variant}");
        assert!(found.mean_error() < most, "{name} {variant}: {}", found.mean_error());
        count
    })
}

#[test]
fn p1_the_sun_stands_along_and_against_the_view() {
    let gpu = gpu();
    for height in [0.05, 0.3, 1.0] {
        assert_sound(&gpu, "p1, ahead", AHEAD + DVec3::Y * height, 0.02);
        assert_sound(&gpu, "p1, behind", DVec3::Y * height - AHEAD, 0.02);
    }
    // Exactly along the view's axis, and exactly against it.
    let stage = under_sun(field(), DVec3::Y);
    let forward = across(&stage).forward.as_dvec3();
    assert_sound(&gpu, "p1, against", -forward, 0.02);
}

#[test]
fn p2_the_light_is_behind_the_camera() {
    let gpu = gpu();
    for (i, aside) in [-1.0, -0.3, 0.4, 2.0].into_iter().enumerate() {
        let towards = DVec3::Y * 0.7 - AHEAD + AHEAD.cross(DVec3::Y) * aside;
        assert_sound(&gpu, &format!("p2, {i}"), towards, 0.02);
    }
}

#[test]
fn p3_the_sun_changes_from_a_direction_to_a_point_without_a_jump() {
    let gpu = gpu();
    let stage = under_sun(field(), DVec3::Y);
    let forward = across(&stage).forward.as_dvec3();
    let beside = (DVec3::Y - forward * forward.y + forward.cross(DVec3::Y) * 0.5).normalize();
    for turn in [1e-2, 1e-4, 1e-6, 1e-9, 0.0, -1e-9, -1e-6, -1e-4, -1e-2] {
        assert_sound(&gpu, &format!("p3, {turn:e}"), beside + forward * turn, 0.015);
    }
}

#[test]
fn p4_casters_behind_the_eye_cast_into_the_view() {
    let gpu = gpu();
    // A wall behind the eye, and the sun behind the wall: all of the view's ground near the eye is in its shadow.
    let wall = block(Vec3::new(-58.5, 0.0, -30.0), Vec3::new(-58.0, 12.0, 30.0));
    let towards = DVec3::new(-1.0, 0.5, 0.02);
    let scene = || SceneBuilder::new().soup(&floor(Vec2::splat(-60.0), Vec2::splat(60.0), 0.0)).soup(&wall).build();
    let stage = under_sun(scene(), towards);
    let (shot, moment) = (Shot::new(&stage, across(&stage)), stage.moment(0.5));
    for variant in BOTH {
        let mut maps = ShadowMaps::new(&gpu, &stage, MapSettings::new(variant)).unwrap();
        let seen = maps.visibility(&shot, &moment).unwrap().pixels;
        let (mut dark, mut lit) = (0, 0);
        // The shadow is twice as long as the wall is high.
        for (i, place) in surface_points(&shot).into_iter().filter(|(_, p)| p.y < 1e-3) {
            let away_m = place.x + 58.0;
            if away_m < 23.0 {
                assert_eq!(seen[i], 0.0, "{variant} at {place}");
                dark += 1;
            } else if away_m > 25.0 {
                assert_eq!(seen[i], 1.0, "{variant} at {place}");
                lit += 1;
            }
        }
        assert!(dark > 1000 && lit > 100, "{dark} {lit}");
    }
}

#[test]
fn p5_a_view_of_nothing_needs_no_map() {
    let gpu = gpu();
    let stage = under_sun(field(), DVec3::new(0.3, 0.8, 0.1));
    let up = view(&stage, DVec3::new(0.0, 20.0, 0.0), DVec3::new(1.0, 60.0, 0.0), [32, 32]);
    let (shot, moment) = (Shot::new(&stage, up), stage.moment(0.5));
    for variant in BOTH {
        let mut maps = ShadowMaps::new(&gpu, &stage, MapSettings::new(variant)).unwrap();
        assert!(maps.visibility(&shot, &moment).unwrap().pixels.iter().all(|&v| v == 1.0));
        let census = maps.census().unwrap();
        assert_eq!((census.shadow_maps, census.shadow_bytes, maps.report().maps), (0, 0, 0));
    }
}

#[test]
fn p6_the_faces_of_a_cube_meet_without_a_seam() {
    let gpu = gpu();
    let mut most = 0;
    for (ahead, aside, height) in
        [(1.0, 0.0, 0.06), (1.0, 0.25, 0.2), (1.0, -0.4, 0.4), (-1.0, 0.1, 0.3), (1.0, 0.05, 0.02)]
    {
        let towards = AHEAD * ahead + AHEAD.cross(DVec3::Y) * aside + DVec3::Y * height;
        let [single, cube] = assert_sound(&gpu, "p6", towards, 0.02);
        most = most.max(cube);
        assert_eq!(single, 1);
        // An open plane has no dark line where faces meet.
        let plain = SceneBuilder::new()
            .soup(&floor(Vec2::splat(-60.0), Vec2::splat(60.0), 0.0))
            .block(Vec3::new(-59.0, -2.0, -59.0), Vec3::new(59.0, -1.0, 59.0));
        let stage = under_sun(plain.build(), towards);
        let shot = Shot::new(&stage, across(&stage));
        let settings = MapSettings { size_texels: 512, ..MapSettings::new(Variant::Cube) };
        let mut maps = ShadowMaps::new(&gpu, &stage, settings).unwrap();
        let seen = maps.visibility(&shot, &stage.moment(0.5)).unwrap().pixels;
        assert!(surface_points(&shot).into_iter().filter(|(_, p)| p.y > -0.5).all(|(i, _)| seen[i] == 1.0));
    }
    assert!(most > 1, "no sun needed more than one face");
}
