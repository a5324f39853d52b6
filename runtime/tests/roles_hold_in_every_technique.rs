//! What casts no shadow and what takes none, in every technique.
//!
//! A ground with three boxes in a row: the first casts, light passes the second, and nothing shades the third, which
//! stands in the shadow of the first. These tests need an adapter, and fail without one.

use glam::{DVec3, Vec2, Vec3};
use sunbake::atlas::Density;
use sunbake::progress::Silent;
use sunbake::scene::Scene;
use sunbake::settings::{BakeSettings, SunRequest};
use sunbake::testing::{SceneBuilder, block, floor};
use sunbake::trace::Direction;
use sunbake_runtime::gpu::{Gpu, Output, VolumeSettings};
use sunbake_runtime::shadow_maps::{MapSettings, Variant};
use sunbake_runtime::technique::{BakedCpu, BakedGpu, ShadowMaps, Technique, Truth, Volumes};
use sunbake_runtime::testing::masks::gpu;
use sunbake_runtime::testing::view;
use sunbake_runtime::{Filter, Shot, Stage};

/// Instances in the order that they are added.
const GROUND: u32 = 0;
const CASTER: u32 = 1;
const PASSED: u32 = 2;
const OPEN: u32 = 3;

/// The sun stands in the south-west, low enough for the first box's shadow to cover the third.
const PATH: &str =
    r#"{"keys": [{"direction": [-0.8, 0.7, 0.1]}, {"direction": [-0.8, 0.7, 0.11]}], "duration_min": 10}"#;

fn scene() -> Scene {
    let stand =
        |x: f32, z: f32, width: f32, height: f32| block(Vec3::new(x, 0.0, z), Vec3::new(x + width, height, z + 1.0));
    let mut scene = SceneBuilder::new()
        .soup(&floor(Vec2::splat(-6.0), Vec2::splat(6.0), 0.0))
        .soup(&stand(-2.0, 0.0, 0.4, 3.0))
        .soup(&stand(-2.0, -3.0, 0.4, 3.0))
        .soup(&stand(-0.6, 0.2, 0.5, 0.6))
        .build();
    scene.instances[PASSED as usize].role.casts = false;
    scene.instances[OPEN as usize].role.receives = false;
    scene
}

fn stage() -> Stage {
    let sun = SunRequest::Keyed { json: PATH.into(), north_deg: 0.0 };
    let density = Density::TexelsPerMetre(24.0);
    let settings = BakeSettings { density, page_size_texels: 512, ambient: None, ..BakeSettings::standard(sun) };
    Stage::of_bake(sunbake::bake_scene(&scene(), &settings, &Silent).unwrap()).unwrap()
}

fn all<'a>(gpu: &'a Gpu, stage: &'a Stage) -> Vec<Box<dyn Technique + 'a>> {
    let maps = |variant| -> Box<dyn Technique> {
        let settings = MapSettings { size_texels: 1024, ..MapSettings::new(variant) };
        Box::new(ShadowMaps::new(gpu, stage, settings).unwrap())
    };
    vec![
        Box::new(Truth::Hard),
        Box::new(BakedCpu::new(stage, Filter::Bilinear)),
        Box::new(BakedGpu::new(gpu, stage, Filter::Bilinear).unwrap()),
        Box::new(Volumes::new(gpu, stage, VolumeSettings::default()).unwrap()),
        maps(Variant::Compare),
        maps(Variant::Cascades),
        maps(Variant::Ground),
        maps(Variant::Planar),
    ]
}

/// Pixels by what they show.
struct Pixels {
    /// Ground that only the box hides which light passes.
    behind_passed: Vec<usize>,
    /// Ground in the shadow of the first box.
    in_shadow: Vec<usize>,
    /// Sides of the third box that face the sun.
    on_open: Vec<usize>,
}

