//! Pictures lit through shadow volumes against pictures shaded on the CPU from hard truth, an area light of many hard
//! ones, and a comparer that can fail. These tests need a GPU adapter, and fail without one.

use glam::{DVec3, Vec2, Vec3};
use sunbake::lamp::{LampKey, LampPath};
use sunbake::scene::{Material, Scene};
use sunbake::testing::{SceneBuilder, floor, icosphere, opaque};
use sunbake_runtime::compare::{Agreement, MaskAgreement, color_difference, edges, mean, visibility_difference};
use sunbake_runtime::gpu::VolumeSettings;
use sunbake_runtime::shade::lit_picture;
use sunbake_runtime::technique::{LightKind, Technique, Truth, Volumes};
use sunbake_runtime::testing::masks::{gpu, mask};
use sunbake_runtime::testing::{equinox, standing_sun, view};
use sunbake_runtime::{Moment, Raster, Shot, Stage};

fn scene() -> Scene {
    let glowing = Material { emissive: Vec3::new(0.2, 0.05, 0.0), ..opaque() };
    let flat = Material { is_unlit: true, ..opaque() };
    let ball: Vec<_> = icosphere(2).iter().map(|t| t.map(|v| v * 0.6 + Vec3::new(1.3, 0.9, 0.4))).collect();
    let sign = floor(Vec2::new(-1.4, 0.6), Vec2::new(-0.4, 1.3), 1.1);
    SceneBuilder::new()
        .soup(&floor(Vec2::splat(-4.0), Vec2::splat(4.0), 0.0))
        .block(Vec3::new(-1.0, 0.0, -1.0), Vec3::new(-0.2, 1.3, -0.3))
        .soup_of(&ball, glowing)
        .soup_of(&sign, Material { is_double_sided: true, ..flat })
        .build()
}

fn lamp() -> LampPath {
    let key = |t, x| LampKey { t, position_m: DVec3::new(x, 1.9, 1.2) };
    LampPath::new(vec![key(0.0, -2.0), key(1.0, 2.0)], 0.0, 10.0).unwrap()
}

fn shot(stage: &Stage) -> Shot<'_> {
    Shot::new(stage, view(stage, DVec3::new(3.9, 3.3, 4.6), DVec3::new(0.1, 0.4, 0.0), [160, 120]))
}

#[test]
fn the_picture_is_ambient_light_first_and_each_light_where_its_stencil_is_zero() {
    let gpu = gpu();
    let stage = Stage::plain(scene(), Some(equinox(40.0))).with_lamp(Some(&lamp()));
    let shot = shot(&stage);
    let mut volumes = Volumes::new(&gpu, &stage, VolumeSettings::default()).unwrap();
    for t in [0.12, 0.4, 0.77] {
        let both = stage.moment(t);
        let sun = Moment { lamp: None, ..both };
        let lamp = Moment { lamp: both.lamp, ..both.without_sun() };
        for (what, moment) in [("sun and lamp", both), ("sun", sun), ("lamp", lamp), ("no sky", both.without_sky())] {
            let seen = mask(&mut Truth::Hard, &shot, &moment, LightKind::Sun);
            let of_lamp = moment.lamp.map(|_| mask(&mut Truth::Hard, &shot, &moment, LightKind::Lamp));
            let expected = lit_picture(&shot, &moment, &seen, of_lamp.as_ref());
            let found = volumes.color(&shot, &moment).unwrap();
            let at_edges: Vec<bool> = match &of_lamp {
                Some(of_lamp) => edges(&shot, &seen).iter().zip(edges(&shot, of_lamp)).map(|(a, b)| *a || b).collect(),
                None => edges(&shot, &seen),
            };
            let found = Agreement::new(&color_difference(&found, &expected), &at_edges, 1.0 / 255.0 + 1e-6);
            assert!(found.unexplained == 0 && found.share_within() > 0.97, "{what} at {t}: {found:?}");
        }
    }
}

#[test]
fn many_hard_suns_make_a_soft_one_and_more_of_them_a_better_one() {
    let gpu = gpu();
    let stage = Stage::plain(scene(), Some(standing_sun(DVec3::new(0.5, 0.7, 0.3), 0.06)));
    let (shot, moment) = (shot(&stage), stage.moment(0.5));
    let truth = mask(&mut Truth::Soft { rays: 1024 }, &shot, &moment, LightKind::Sun);
    let mut errors = Vec::new();
    for count in [1, 4, 16, 64] {
        let settings = VolumeSettings { sun_samples: count, ..VolumeSettings::default() };
        let mut volumes = Volumes::new(&gpu, &stage, settings).unwrap();
        let seen = mask(&mut volumes, &shot, &moment, LightKind::Sun);
        let is_step = |v: &f32| (v * count as f32 - (v * count as f32).round()).abs() < 1e-3;
        assert!(seen.pixels.iter().all(|v| is_step(v) && (0.0..=1.0001).contains(v)), "{count}");
        errors.push(mean(&visibility_difference(&seen, &truth)));
        assert_eq!(volumes.report().passes, 1 + 2 * count as usize);
    }
    println!("mean error of 1, 4, 16 and 64 suns: {errors:?}");
    assert!(errors.windows(2).all(|pair| pair[1] < 0.7 * pair[0]) && errors[3] < 0.003, "{errors:?}");
}

#[test]
fn the_comparer_of_masks_can_fail() {
    let stage = Stage::plain(scene(), Some(equinox(40.0)));
    let (shot, moment) = (shot(&stage), stage.moment(0.35));
    let truth = mask(&mut Truth::Hard, &shot, &moment, LightKind::Sun);
    let depth = |i: usize| shot.hits()[i].map_or(f64::INFINITY, |hit| hit.distance_m / shot.ray(i).as_dvec3().length());
    let depths_m: Vec<f32> = (0..truth.pixels.len()).map(|i| depth(i) as f32).collect();
    let compare = |mask: &Raster<f32>| MaskAgreement::new(&shot, &moment, LightKind::Sun, mask, &truth, &depths_m);
    assert_eq!(
        compare(&truth),
        MaskAgreement { in_band: compare(&truth).in_band, pixels: 160 * 120, ..Default::default() }
    );
    // One pixel far from any edge, lit where it is dark, dark where it is lit, and neither.
    let width = 160;
    let far = |lit: f32| {
        let is_far = |i: &usize| {
            let (x, y) = (i % width, i / width);
            let all = (y.saturating_sub(2)..(y + 3).min(120))
                .flat_map(|r| (x.saturating_sub(2)..(x + 3).min(width)).map(move |c| r * width + c));
            shot.hits()[*i].is_some() && all.into_iter().all(|n| truth.pixels[n] == lit)
        };
        (0..truth.pixels.len()).find(is_far).unwrap()
    };
    for (at, value) in [(far(1.0), 0.0), (far(0.0), 1.0), (far(1.0), 0.5), (far(0.0), f32::NAN)] {
        let mut corrupted = truth.clone();
        corrupted.pixels[at] = value;
        assert_eq!(compare(&corrupted).unexplained, [at]);
    }
    // A sun that stands twelve degrees off.
    let off = mask(&mut Truth::Hard, &shot, &stage.moment(0.35 + 12.0 / 180.0), LightKind::Sun);
    assert!(compare(&off).unexplained.len() > 20);
}
