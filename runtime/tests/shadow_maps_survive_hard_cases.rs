//! M1 to M10: shadow maps where they are known to break. These tests need a GPU adapter, and fail without one.

use glam::{DVec3, Vec2, Vec3};
use sunbake::scene::Scene;
use sunbake::testing::{SceneBuilder, block, floor};
use sunbake_runtime::gpu::Gpu;
use sunbake_runtime::shadow_maps::{Bias, MapOptimizations, MapSettings, Variant};
use sunbake_runtime::technique::{ShadowMaps, Technique};
use sunbake_runtime::testing::maps::{ReferenceShot, surface_points};
use sunbake_runtime::testing::masks::{OBLIQUE_SUN, gpu, ground, oblique_view, under_sun};
use sunbake_runtime::testing::view;
use sunbake_runtime::{Camera, Moment, Shot, Stage, View};

const SIZE: [u32; 2] = [128, 128];

/// Variants with maps of depths whose bias needs no tuning.
const UNTUNED: [Variant; 8] = [
    Variant::Compare,
    Variant::Pcf16,
    Variant::Pcf4,
    Variant::Pcss,
    Variant::Cascades,
    Variant::Perspective,
    Variant::Cube,
    Variant::Ground,
];

fn sized(variant: Variant, size_texels: u32) -> MapSettings {
    MapSettings { size_texels, ..MapSettings::new(variant) }
}

fn seen(gpu: &Gpu, shot: &Shot, moment: &Moment, settings: MapSettings) -> Vec<f32> {
    let mut maps = ShadowMaps::new(gpu, shot.stage, settings).unwrap_or_else(|e| panic!("{}: {e}", settings.variant));
    maps.visibility(shot, moment).unwrap_or_else(|e| panic!("{}: {e}", settings.variant)).pixels
}

/// Asserts that a variant has neither acne nor leaks in a view; its mean error.
fn assert_no_defects(gpu: &Gpu, name: &str, stage: &Stage, view: View, settings: MapSettings) -> f64 {
    let moment = stage.moment(0.5);
    let mut maps = ShadowMaps::new(gpu, stage, settings).unwrap();
    let found = ReferenceShot::new(stage, view, &moment).defects(&mut maps, &moment).unwrap();
    println!(
        "{name} {} {}: {:.3} % wrong, mean {:.5}",
        settings.variant,
        settings.size_texels,
        found.share_wrong() * 100.0,
        found.mean_error()
    );
    let counts = (found.acne.len(), found.leaks.len());
    assert_eq!(counts, (0, 0), "{name} {}: {:?}", settings.variant, found.acne.iter().chain(&found.leaks).next());
    found.mean_error()
}

/// The ground with something below it, so that it is on the map and could shade itself.
fn ground_that_casts() -> SceneBuilder {
    ground().block(Vec3::new(-5.0, -2.0, -5.0), Vec3::new(5.0, -1.0, 5.0))
}

/// Whether a pixel shows the ground, not what is below it.
fn shows_ground(shot: &Shot) -> Vec<usize> {
    surface_points(shot).into_iter().filter(|(_, place)| place.y > -0.5).map(|(i, _)| i).collect()
}

