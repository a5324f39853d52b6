//! Shadow volumes against hard truth on real scenes: twelve times of day, six cameras, two of them inside a volume. Needs a
//! GPU adapter, and fails without one.
//!
//! Outside a band of one pixel around truth's edges every pixel must be right. What rasterising cannot help is counted apart
//! and kept rare: see [`MaskAgreement`]. Leaves are solid here, since volumes do not see holes.

use std::path::{Path, PathBuf};
use sunbake::scene::{LoadLimits, load};
use sunbake::sun::{DayOutcome, SunPath, day};
use sunbake_runtime::compare::MaskAgreement;
use sunbake_runtime::gpu::{Gpu, VolumeSettings};
use sunbake_runtime::technique::{LightKind, Technique, Volumes};
use sunbake_runtime::testing::masks::{agreement, all_ways, camera_in_shadow, cameras_around, mask, with_solid_leaves};
use sunbake_runtime::volumes::{Mode, Savings};
use sunbake_runtime::{Camera, Moment, Shot, Stage, View};
use sunbake_tests::{june_day, shared_scene};

/// Share of pixels that may show another surface than a ray meets, or lie at an edge that no neighbour shows.
const FEW: f64 = 1e-4;
/// Share of the band that may be wrong: its pixels lie beside an edge, and few of them on it.
const FEW_IN_BAND: f64 = 0.01;

fn gpu() -> Gpu {
    Gpu::open().expect("these tests need a GPU adapter: install mesa-vulkan-drivers")
}

fn june() -> SunPath {
    match day(&june_day()) {
        Ok(DayOutcome::Path(path)) => path,
        _ => panic!("the sun rises in June"),
    }
}

fn stage(scene: &Path) -> Stage {
    let scene = load(scene, &LoadLimits { max_memory_bytes: 8 << 30 }).unwrap();
    Stage::plain(with_solid_leaves(scene), Some(june()))
}

fn times() -> impl Iterator<Item = f64> {
    (0..12).map(|i| (f64::from(i) + 0.5) / 12.0)
}

/// Four cameras around a stage, and two inside of volumes.
fn cameras(stage: &Stage, moment: &Moment) -> Vec<Camera> {
    let towards = moment.sun_direction.as_dvec3();
    let inside = [1, 2].map(|pick| camera_in_shadow(stage, towards, pick).expect("something is in shadow"));
    cameras_around(stage).into_iter().chain(inside).collect()
}

fn assert_right(name: &str, scene: &Path, edge_px: u32) {
    let (gpu, stage) = (gpu(), stage(scene));
    let mut volumes = Volumes::new(&gpu, &stage, VolumeSettings::default()).unwrap();
    let mut all = MaskAgreement::default();
    for t in times() {
        let moment = Moment::new(stage.path.as_ref(), t);
        for (index, camera) in cameras(&stage, &moment).iter().enumerate() {
            let shot = Shot::new(&stage, View::new(camera, [edge_px; 2], &stage.scene));
            let found = agreement(&mut volumes, &shot, &moment, LightKind::Sun);
            let at: Vec<_> = found.unexplained.iter().map(|i| (i % edge_px as usize, i / edge_px as usize)).collect();
            assert!(at.is_empty(), "{name} at {t:.3}, camera {index}: wrong at {at:?}");
            all.add(&found);
        }
    }
    println!("{name:14} {}", all.sentence());
    let excused = (all.at_fine_edges + all.of_other_surfaces) as f64 / all.pixels as f64;
    assert!(excused < FEW, "{name}: {excused}");
    assert!((all.wrong_in_band as f64) < FEW_IN_BAND * all.in_band as f64, "{name}: {all:?}");
}

/// All prisms of a city, at each frame anew, would take minutes.
fn is_quick(way: &VolumeSettings) -> bool {
    way.mode != Mode::Triangles || way.savings == Savings::default()
}

fn assert_all_ways_agree(name: &str, scene: &Path, edge_px: u32) {
    let (gpu, stage) = (gpu(), stage(scene));
    let mut ways: Vec<Volumes> =
        all_ways().into_iter().filter(is_quick).map(|way| Volumes::new(&gpu, &stage, way).unwrap()).collect();
    let mut compared = 0;
    for t in times().step_by(6) {
        let moment = Moment::new(stage.path.as_ref(), t);
        for (index, camera) in cameras(&stage, &moment).iter().enumerate().skip(3) {
            let shot = Shot::new(&stage, View::new(camera, [edge_px; 2], &stage.scene));
            let expected = mask(&mut ways[0], &shot, &moment, LightKind::Sun);
            for other in &mut ways[1..] {
                let found = mask(other, &shot, &moment, LightKind::Sun);
                let differ = found.pixels.iter().zip(&expected.pixels).filter(|(a, b)| a != b).count();
                assert_eq!(differ, 0, "{name} at {t:.3}, camera {index}, {}", other.name());
                compared += found.pixels.len();
            }
        }
    }
    println!("{name:14} {compared} pixels compared between ways of drawing them, none differ");
}

fn ours() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../assets/gas_station.glb")
}

fn shared(name: &str, edge_px: u32) {
    if let Some(scene) = shared_scene(name) {
        assert_right(name.rsplit('/').next().unwrap_or(name), &scene, edge_px);
        assert_all_ways_agree(name.rsplit('/').next().unwrap_or(name), &scene, edge_px / 2);
    }
}

#[test]
fn masks_of_our_gas_station_are_right() {
    assert_right("our station", &ours(), 192);
    assert_all_ways_agree("our station", &ours(), 128);
}

#[test]
fn masks_of_a_city_are_right() {
    shared("osrf_city/osrf_city.glb", 128);
}

#[test]
fn masks_of_a_tower_crane_are_right() {
    shared("gazebo_thin/tower_crane.glb", 192);
}

#[test]
fn masks_of_a_ladder_are_right() {
    shared("gazebo_thin/ladder_60deg_2rails.glb", 192);
}

#[test]
fn masks_of_an_engine_are_right() {
    shared("two_cylinder_engine/2CylinderEngine.glb", 192);
}
