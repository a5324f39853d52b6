//! A lamp that moves through a room: the GPU against its CPU twin, playback against truth, and no cost for sets
//! without a lamp. These tests need a GPU adapter, and fail without one.

use glam::{DVec3, Vec2, Vec3};
use sunbake::lamp::{LampKey, LampPath};
use sunbake::maps::Bits;
use sunbake::scene::{Material, Scene};
use sunbake::testing::{SceneBuilder, floor, opaque};
use sunbake_runtime::compare::{Agreement, color_difference, edges, visibility_difference};
use sunbake_runtime::plan::Census;
use sunbake_runtime::technique::{BakedCpu, BakedGpu, Technique, Truth};
use sunbake_runtime::testing::masks::gpu;
use sunbake_runtime::testing::{bake, equinox, table_line, view, with_lamp};
use sunbake_runtime::{Filter, Moment, Raster, Shot, Stage};

const CELL: u32 = 40;

/// A floor, two posts, and a screen that may be seen from both sides.
fn room() -> Scene {
    let screen = floor(Vec2::new(-1.0, 0.2), Vec2::new(1.0, 1.4), 0.0);
    let screen: Vec<_> = screen.iter().map(|t| t.map(|v| Vec3::new(v.x, v.z, -1.5))).collect();
    SceneBuilder::new()
        .soup(&floor(Vec2::splat(-3.0), Vec2::splat(3.0), 0.0))
        .block(Vec3::new(-1.2, 0.0, 0.2), Vec3::new(-0.9, 1.5, 0.5))
        .block(Vec3::new(1.0, 0.0, -0.4), Vec3::new(1.4, 0.8, 0.0))
        .soup_of(&screen, Material { is_double_sided: true, ..opaque() })
        .build()
}

/// Across the room, around a corner, and down to the floor.
fn path(radius_m: f64) -> LampPath {
    let places = [[-2.5, 1.2, 1.5], [2.0, 1.6, 1.2], [0.3, 1.1, -2.6]];
    let key = |(i, place): (usize, &[f64; 3])| LampKey { t: i as f64 / 2.0, position_m: DVec3::from_array(*place) };
    LampPath::new(places.iter().enumerate().map(key).collect(), radius_m, 10.0).unwrap()
}

fn stage(has_sun: bool, radius_m: f64, bits: Bits) -> Stage {
    with_lamp(bake(room(), has_sun.then(|| equinox(35.0)), CELL, bits), &path(radius_m), CELL)
}

fn shot(stage: &Stage) -> Shot<'_> {
    Shot::new(stage, view(stage, DVec3::new(3.5, 4.0, 5.5), DVec3::new(0.0, 0.3, 0.0), [192, 128]))
}

#[test]
fn the_gpu_agrees_with_its_twin_about_a_lamp() {
    let gpu = gpu();
    for (has_sun, radius_m, bits, filter) in [
        (false, 0.15, Bits::Sixteen, Filter::Bilinear),
        (true, 0.15, Bits::Eight, Filter::Bilinear),
        (true, 0.15, Bits::Sixteen, Filter::Sharp),
        (false, 0.0, Bits::Sixteen, Filter::Nearest),
    ] {
        let stage = stage(has_sun, radius_m, bits);
        let shot = shot(&stage);
        let (mut on_gpu, mut on_cpu) = (BakedGpu::new(&gpu, &stage, filter).unwrap(), BakedCpu::new(&stage, filter));
        for t in (0..8).map(|i| (f64::from(i) + 0.5) / 8.0) {
            let moment = stage.moment(t);
            let seen =
                [on_gpu.lamp_visibility(&shot, &moment), on_cpu.lamp_visibility(&shot, &moment)].map(Result::unwrap);
            let sun = on_cpu.visibility(&shot, &moment).unwrap();
            let color = [on_gpu.color(&shot, &moment), on_cpu.color(&shot, &moment)].map(Result::unwrap);
            let of_lamp = edges(&shot, &seen[1]);
            let of_both: Vec<bool> = of_lamp.iter().zip(edges(&shot, &sun)).map(|(a, b)| *a || b).collect();
            for (what, difference, edges) in [
                ("lamp", visibility_difference(&seen[0], &seen[1]), &of_lamp),
                ("picture", color_difference(&color[0], &color[1]), &of_both),
            ] {
                let found = Agreement::new(&difference, edges, 1.0 / 255.0 + 1e-6);
                println!("{}", table_line(&format!("lamp, sun {has_sun}, {bits:?}"), t, what, &found));
                assert!(found.share_within() >= 0.999 && found.unexplained == 0, "{found:?}");
                assert!(!found.worst.is_nan());
            }
        }
    }
}

fn mean_difference(a: &Raster<f32>, b: &Raster<f32>) -> f64 {
    let sum: f64 = a.pixels.iter().zip(&b.pixels).map(|(a, b)| f64::from((a - b).abs())).sum();
    sum / a.pixels.len() as f64
}