#[test]
fn m1_a_plane_at_a_grazing_sun_does_not_shade_itself() {
    let gpu = gpu();
    for elevation_deg in [0.1f64, 0.5, 3.0, 20.0, 60.0, 90.0] {
        let (sin, cos) = elevation_deg.to_radians().sin_cos();
        let stage = under_sun(ground_that_casts().build(), DVec3::new(cos * 0.8, sin, cos * 0.6));
        let moment = stage.moment(0.5);
        let shots = [DVec3::new(4.1, 3.7, 5.3), DVec3::new(-5.0, 0.1, 2.0)]
            .map(|eye| Shot::new(&stage, view(&stage, eye, DVec3::new(0.0, 0.0, -0.2), SIZE)));
        // Of a disc that touches the horizon only the part above it is visible.
        let above_horizon = (0.5 + moment.sun_direction.y * moment.inverse_angular_diameter).min(1.0);
        for (variant, size_texels) in UNTUNED.into_iter().flat_map(|v| [(v, 128), (v, 1024)]) {
            let expected = if variant == Variant::Pcss { above_horizon } else { 1.0 };
            let mut maps = ShadowMaps::new(&gpu, &stage, sized(variant, size_texels)).unwrap();
            for shot in &shots {
                let seen = maps.visibility(shot, &moment).unwrap().pixels;
                let least = shows_ground(shot).into_iter().map(|i| seen[i]).fold(1.0, f32::min);
                assert!(least >= expected - 1e-5, "{variant} {size_texels} at {elevation_deg}: {least}");
            }
        }
    }
    // Without a bias there is acne, so the test can fail.
    let stage = under_sun(ground_that_casts().build(), OBLIQUE_SUN);
    let shot = Shot::new(&stage, oblique_view(&stage));
    let bare = MapSettings { bias: Bias::NONE, ..sized(Variant::Compare, 128) };
    assert!(seen(&gpu, &shot, &stage.moment(0.5), bare).iter().any(|&v| v < 0.9));
}

#[test]
fn m2_a_wall_a_texel_thick_stands_on_its_shadow_and_lets_nothing_through() {
    let gpu = gpu();
    // Two posts far apart make the map as wide as the ground, and its texels as thick as the wall.
    let posts = || {
        ground()
            .block(Vec3::new(-5.9, 0.0, -5.9), Vec3::new(-5.8, 0.1, -5.8))
            .block(Vec3::new(5.8, 0.0, 5.8), Vec3::new(5.9, 0.1, 5.9))
    };
    let texel_m = 12.0 / 256.0;
    let wall = block(Vec3::new(-0.5 * texel_m, 0.0, -3.0), Vec3::new(0.5 * texel_m, 2.0, 3.0));
    // East of the wall, at noon of a low and of a high sun in the west.
    for height in [0.4, 1.0, 2.0] {
        let stage = under_sun(posts().soup(&wall).build(), DVec3::new(-1.0, height, 0.0));
        let moment = stage.moment(0.5);
        let shot = Shot::new(&stage, view(&stage, DVec3::new(3.0, 2.5, 0.4), DVec3::new(0.2, 0.0, 0.0), SIZE));
        for variant in UNTUNED.into_iter().filter(|v| MapSettings::new(*v).gathers()) {
            let seen = seen(&gpu, &shot, &moment, sized(variant, 256));
            let end_m = 2.0 / height;
            for (i, place) in surface_points(&shot) {
                let (from_foot_m, along) = (place.x - 0.5 * f64::from(texel_m), place.z.abs());
                // The filter's reach on the ground, which is longer along the light.
                let reach_m = 4.0 * f64::from(texel_m) * (1.0 + 1.0 / height);
                let is_in_shadow = place.y < 1e-3 && along < 3.0 - reach_m && from_foot_m < end_m - reach_m;
                // Mostly dark within a texel of the wall's foot, and fully dark from two texels on.
                let most = [1.0, 0.5, 0.01][((from_foot_m / f64::from(texel_m)) as usize).min(2)];
                assert!(
                    !is_in_shadow || f64::from(seen[i]) <= most,
                    "{variant}, sun {height}: {} at {place}, {from_foot_m} m from the foot",
                    seen[i]
                );
            }
        }
    }
}

