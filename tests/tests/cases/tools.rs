//! Bakes of the cases, and what rows ask of them.

use std::path::PathBuf;
use sunbake::console::{Command, sentence};
use sunbake::progress::Silent;
use sunbake::scene::{LoadLimits, Scene, load};
use sunbake::settings::{BakeSettings, SunRequest};
use sunbake::{Bake, Warning};
use sunbake_runtime::Filter;
use sunbake_runtime::playback::Page;
use sunbake_runtime::stage::Stage;
use sunbake_tests::june_day;
use sunbake_tests::needs::workspace;

/// A file of a case.
pub fn file(name: &str) -> PathBuf {
    workspace().join("tests/cases").join(name)
}

/// The scene in a file of a case.
pub fn scene(name: &str) -> Scene {
    load(&file(name), &LoadLimits::default()).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// A day in June on a page of 256 texels, 16 bits, without the sky; `SceneOr` takes the file's own sun.
pub fn settings() -> BakeSettings {
    let sun = SunRequest::SceneOr(june_day());
    BakeSettings { page_size_texels: 256, ambient: None, threads: 1, ..BakeSettings::standard(sun) }
}

/// A bake in memory, and its warnings as the command prints them.
pub fn bake(scene: &Scene, settings: &BakeSettings) -> (Bake, Vec<String>) {
    let bake = sunbake::bake_scene(scene, settings, &Silent).unwrap_or_else(|error| panic!("{error}"));
    let warnings = sentences(&bake.warnings);
    (bake, warnings)
}

pub fn sentences(warnings: &[Warning]) -> Vec<String> {
    warnings.iter().map(|warning| sentence(warning, Command::Sunbake)).collect()
}

pub fn stage(scene: &Scene, settings: &BakeSettings) -> Stage {
    Stage::of_bake(bake(scene, settings).0).unwrap_or_else(|error| panic!("{error}"))
}

/// The name of an instance's node.
pub fn node(stage: &Stage, instance: usize) -> &str {
    stage.scene.nodes[stage.scene.instances[instance].node].name.as_deref().unwrap_or_default()
}

/// Mean visibility of the sun over the day, filtered, on triangles of one node that face upwards: over a lattice of
/// points inside each triangle, 24 times.
pub fn mean_light_on(stage: &Stage, name: &str) -> f64 {
    let path = stage.path.as_ref().expect("a sun");
    let pages: Vec<Page> =
        stage.pages.iter().map(|page| Page::new(page, stage.bits, path.angular_radius_rad)).collect();
    let moments: Vec<_> = (0..24).map(|k| stage.moment((f64::from(k) + 0.5) / 24.0)).collect();
    let (mut sum, mut count) = (0.0, 0usize);
    for triangle in 0..stage.geometry.triangles.len() {
        let instance = stage.geometry.instance[triangle] as usize;
        let normal = stage.geometry.normal(triangle).as_vec3();
        if node(stage, instance) != name || normal.y < 0.9 {
            continue;
        }
        let chart = stage.chart(instance).expect("it is drawn");
        let [a, b, c] = stage.corners(triangle).page_uv;
        for (i, j) in (0..40).flat_map(|i| (0..40 - i).map(move |j| (i, j))) {
            let [u, v] = [i, j].map(|k| (k as f32 + 1.0 / 3.0) / 40.0);
            let page_uv = a * (1.0 - u - v) + b * u + c * v;
            let page = &pages[chart.page as usize];
            for moment in &moments {
                sum += f64::from(page.sun_visibility(page_uv, normal, Filter::Bilinear, moment));
                count += 1;
            }
        }
    }
    assert!(count > 0, "nothing of {name} faces upwards");
    sum / count as f64
}

/// Fails with a text unless something holds.
pub fn must(holds: bool, text: impl FnOnce() -> String) -> Result<(), String> {
    if holds { Ok(()) } else { Err(text()) }
}
