//! Small sets on disk, and comparisons of them.

use crate::write_scene;
use glam::{DVec3, Vec2, Vec3};
use std::path::Path;
use sunbake::maps::Bits;
use sunbake::progress::Silent;
use sunbake::scene::Scene;
use sunbake::settings::{BakeSettings, SunRequest};
use sunbake::sun::DayRequest;
use sunbake::testing::{SceneBuilder, floor};
use sunbake_runtime::compare::{Comparison, Outcome, Playback, SetOnDisk, TechniqueSpec};
use sunbake_runtime::technique::Truth;
use sunbake_runtime::{Camera, Filter, Stage, View};

/// Ground, a row of posts that divide the day into many intervals, and a block, all shifted along x.
pub fn posts(shift_x_m: f32) -> Scene {
    let ground = floor(Vec2::splat(-4.0), Vec2::splat(4.0), 0.0);
    let post = |i: i32| {
        let x = i as f32 * 0.5 + shift_x_m;
        (Vec3::new(x - 0.09, 0.0, -0.6), Vec3::new(x + 0.09, 1.6, -0.42))
    };
    let builder = (-4..=4).map(post).fold(SceneBuilder::new().soup(&ground), |all, (min, max)| all.block(min, max));
    builder.block(Vec3::new(1.0 + shift_x_m, 0.0, 1.2), Vec3::new(2.0 + shift_x_m, 0.9, 2.0)).build()
}

/// Ground, and a fence whose pickets and gaps are 7 cm wide.
pub fn fence() -> Scene {
    let picket = |i: i32| {
        let x = -1.4 + 0.14 * i as f32;
        (Vec3::new(x, 0.0, -0.01), Vec3::new(x + 0.07, 1.0, 0.01))
    };
    let ground = SceneBuilder::new().soup(&floor(Vec2::splat(-4.0), Vec2::splat(4.0), 0.0));
    (0..20).map(picket).fold(ground, |all, (min, max)| all.block(min, max)).build()
}

/// A midsummer's day at 40 degrees north.
pub fn summer() -> SunRequest {
    let date = "2026-06-21".parse().expect("a date");
    SunRequest::Day(DayRequest::new(Some([40.0, 0.0]), Some(date)).expect("a place"))
}

/// Bakes a scene on a page of 256 texels into `folder/name`, without ambient light.
pub fn bake_into(folder: &Path, name: &str, scene: &Scene, edit: impl Fn(BakeSettings) -> BakeSettings) {
    let file = write_scene(scene, folder, &format!("{name}-source"));
    let settings =
        BakeSettings { page_size_texels: 256, layer_cap: 8, ambient: None, ..BakeSettings::standard(summer()) };
    sunbake::bake(&file, &folder.join(name), false, &edit(settings), &Silent).expect("a small scene bakes");
}

/// Playback with filtering, of a set with one lane.
pub const PLAYED: TechniqueSpec =
    TechniqueSpec::Baked(Playback { bits: Bits::Sixteen, lanes: 1, filter: Filter::Bilinear });

/// Compares techniques on the CPU, at three times of day through two cameras.
pub fn compared(set: &Path, techniques: &[TechniqueSpec], against: TechniqueSpec) -> Outcome {
    let stage = Stage::read(set).expect("a set").without_times();
    let look = |eye_m: DVec3| {
        let camera = Camera::look_at(eye_m - stage.scene.centre_m, -stage.scene.centre_m, 0.8).expect("two points");
        View::new(&camera, [160, 90], &stage.scene)
    };
    let views = [look(DVec3::new(4.0, 3.0, 5.0)), look(DVec3::new(-1.0, 1.5, 3.0))];
    let sets = [SetOnDisk::read(set).expect("a set")];
    let comparison = Comparison {
        sets: &sets,
        gpu: None,
        techniques,
        against,
        views: &views,
        times: &[0.3, 0.5, 0.7],
        map_size_texels: None,
        rounds: 1,
    };
    comparison.run(stage, &|| true).unwrap_or_else(|error| panic!("{error}"))
}

/// Rays over the sun's disc, few enough for a test.
pub const TRUE: TechniqueSpec = TechniqueSpec::Truth(Truth::Soft { rays: 16 });

/// The mean error of a set against truth.
pub fn mean_error(set: &Path) -> f64 {
    compared(set, &[PLAYED], TRUE).techniques[0].error.mean
}