#[test]
fn m3_a_caster_above_the_map_still_casts() {
    let gpu = gpu();
    // The roof is out of view, high above everything that is in view: maps of the view begin below it.
    let roof = block(Vec3::new(-6.0, 40.0, -6.0), Vec3::new(0.0, 41.0, 6.0));
    let scene = || ground().soup(&roof).block(Vec3::new(0.5, 0.0, -0.5), Vec3::new(1.5, 1.0, 0.5)).build();
    let stage = under_sun(scene(), DVec3::Y);
    let moment = stage.moment(0.5);
    let shot = Shot::new(&stage, oblique_view(&stage));
    for variant in Variant::ALL {
        let settings = sized(variant, 512);
        let unclamped = MapSettings {
            optimizations: MapOptimizations { depth_clamp: false, ..MapOptimizations::default() },
            ..settings
        };
        let [clamped, unclamped] = [settings, unclamped].map(|settings| seen(&gpu, &shot, &moment, settings));
        for (i, place) in surface_points(&shot) {
            if place.x < -0.3 && place.x > -5.5 && place.y < 1e-3 && place.z.abs() < 5.5 {
                assert!(
                    clamped[i] == 0.0 && unclamped[i] == 0.0,
                    "{variant} at {place}: {} {}",
                    clamped[i],
                    unclamped[i]
                );
            }
        }
        let differ = clamped.iter().zip(&unclamped).filter(|(a, b)| (*a - *b).abs() > 0.3).count();
        assert!(differ <= 4, "{variant}: {differ} pixels depend on depth clamp");
    }
}

#[test]
fn m4_receivers_outside_the_map_are_lit_and_borders_do_not_smear() {
    let gpu = gpu();
    let roof = block(Vec3::new(-1.0, 1.0, -1.0), Vec3::new(1.0, 1.2, 1.0));
    let stage = under_sun(ground().soup(&roof).build(), OBLIQUE_SUN);
    let moment = stage.moment(0.5);
    let shot = Shot::new(&stage, view(&stage, DVec3::new(4.1, 7.7, 5.3), DVec3::new(0.1, 0.0, -0.2), SIZE));
    for variant in Variant::ALL {
        let settings = sized(variant, 128);
        let mut maps = ShadowMaps::new(&gpu, &stage, settings).unwrap();
        let seen = maps.visibility(&shot, &moment).unwrap().pixels;
        let on_map = |p: DVec3| maps.renderer().maps().iter().any(|map| map.holds(p - stage.scene.centre_m, 0.0));
        let mut off_map = 0;
        // The roof lies within 1.2 m of the middle, and its shadow reaches as far again.
        for (i, place) in surface_points(&shot) {
            let away_m = place.x.abs().max(place.z.abs());
            if place.y < 1e-3 && away_m > 2.6 {
                assert_eq!(seen[i], 1.0, "{variant} at {place}");
                off_map += usize::from(!on_map(place));
            }
        }
        let fits_view = matches!(variant, Variant::Perspective | Variant::Cube | Variant::Cascades);
        assert!(fits_view || off_map > 1000, "{variant}: {off_map}");
    }
}

#[test]
fn m5_samplers_and_shaders_compare_alike_and_four_taps_mean_what_sixteen_do() {
    let gpu = gpu();
    let scene = || {
        ground_that_casts()
            .block(Vec3::new(-1.0, 0.0, -1.0), Vec3::new(0.5, 1.5, 0.7))
            .block(Vec3::new(1.0, 0.5, 0.2), Vec3::new(2.0, 0.9, 1.6))
            .build()
    };
    for towards in [OBLIQUE_SUN, DVec3::Y, DVec3::new(-0.9, 0.2, 0.3)] {
        let stage = under_sun(scene(), towards);
        let (shot, moment) = (Shot::new(&stage, oblique_view(&stage)), stage.moment(0.5));
        for bias in ["none", "texels:2", "slope", "normal,plane", "texels:0.5,plane"] {
            let bias: Bias = bias.parse().unwrap();
            let unfiltered = MapOptimizations { filtering: false, ..MapOptimizations::default() };
            let [plain, compare] = [Variant::Plain, Variant::Compare].map(|variant| {
                seen(&gpu, &shot, &moment, MapSettings { bias, optimizations: unfiltered, ..sized(variant, 200) })
            });
            let differ = plain.iter().zip(&compare).filter(|(a, b)| a != b).count();
            assert_eq!(differ, 0, "{bias} under {towards}");
        }
        let mean = |variant| {
            let seen = seen(&gpu, &shot, &moment, sized(variant, 200));
            seen.iter().map(|&v| f64::from(v)).sum::<f64>() / seen.len() as f64
        };
        let (sixteen, four) = (mean(Variant::Pcf16), mean(Variant::Pcf4));
        assert!((sixteen - four).abs() < 0.002, "{towards}: {sixteen} {four}");
    }
}