impl Pixels {
    fn of(shot: &Shot, sun: DVec3) -> Self {
        let stage = shot.stage;
        let mut pixels = Self { behind_passed: Vec::new(), in_shadow: Vec::new(), on_open: Vec::new() };
        for (pixel, hit) in shot.hits().iter().enumerate() {
            let Some(hit) = hit else { continue };
            let (triangle, point_m) =
                (hit.triangle as usize, stage.geometry.point(hit.triangle as usize, hit.barycentric));
            let normal = stage.geometry.normal(triangle);
            if normal.dot(sun) <= 0.1 {
                continue;
            }
            let origin_m = stage.eye_tracer().lift(point_m, normal, hit.triangle);
            let mut hides = [false; 4];
            stage.eye_tracer().for_each_hit(origin_m, &Direction::new(sun), |triangle, _| {
                hides[stage.geometry.instance[triangle as usize] as usize] = true;
            });
            match (stage.geometry.instance[triangle], hides) {
                (OPEN, _) => pixels.on_open.push(pixel),
                (GROUND, [_, true, _, _]) => pixels.in_shadow.push(pixel),
                (GROUND, [_, false, true, false]) => pixels.behind_passed.push(pixel),
                _ => {}
            }
        }
        pixels
    }
}

#[test]
fn light_passes_what_does_not_cast_and_nothing_shades_what_is_open() {
    let (gpu, stage) = (gpu(), stage());
    let shot = Shot::new(&stage, view(&stage, DVec3::new(3.0, 5.0, 6.0), DVec3::new(-0.5, 0.0, -0.5), [192, 192]));
    let moment = stage.moment(0.5);
    let pixels = Pixels::of(&shot, moment.sun_direction.as_dvec3());
    let counts = [&pixels.behind_passed, &pixels.in_shadow, &pixels.on_open].map(Vec::len);
    assert!(counts.iter().all(|&count| count > 100), "{counts:?}");
    let drawn = |instance: u32| {
        let is_it = |hit: &&sunbake::trace::Hit| stage.geometry.instance[hit.triangle as usize] == instance;
        shot.hits().iter().flatten().filter(is_it).count()
    };
    assert!([GROUND, CASTER, PASSED, OPEN].into_iter().all(|instance| drawn(instance) > 50), "all four are seen");
    for mut technique in all(&gpu, &stage) {
        let name = technique.name();
        let seen = technique.visibility(&shot, &moment).unwrap().pixels;
        let mean = |pixels: &[usize]| pixels.iter().map(|&pixel| seen[pixel]).sum::<f32>() / pixels.len() as f32;
        let [passed, shadow, open] = [&pixels.behind_passed, &pixels.in_shadow, &pixels.on_open].map(|p| mean(p));
        println!("{name}: {passed} behind what light passes, {shadow} in shadow, {open} on what nothing shades");
        // Edges of shadows are a texel or a pixel off.
        assert!(passed > 0.97 && shadow < 0.08, "{name}: {passed}, {shadow}");
        assert!(pixels.on_open.iter().all(|&pixel| seen[pixel] > 0.999), "{name}: {open} on what nothing shades");
    }
}

#[test]
fn no_more_is_built_than_planned() {
    let (gpu, stage) = (gpu(), stage());
    let shot = Shot::new(&stage, view(&stage, DVec3::new(3.0, 5.0, 6.0), DVec3::ZERO, [32, 32]));
    let moment = stage.moment(0.5);
    for mut technique in all(&gpu, &stage) {
        for output in [Output::Visibility, Output::Lit] {
            match output {
                Output::Visibility => drop(technique.visibility(&shot, &moment).unwrap()),
                _ => drop(technique.color(&shot, &moment).unwrap()),
            }
            let plan = technique.draw_plan(&shot, output);
            if let Some(census) = technique.census().filter(|_| plan.is_exact && output == Output::Visibility) {
                assert_eq!(census, plan.totals, "{}", technique.name());
            }
        }
    }
}

/// A set on disk says what casts and what receives.
#[test]
fn a_set_keeps_the_roles() {
    let folder = tempfile::tempdir().unwrap();
    let sun = SunRequest::Keyed { json: PATH.into(), north_deg: 0.0 };
    let settings = BakeSettings { page_size_texels: 128, ambient: None, ..BakeSettings::standard(sun) };
    let baked = sunbake::bake_scene(&scene(), &settings, &Silent).unwrap();
    baked.write(&folder.path().join("set"), false).unwrap();
    let stage = Stage::read(&folder.path().join("set")).unwrap();
    let roles: Vec<[bool; 2]> =
        (0..4).map(|instance| [stage.scene.casts(instance), stage.scene.receives(instance)]).collect();
    assert_eq!(roles, [[true, true], [true, true], [false, true], [true, false]]);
}
