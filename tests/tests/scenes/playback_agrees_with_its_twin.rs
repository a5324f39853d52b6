//! Playback on the GPU against its twin on the CPU, at four times of day (twelve at full size): 99.9 % of the pixels
//! differ by at most 1/255, and the rest lie at edges.

use crate::times;
use libtest_mimic::Trial;
use std::path::Path;
use sunbake::ambient::AmbientSettings;
use sunbake::progress::Silent;
use sunbake::settings::{AmbientRequest, BakeSettings, EngineChoice, SunRequest};
use sunbake_runtime::technique::{BakedCpu, BakedGpu};
use sunbake_runtime::testing::{masks::gpu, table_line, twins};
use sunbake_runtime::{Camera, Filter, Shot, Stage, View};
use sunbake_tests::june_day;
use sunbake_tests::needs::{of_gas_station, of_scene};

const SIZE: [u32; 2] = [256, 144];

/// A bake that is quick and has something of everything: what agreement needs is maps, not good ones.
fn settings(page_size_texels: u32) -> BakeSettings {
    BakeSettings {
        page_size_texels,
        padding_texels: 1,
        engine: EngineChoice::Rays(16),
        ambient: Some(ambient()),
        ..BakeSettings::standard(SunRequest::Day(june_day()))
    }
}

fn ambient() -> AmbientRequest {
    let request = AmbientRequest::with_rays(16);
    AmbientRequest { estimate: AmbientSettings { wants_sky: true, ..request.estimate }, ..request }
}

fn twins_agree(scene: &Path, page_size_texels: u32) {
    let gpu = gpu();
    let folder = tempfile::tempdir().unwrap();
    let set = folder.path().join("set");
    sunbake::bake(scene, &set, false, &settings(page_size_texels), &Silent).unwrap_or_else(|error| panic!("{error}"));
    let stage = Stage::read(&set).unwrap();
    let camera = Camera::default_of(&stage, f64::from(SIZE[0]) / f64::from(SIZE[1]));
    let shot = Shot::new(&stage, View::new(&camera, SIZE, &stage.scene));
    let mut on_gpu = BakedGpu::new(&gpu, &stage, Filter::Bilinear).unwrap();
    let mut on_cpu = BakedCpu::new(&stage, Filter::Bilinear);
    let name = scene.file_stem().unwrap_or_default().to_string_lossy();
    for t in times() {
        for (what, found) in twins(&mut on_gpu, &mut on_cpu, &shot, t).unwrap() {
            println!("{}", table_line(&name, t, what, &found));
            assert!(found.share_within() >= 0.999 && found.unexplained == 0, "at {t}, {what}: {found:?}");
        }
    }
}

/// Scenes, with the edge of a page in texels that they need: a model railway's town, a truck and its town, a garden
/// bridge, a city with leaves.
const SHARED: [(&str, u32); 4] = [
    ("littlest_tokyo/littlest_tokyo.glb", 1024),
    ("truck_town/truck_town.glb", 512),
    ("japanese_bridge_garden/japanese_bridge_garden.glb", 512),
    ("osrf_city/osrf_city.glb", 512),
];

pub fn trials() -> Vec<Trial> {
    let claim = "playback_agrees_with_its_twin";
    let shared = SHARED.map(|(scene, page)| of_scene(claim, scene, move |file| twins_agree(file, page)));
    shared.into_iter().chain([of_gas_station(claim, |file| twins_agree(file, 512))]).collect()
}