/// A long street of posts.
fn street() -> Scene {
    let mut builder = SceneBuilder::new()
        .soup(&floor(Vec2::new(-200.0, -20.0), Vec2::new(200.0, 20.0), 0.0))
        .block(Vec3::new(-190.0, -2.0, -10.0), Vec3::new(190.0, -1.0, 10.0));
    for i in 0..39u32 {
        let x = -190.0 + 10.0 * i as f32;
        builder = builder.block(Vec3::new(x, 0.0, -6.0), Vec3::new(x + 0.5, 3.0, -5.5));
    }
    builder.build()
}

#[test]
fn m6_cascades_show_no_line_where_they_meet_and_do_not_read_each_other() {
    let gpu = gpu();
    for cascades in [2, 3, 4] {
        let stage = under_sun(street(), DVec3::new(0.3, 0.5, -0.6));
        let moment = stage.moment(0.5);
        let along = view(&stage, DVec3::new(-199.0, 6.5, 0.5), DVec3::new(-150.0, 0.0, -4.0), SIZE);
        let settings = MapSettings { cascades, ..sized(Variant::Cascades, 512) };
        let mut maps = ShadowMaps::new(&gpu, &stage, settings).unwrap();
        let shot = Shot::new(&stage, along);
        let seen = maps.visibility(&shot, &moment).unwrap().pixels;
        assert_eq!(maps.renderer().maps().len(), cascades);
        // Between the street's edge and the posts' shadows all is lit, on every cascade and between them.
        let mut on_each = vec![0; cascades];
        for (i, place) in surface_points(&shot) {
            if place.y < 1e-3 && place.y > -1e-3 && place.z < -9.0 {
                assert_eq!(seen[i], 1.0, "{cascades} cascades at {place}");
                let held = maps.renderer().maps().iter().position(|m| m.holds(place - stage.scene.centre_m, 6.0));
                on_each[held.unwrap_or(cascades - 1)] += 1;
            }
        }
        assert!(on_each.iter().all(|&n| n > 2), "{on_each:?}");
        assert_no_defects(&gpu, "m6", &stage, along, settings);
        // Each is a layer of its own, so that no filter can reach from one into another.
        assert_eq!(maps.census().unwrap().shadow_maps, cascades);
    }
}

#[test]
fn m6_an_eye_beside_a_surface_in_shadow_sees_no_light() {
    let gpu = gpu();
    let roof = block(Vec3::new(-30.0, 3.0, -30.0), Vec3::new(30.0, 3.2, 30.0));
    let wide = floor(Vec2::splat(-40.0), Vec2::splat(40.0), 0.0);
    let stage = under_sun(SceneBuilder::new().soup(&wide).soup(&roof).build(), DVec3::new(0.1, 1.0, -0.2));
    let moment = stage.moment(0.5);
    for above_m in [0.001, 0.003, 0.05] {
        let eye = DVec3::new(0.3, above_m, 0.2);
        let shot = Shot::new(&stage, view(&stage, eye, eye + DVec3::new(1.0, -0.4, 0.3), SIZE));
        let seen = seen(&gpu, &shot, &moment, sized(Variant::Cascades, 1024));
        let dark = surface_points(&shot).into_iter().filter(|(_, p)| p.x.abs().max(p.z.abs()) < 28.0);
        let lit: Vec<_> = dark.filter(|(i, _)| seen[*i] > 0.0).collect();
        assert!(lit.is_empty(), "{above_m}: {} pixels are lit, the first at {}", lit.len(), lit[0].1);
    }
}