/// With finer texels playback approaches truth, and they differ only near shadow edges: no acne, no leaks.
#[test]
fn playback_is_near_truth_and_wrong_at_edges_alone() {
    let stage = stage(false, 0.1, Bits::Sixteen);
    let shot = shot(&stage);
    let mut baked = BakedCpu::new(&stage, Filter::Bilinear);
    for t in [0.1, 0.3, 0.5, 0.7, 0.9] {
        let moment = stage.moment(t);
        let found = baked.lamp_visibility(&shot, &moment).unwrap();
        let truth = Truth::Soft { rays: 64 }.lamp_visibility(&shot, &moment).unwrap();
        let hard = Truth::Hard.lamp_visibility(&shot, &moment).unwrap();
        let (error, lit) = (
            mean_difference(&found, &truth),
            mean_difference(&truth, &Raster { pixels: vec![0.0; truth.pixels.len()], ..truth }),
        );
        println!("t {t}: mean error {error:.4}, {lit:.3} lit");
        assert!(error < 0.02, "t {t}: {error}");
        assert!(mean_difference(&hard, &truth) < 0.02, "t {t}: hard truth is soft truth but for penumbrae");
        let far = far_from_change(&truth, 5);
        let wrong = far.iter().filter(|&&pixel| (found.pixels[pixel] - truth.pixels[pixel]).abs() > 0.5).count();
        assert!(far.len() > 10_000 && wrong <= far.len() / 2000, "t {t}: {wrong} of {} pixels", far.len());
    }
}

/// Pixels around which an image is the same for `reach` pixels in each direction.
fn far_from_change(image: &Raster<f32>, reach: i64) -> Vec<usize> {
    let [width, height] = image.size.map(i64::from);
    let at = |x: i64, y: i64| image.pixels[(y.clamp(0, height - 1) * width + x.clamp(0, width - 1)) as usize];
    let is_far = |&pixel: &usize| {
        let (x, y) = (pixel as i64 % width, pixel as i64 / width);
        let mut around = (-reach..=reach).flat_map(|dy| (-reach..=reach).map(move |dx| (dx, dy)));
        around.all(|(dx, dy)| at(x + dx, y + dy) == at(x, y))
    };
    (0..image.pixels.len()).filter(is_far).collect()
}

/// Straight above an open floor the lamp's light falls with the square of the distance.
#[test]
fn light_falls_with_the_square_of_distance() {
    let level = floor(Vec2::splat(-3.0), Vec2::splat(3.0), 0.0);
    let rising = [[0.5, 1.0, 0.5], [0.5, 2.0, 0.5]];
    let key = |i: usize| LampKey { t: i as f64, position_m: DVec3::from_array(rising[i]) };
    let lamp = LampPath::new(vec![key(0), key(1)], 0.0, 1.0).unwrap();
    let stage = with_lamp(bake(SceneBuilder::new().soup(&level).build(), None, CELL, Bits::Sixteen), &lamp, CELL);
    let below = Shot::new(&stage, view(&stage, DVec3::new(0.5, 3.0, 0.51), DVec3::new(0.5, 0.0, 0.5), [3, 3]));
    let mut baked = BakedCpu::new(&stage, Filter::Bilinear);
    let mut light = |moment: &Moment| baked.color(&below, moment).unwrap().pixels[4].x;
    let dark = light(&Moment::new(None, 0.0));
    let [near, far] = [0.0, 1.0].map(|t| light(&stage.moment(t)) - dark);
    assert!((near / far - 4.0).abs() < 0.02, "{near} {far}");
}

#[test]
fn a_lamp_costs_the_sets_that_have_one() {
    let gpu = gpu();
    let census = |stage: &Stage| {
        let shot = Shot::new(stage, view(stage, DVec3::new(4.0, 3.0, 5.0), DVec3::ZERO, [16, 16]));
        let mut technique = BakedGpu::new(&gpu, stage, Filter::Bilinear).unwrap();
        drop(technique.color(&shot, &stage.moment(0.5)).unwrap());
        technique.census().unwrap()
    };
    let without = census(&bake(room(), Some(equinox(35.0)), CELL, Bits::Sixteen));
    assert_eq!((without.lamp_bindings, without.time_textures), (0, 2));
    let with = stage(true, 0.1, Bits::Sixteen);
    let page = &with.pages[0];
    let lamp_bytes = page.lamp.as_ref().unwrap().len() as u64 * u64::from(page.width) * u64::from(page.height) * 16;
    let expected = Census {
        lamp_bindings: 1,
        time_textures: 4,
        bindings: without.bindings + 3,
        map_bytes: without.map_bytes + lamp_bytes,
        ..without
    };
    assert_eq!(census(&with), expected);
    let alone = census(&stage(false, 0.1, Bits::Sixteen));
    assert_eq!((alone.lamp_bindings, alone.time_textures, alone.map_bytes), (1, 2, lamp_bytes));
}
