//! V14 to V16, K1 and K2: what may be culled from shadow volumes, and where they end. Every way of drawing them gives
//! the same mask, bit for bit, and it equals hard truth. These tests need a GPU adapter, and fail without one.

use glam::{DVec3, Vec2, Vec3};
use sunbake::testing::{SceneBuilder, floor};
use sunbake_runtime::gpu::VolumeSettings;
use sunbake_runtime::technique::{LightKind, Truth, Volumes};
use sunbake_runtime::testing::masks::{
    OBLIQUE_SUN, assert_right, gpu, ground, mask, oblique_view, under_lamp, under_sun,
};
use sunbake_runtime::testing::view;
use sunbake_runtime::volumes::{Mode, VolumeOptimizations};
use sunbake_runtime::{Moment, Shot};

const SIZE: [u32; 2] = [128, 128];

#[test]
fn v14_infinite_volumes_reach_far_surfaces_and_leave_the_background() {
    let gpu = gpu();
    // Ground as far as a hundred kilometres, under a pole whose shadow reaches it at a grazing sun.
    let far = || {
        SceneBuilder::new()
            .soup(&floor(Vec2::splat(-1e5), Vec2::splat(1e5), 0.0))
            .block(Vec3::new(-500.0, 0.0, -300.0), Vec3::new(500.0, 4000.0, 300.0))
    };
    let stage = under_sun(far().build(), DVec3::new(1.0, 0.05, 0.2));
    let views = [
        view(&stage, DVec3::new(9e3, 2e3, 5e3), DVec3::new(-6e4, 0.0, -1.2e4), SIZE),
        view(&stage, DVec3::new(-3e4, 900.0, 3e3), DVec3::new(-9e4, 800.0, -1.6e4), SIZE),
    ];
    let found = assert_right(&gpu, "v14", &stage, &views, &stage.moment(0.5), LightKind::Sun);
    assert!(found.in_band > 100);
    // A block alone before the sky: nothing behind it is dark, whatever volume it lies in.
    let stage =
        under_lamp(SceneBuilder::new().block(Vec3::splat(-0.5), Vec3::splat(0.5)).build(), DVec3::new(0.9, 1.4, 0.3));
    let moment = stage.moment(0.0);
    let views = [oblique_view(&stage), view(&stage, DVec3::new(-0.7, -0.8, -0.2), DVec3::new(-3.0, -4.0, -1.0), SIZE)];
    assert_right(&gpu, "v14, lamp", &stage, &views, &moment, LightKind::Lamp);
    let shot = Shot::new(&stage, views[1]);
    let mut volumes = Volumes::new(&gpu, &stage, VolumeSettings::default()).unwrap();
    assert!(mask(&mut volumes, &shot, &moment, LightKind::Lamp).pixels.iter().all(|&v| v == 1.0));
}