#[test]
fn m7_shadows_stay_where_they_are_as_the_camera_moves_and_turns() {
    let gpu = gpu();
    let stage = under_sun(street(), DVec3::new(0.3, 0.5, -0.6));
    let moment = stage.moment(0.5);
    let (eye, target) = (DVec3::new(-120.0, 2.5, 0.5), DVec3::new(-100.0, 0.0, 1.0));
    // Places on the street whose shadows are watched.
    let watched: Vec<DVec3> = (0..6000)
        .map(|i| DVec3::new(-114.0 + 0.01 * f64::from(i % 3000), 0.0, if i < 3000 { -2.0 } else { 0.7 }))
        .collect();
    let edge_px = 256;
    for variant in [Variant::Plain, Variant::Compare, Variant::Pcf16, Variant::Cascades, Variant::Perspective] {
        let mut maps = ShadowMaps::new(&gpu, &stage, sized(variant, 1024)).unwrap();
        let mut look = |eye: DVec3, target: DVec3| -> Vec<Option<f32>> {
            let camera = Camera::look_at(eye - stage.scene.centre_m, target - stage.scene.centre_m, 0.8).unwrap();
            let shot = Shot::new(&stage, View::new(&camera, [edge_px; 2], &stage.scene));
            let seen = maps.visibility(&shot, &moment).unwrap();
            let at = |p: &DVec3| {
                let ray = *p - stage.scene.centre_m - shot.view.eye_m.as_dvec3();
                let depth_m = ray.dot(shot.view.forward.as_dvec3());
                let [x, y] = shot.view.pixel_of(ray / depth_m).map(f64::floor);
                let inside = depth_m > 0.0 && x >= 0.0 && y >= 0.0 && x < f64::from(edge_px) && y < f64::from(edge_px);
                let pixel = inside.then(|| y as usize * edge_px as usize + x as usize)?;
                // Only where the street itself is seen.
                let hit = shot.hits()[pixel]?;
                ((hit.distance_m / ray.length()) - 1.0).abs().lt(&0.02).then(|| seen.pixels[pixel])
            };
            watched.iter().map(at).collect()
        };
        let here = look(eye, target);
        let mut worst: f64 = 0.0;
        for step in 1..6 {
            let by = f64::from(step);
            let there = look(eye + DVec3::new(0.003, 0.001, 0.002) * by, target + DVec3::new(0.0, 0.3, 0.5) * by);
            let pairs: Vec<f64> = here
                .iter()
                .zip(&there)
                .filter_map(|(a, b)| Some(f64::from((a.as_ref()? - b.as_ref()?).abs())))
                .collect();
            assert!(pairs.len() > 2500, "{}", pairs.len());
            worst = worst.max(pairs.iter().sum::<f64>() / pairs.len() as f64);
        }
        println!("m7 {variant}: worst mean change {worst:.4}");
        // A pixel covers an area: where an edge passes through it, hard visibility may change.
        let bound = if variant == Variant::Perspective { 0.06 } else { 0.035 };
        assert!(worst < bound, "{variant}: {worst}");
    }
}

#[test]
fn m8_views_from_a_millimetre_to_a_hundred_kilometres_are_finite() {
    let gpu = gpu();
    let scene = SceneBuilder::new()
        .soup(&floor(Vec2::splat(-5e4), Vec2::splat(5e4), 0.0))
        .block(Vec3::new(-0.5, 0.0, -0.5), Vec3::new(0.5, 1.0, 0.5))
        .block(Vec3::new(4e4, 0.0, 4e4), Vec3::new(4.1e4, 3e3, 4.1e4))
        .build();
    let stage = under_sun(scene, OBLIQUE_SUN);
    let close = view(&stage, DVec3::new(-2.6, 1.4, -1.9), DVec3::new(-0.8, 0.0, -0.5), SIZE);
    let ends = sunbake_runtime::shadow_maps::cascades::splits(1e-3, 1e5, 4);
    assert!(ends.windows(2).all(|pair| pair[0] < pair[1]) && ends.iter().all(|end| end.is_finite()));
    for variant in UNTUNED {
        let error = assert_no_defects(&gpu, "m8", &stage, close, sized(variant, 2048));
        // A map of the whole scene has texels of tens of metres. Variants that follow the view still find the block's
        // shadow.
        assert!(!variant.follows_view() || error < 0.02, "{variant}: {error}");
    }
}

