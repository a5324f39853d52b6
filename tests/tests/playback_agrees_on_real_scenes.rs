//! Playback on the GPU against its twin on the CPU: five scenes, eight times of day, 1/255 on 99.9 % of pixels, and the rest
//! at edges. Needs a GPU adapter, and fails without one.

use std::path::{Path, PathBuf};
use sunbake::ambient::AmbientSettings;
use sunbake::progress::Silent;
use sunbake::settings::{AmbientRequest, BakeSettings, EngineChoice, SunRequest};
use sunbake_runtime::gpu::Gpu;
use sunbake_runtime::technique::{BakedCpu, BakedGpu};
use sunbake_runtime::testing::{table_line, twins};
use sunbake_runtime::{Camera, Filter, Shot, Stage, View};
use sunbake_tests::{june_day, shared_scene};

const SIZE: [u32; 2] = [256, 144];

/// A bake that is quick and has something of everything: what agreement needs is maps, not good ones.
fn settings(page_size_texels: u32) -> BakeSettings {
    BakeSettings {
        page_size_texels,
        engine: EngineChoice::Rays(16),
        ambient: Some(ambient()),
        ..BakeSettings::standard(SunRequest::Day(june_day()))
    }
}

fn ambient() -> AmbientRequest {
    let request = AmbientRequest::with_rays(16);
    AmbientRequest { estimate: AmbientSettings { wants_sky: true, ..request.estimate }, ..request }
}

fn assert_twins_agree_on(name: &str, scene: &Path, page_size_texels: u32) {
    let gpu = Gpu::open().expect("these tests need a GPU adapter: install mesa-vulkan-drivers");
    let folder = tempfile::tempdir().unwrap();
    let set = folder.path().join("set");
    sunbake::bake(scene, &set, false, &settings(page_size_texels), &Silent)
        .unwrap_or_else(|error| panic!("{name}: {error}"));
    let stage = Stage::read(&set).unwrap();
    let camera = Camera::default_of(&stage, f64::from(SIZE[0]) / f64::from(SIZE[1]));
    let shot = Shot::new(&stage, View::new(&camera, SIZE, &stage.scene));
    let mut on_gpu = BakedGpu::new(&gpu, &stage, Filter::Bilinear).unwrap();
    let mut on_cpu = BakedCpu::new(&stage, Filter::Bilinear);
    for t in (0..8).map(|i| (f64::from(i) + 0.5) / 8.0) {
        for (what, found) in twins(&mut on_gpu, &mut on_cpu, &shot, t).unwrap() {
            println!("{}", table_line(name, t, what, &found));
            assert!(found.share_within() >= 0.999 && found.unexplained == 0, "{name} at {t}, {what}: {found:?}");
        }
    }
}

fn shared(name: &str, page_size_texels: u32) {
    if let Some(scene) = shared_scene(name) {
        assert_twins_agree_on(name, &scene, page_size_texels);
    }
}

#[test]
fn twins_agree_on_our_gas_station() {
    let scene = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../assets/gas_station.glb");
    assert_twins_agree_on("our gas station", &scene, 512);
}

#[test]
fn twins_agree_on_a_model_railway_town() {
    shared("littlest_tokyo/littlest_tokyo.glb", 2048);
}

#[test]
fn twins_agree_on_a_truck_and_its_town() {
    shared("truck_town/truck_town.glb", 512);
}

#[test]
fn twins_agree_on_a_garden_bridge() {
    shared("japanese_bridge_garden/japanese_bridge_garden.glb", 512);
}

#[test]
fn twins_agree_on_a_city_with_leaves() {
    shared("osrf_city/osrf_city.glb", 1024);
}