#[test]
fn v15_each_saving_gives_the_same_mask() {
    let gpu = gpu();
    let scene = (0..12).fold(ground(), |builder, i| {
        let (sin, cos) = (i as f32 * 2.4).sin_cos();
        let at = Vec3::new(3.0 * cos, 0.2 + 0.1 * i as f32, 3.0 * sin);
        builder.block(at - 0.3, at + 0.3).soup(&floor(
            Vec2::new(at.x, at.z),
            Vec2::new(at.x + 0.8, at.z + 0.5),
            at.y + 0.9,
        ))
    });
    let stage = under_sun(scene.build(), OBLIQUE_SUN);
    let moment = stage.moment(0.5);
    let views = [oblique_view(&stage), view(&stage, DVec3::new(0.2, 0.3, 0.1), DVec3::new(2.0, 0.3, 2.0), SIZE)];
    assert_right(&gpu, "v15", &stage, &views, &moment, LightKind::Sun);
    let without = |edit: fn(&mut VolumeOptimizations)| {
        let mut optimizations = VolumeOptimizations::default();
        edit(&mut optimizations);
        optimizations
    };
    let each = [
        without(|s| s.view_culling = false),
        without(|s| s.receiver_culling = false),
        without(|s| s.z_pass = false),
        without(|s| s.cap_culling = false),
        without(|s| s.scissor = false),
        without(|s| s.solids = false),
        without(|s| s.cache = false),
    ];
    for view in views {
        let shot = Shot::new(&stage, view);
        let of = |optimizations| {
            let settings = VolumeSettings { optimizations, ..VolumeSettings::default() };
            let mut volumes = Volumes::new(&gpu, &stage, settings).unwrap();
            let seen = mask(&mut volumes, &shot, &moment, LightKind::Sun).pixels;
            // A second frame, for what is kept from the first.
            assert_eq!(mask(&mut volumes, &shot, &moment, LightKind::Sun).pixels, seen);
            (seen, volumes.report().lights[0].triangles)
        };
        let (expected, triangles) = of(VolumeOptimizations::default());
        for optimizations in each {
            let (seen, other) = of(optimizations);
            assert_eq!(seen, expected, "{optimizations:?}");
            assert!(other >= triangles, "{optimizations:?} draws less than all optimizations together");
        }
    }
}

#[test]
fn v16_finite_volumes_equal_infinite_ones_within_the_lamps_range() {
    let gpu = gpu();
    let scene = ground()
        .block(Vec3::new(-1.0, 0.0, -1.0), Vec3::new(-0.4, 1.0, -0.2))
        .block(Vec3::new(0.5, 0.4, 0.2), Vec3::new(1.1, 0.9, 0.9))
        .soup(&floor(Vec2::new(1.0, -2.0), Vec2::new(2.0, -1.0), 0.8));
    let stage = under_lamp(scene.build(), DVec3::new(0.2, 1.7, 0.1));
    let views = [oblique_view(&stage), view(&stage, DVec3::new(1.5, 0.5, -1.6), DVec3::new(5.0, 0.0, -4.0), SIZE)];
    let endless = stage.moment(0.0);
    assert_right(&gpu, "v16", &stage, &views, &endless, LightKind::Lamp);
    let range_m = 3.5;
    let mut finite = endless;
    finite.lamp.as_mut().unwrap().range_m = range_m;
    assert_right(&gpu, "v16, finite", &stage, &views, &finite, LightKind::Lamp);
    for view in views {
        let shot = Shot::new(&stage, view);
        let of = |moment: &Moment, mode| {
            let mut volumes = Volumes::new(&gpu, &stage, VolumeSettings { mode, ..VolumeSettings::default() }).unwrap();
            mask(&mut volumes, &shot, moment, LightKind::Lamp).pixels
        };
        let truth = mask(&mut Truth::Hard, &shot, &endless, LightKind::Lamp);
        let expected = of(&endless, Mode::Planned);
        let lamp_m = endless.lamp.unwrap().position_m;
        for mode in [Mode::Planned, Mode::ZFail, Mode::Triangles, Mode::Gpu] {
            let seen = of(&finite, mode);
            let (mut within, mut beyond, mut differ) = (0, 0, 0);
            for (i, hit) in shot.hits().iter().enumerate() {
                let Some(hit) = hit else { continue };
                let place_m = stage.geometry.point(hit.triangle as usize, hit.barycentric).as_vec3();
                if place_m.distance(lamp_m) > range_m * 1.001 {
                    beyond += 1;
                    assert_eq!(seen[i], 0.0, "lit beyond the range");
                } else if place_m.distance(lamp_m) < range_m * 0.999 {
                    within += 1;
                    differ += usize::from(seen[i] != expected[i]);
                    assert!(seen[i] == expected[i] || near_an_edge(&truth.pixels, i), "{mode} at {i}");
                }
            }
            assert!(
                within > 500 && differ <= within / 500,
                "{mode}: {differ} of {within} differ at edges; {beyond} beyond"
            );
        }
    }
}