#[test]
fn m9_a_wall_that_the_sun_grazes_has_no_stripes() {
    let gpu = gpu();
    // A house whose east wall the sun sees by a quarter of a degree, and a slab that shades part of that wall.
    let house = block(Vec3::new(-2.0, 0.0, -2.0), Vec3::new(2.0, 8.0, 2.0));
    let slab = block(Vec3::new(0.0, 0.0, 4.0), Vec3::new(5.0, 7.5, 4.5));
    let (sin, cos) = 0.25f64.to_radians().sin_cos();
    let (rise, south) = 60f64.to_radians().sin_cos();
    let stage = under_sun(ground().soup(&house).soup(&slab).build(), DVec3::new(sin, cos * rise, cos * south));
    let moment = stage.moment(0.5);
    let shot = Shot::new(&stage, view(&stage, DVec3::new(9.0, 5.0, -3.0), DVec3::new(2.0, 4.0, 0.0), SIZE));
    for variant in UNTUNED.into_iter().filter(|&variant| variant != Variant::Ground) {
        for size_texels in [128, 512] {
            let seen = seen(&gpu, &shot, &moment, sized(variant, size_texels));
            let (mut lit, mut shaded) = (0, 0);
            for (i, place) in surface_points(&shot).into_iter().filter(|(_, place)| (place.x - 2.0).abs() < 1e-3) {
                // The shadow ends here on the wall; filters reach less than a metre and a half on it.
                let end_m = 7.5 - (4.0 - place.z) * rise / south;
                let is_inside = place.z.abs() < 1.8 && (0.2..7.8).contains(&place.y);
                if is_inside && place.y > end_m + 1.5 {
                    lit += 1;
                    // A disc that touches the wall's plane is seen in part.
                    let least = if variant == Variant::Pcss { 0.5 } else { 0.999 };
                    assert!(seen[i] >= least, "{variant} {size_texels}: {} at {place}", seen[i]);
                } else if is_inside && place.y < end_m - 1.5 {
                    shaded += 1;
                    assert!(seen[i] <= 0.01, "{variant} {size_texels}: {} in shadow at {place}", seen[i]);
                }
            }
            assert!(lit > 500 && shaded > 20, "{lit} {shaded}");
        }
    }
}

#[test]
fn m10_a_low_sun_leaves_shadows_dark_beside_what_casts_them() {
    let gpu = gpu();
    // Something far towards the sun makes what may cast penumbras far away, and the search for it wide.
    let (rise, east) = 5f64.to_radians().sin_cos();
    let far = block(Vec3::new(150.0, 0.0, -0.5), Vec3::new(151.0, 4.0, 0.5));
    let scene = ground().block(Vec3::new(-0.5, 0.0, -0.5), Vec3::new(0.5, 2.0, 0.5)).soup(&far).build();
    let stage = under_sun(scene, DVec3::new(east, rise, 0.0));
    let moment = stage.moment(0.5);
    let shot = Shot::new(&stage, view(&stage, DVec3::new(-3.0, 2.5, 3.0), DVec3::new(-1.5, 0.0, 0.0), SIZE));
    for variant in UNTUNED.into_iter().filter(|&variant| variant != Variant::Ground) {
        let seen = seen(&gpu, &shot, &moment, sized(variant, 2048));
        let beside = |place: &DVec3| place.y.abs() < 1e-3 && place.z.abs() < 0.35 && (-3.0..-0.6).contains(&place.x);
        let shaded: Vec<_> = surface_points(&shot).into_iter().filter(|(_, place)| beside(place)).collect();
        assert!(shaded.len() > 300, "{}", shaded.len());
        for (i, place) in shaded {
            assert!(seen[i] <= 0.01, "{variant}: {} at {place}", seen[i]);
        }
    }
}