fn near_an_edge(mask: &[f32], i: usize) -> bool {
    let (x, y) = ((i % 128) as i32, (i / 128) as i32);
    let at = |dx: i32, dy: i32| mask[((y + dy).clamp(0, 127) * 128 + (x + dx).clamp(0, 127)) as usize];
    (-1..=1).any(|dy| (-1..=1).any(|dx| at(dx, dy) != at(0, 0)))
}

#[test]
fn k1_the_sun_goes_round_and_culling_changes_no_pixel() {
    let gpu = gpu();
    let scene = (0..40).fold(ground(), |builder, i| {
        let (sin, cos) = (i as f32 * 2.4).sin_cos();
        let at = Vec3::new((1.0 + 0.12 * i as f32) * cos, 0.3, (1.0 + 0.12 * i as f32) * sin);
        builder.block(at - 0.2, at + Vec3::new(0.2, 0.2 + 0.05 * i as f32, 0.2))
    });
    let scene = scene.build();
    let mut culled = 0;
    for turn in 0..36 {
        let (sin, cos) = (f64::from(turn) * 10.0).to_radians().sin_cos();
        let stage = under_sun(scene.clone(), DVec3::new(cos, 0.4, sin));
        let moment = stage.moment(0.5);
        let shot = Shot::new(&stage, view(&stage, DVec3::new(2.2, 0.9, 1.8), DVec3::new(0.6, 0.2, 0.2), [96, 96]));
        let of = |optimizations| {
            let settings = VolumeSettings { optimizations, ..VolumeSettings::default() };
            let mut volumes = Volumes::new(&gpu, &stage, settings).unwrap();
            (mask(&mut volumes, &shot, &moment, LightKind::Sun).pixels, volumes.report().lights[0].plan)
        };
        let ((seen, plan), (expected, _)) = (of(VolumeOptimizations::default()), of(VolumeOptimizations::NONE));
        assert_eq!(seen, expected, "sun at {turn}0 degrees");
        culled += plan.out_of_view + plan.shading_nothing;
        if turn % 9 == 0 {
            assert_right(&gpu, "k1", &stage, &[shot.view], &moment, LightKind::Sun);
        }
    }
    assert!(culled > 36, "nothing was left out");
}

#[test]
fn k2_hulls_of_view_and_light_may_be_degenerate() {
    let gpu = gpu();
    let scene = || {
        ground()
            .block(Vec3::new(-1.0, 0.0, -1.0), Vec3::new(-0.25, 1.0, -0.25))
            .block(Vec3::new(0.6, 0.3, 0.4), Vec3::new(1.2, 0.9, 1.1))
            .build()
    };
    let eye = DVec3::new(3.1, 1.7, 2.9);
    let target = DVec3::new(0.1, 0.4, 0.1);
    // The lamp in view; at the eye; in the plane of the view's side, of a face and of the ground's top; within a
    // caster; behind the eye.
    let places = [
        target + DVec3::Y * 0.8,
        eye,
        eye + DVec3::Y * 1e-6,
        DVec3::new(-0.25, 1.0, 3.0),
        DVec3::new(-0.6, 1.0, -0.6),
        DVec3::new(-0.6, 0.5, -0.6),
        eye + (eye - target),
    ];
    for (i, at) in places.into_iter().enumerate() {
        let stage = under_lamp(scene(), at);
        let view = view(&stage, eye, target, SIZE);
        assert_right(&gpu, &format!("k2, lamp {i}"), &stage, &[view], &stage.moment(0.0), LightKind::Lamp);
    }
    // The sun along the line of sight, either way.
    for towards in [eye - target, DVec3::new(-3.0, 0.3, -2.8)] {
        let stage = under_sun(scene(), towards);
        let views =
            [view(&stage, eye, target, SIZE), view(&stage, target + DVec3::Y, target + DVec3::Y + towards, SIZE)];
        assert_right(&gpu, "k2, sun", &stage, &views, &stage.moment(0.5), LightKind::Sun);
    }
}
