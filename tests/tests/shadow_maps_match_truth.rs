//! Shadow maps against truth on real scenes: twelve times of day, six cameras, two of them in shadow. Needs a GPU adapter, and
//! fails without one.
//!
//! What each variant gets wrong is held within a tenth of what is written down in `shadow_maps_match_truth.txt`, a line a
//! measurement. A measurement without a line fails; `BLESS=1` writes the lines anew. On our own scene the recommended variants have
//! neither acne nor leaks, whatever is written.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use sunbake::scene::{LoadLimits, load};
use sunbake::sun::{DayOutcome, SunPath, day};
use sunbake_runtime::Stage;
use sunbake_runtime::compare::Defects;
use sunbake_runtime::gpu::Gpu;
use sunbake_runtime::shadow_maps::{MapSettings, Variant};
use sunbake_runtime::testing::maps::{Day, defects_of};
use sunbake_tests::{june_day, shared_scene};

/// How much worse than written a figure may be.
const SLACK: f64 = 1.1;
/// Pixels that may come on top: adapters differ in a few.
const SLACK_PIXELS: f64 = 8.0;

fn written() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/shadow_maps_match_truth.txt")
}

/// What is written down of a scene: variant and size to wrong pixels, mean error, acne and leaks.
fn bounds_of(name: &str) -> BTreeMap<(String, u32), [f64; 4]> {
    let text = std::fs::read_to_string(written()).unwrap_or_default();
    let line = |line: &str| {
        let parts: Vec<&str> = line.split_whitespace().collect();
        let number = |i: usize| parts.get(i)?.parse::<f64>().ok();
        let figures = [number(3)?, number(4)?, number(5)?, number(6)?];
        (parts[0] == name).then_some(((parts[1].to_owned(), number(2)? as u32), figures))
    };
    text.lines().filter(|text| !text.starts_with('#')).filter_map(line).collect()
}

fn bless(name: &str, found: &[((String, u32), [f64; 4])]) {
    let text = std::fs::read_to_string(written()).unwrap_or_default();
    let mut lines: Vec<String> =
        text.lines().filter(|l| !l.starts_with(&format!("{name} "))).map(str::to_owned).collect();
    let line = |((variant, size), [wrong, error, acne, leaks]): &((String, u32), [f64; 4])| {
        format!("{name} {variant} {size} {wrong} {error:.6} {acne} {leaks}")
    };
    lines.extend(found.iter().map(line));
    std::fs::write(written(), lines.join("\n") + "\n").unwrap();
}

fn figures(found: &Defects) -> [f64; 4] {
    [found.wrong as f64, found.mean_error(), found.acne.len() as f64, found.leaks.len() as f64]
}

fn assert_within(name: &str, scene: &Path, variants: &[Variant], sizes: &[u32]) {
    let gpu = Gpu::open().expect("these tests need a GPU adapter: install mesa-vulkan-drivers");
    let scene = load(scene, &LoadLimits { max_memory_bytes: 8 << 30 }).unwrap();
    let stage = Stage::plain(scene, Some(june()));
    let day = Day::new(&stage, 64, (0..12).map(|i| (f64::from(i) + 0.5) / 12.0));
    let bounds = bounds_of(name);
    let mut all = Vec::new();
    for (&variant, &size_texels) in variants.iter().flat_map(|v| sizes.iter().map(move |s| (v, s))) {
        let settings = MapSettings { size_texels, ..MapSettings::new(variant) };
        let found = figures(&defects_of(&gpu, &day, settings, false).unwrap());
        let key = (variant.to_string(), size_texels);
        println!("{name} {variant} {size_texels}: wrong, mean error, acne, leaks {found:?}");
        if std::env::var_os("BLESS").is_none() {
            let bound =
                bounds.get(&key).unwrap_or_else(|| panic!("nothing is written of {name} {key:?}: run with BLESS=1"));
            let slack = [SLACK_PIXELS, 1e-4, SLACK_PIXELS, SLACK_PIXELS];
            let is_within = (0..4).all(|k| found[k] <= bound[k] * SLACK + slack[k]);
            assert!(is_within, "{name} {key:?}: {found:?} is more than {bound:?}");
        }
        all.push((key, found));
    }
    if std::env::var_os("BLESS").is_some() {
        bless(name, &all);
    }
}

fn june() -> SunPath {
    match day(&june_day()) {
        Ok(DayOutcome::Path(path)) => path,
        _ => panic!("the sun rises in June"),
    }
}

fn ours() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../assets/gas_station.glb")
}

fn shared(name: &str, variants: &[Variant], sizes: &[u32]) {
    if let Some(scene) = shared_scene(name) {
        let name = scene.file_stem().unwrap().to_string_lossy().into_owned();
        assert_within(&name, &scene, variants, sizes);
    }
}

/// Variants that are recommended, for one thing or another, and soft.
const RECOMMENDED: [Variant; 4] = [Variant::Cascades, Variant::Pcf16, Variant::Pcf4, Variant::Pcss];

#[test]
fn recommended_maps_of_our_gas_station_have_neither_acne_nor_leaks() {
    let gpu = Gpu::open().expect("these tests need a GPU adapter: install mesa-vulkan-drivers");
    let stage = Stage::plain(load(&ours(), &LoadLimits::default()).unwrap(), Some(june()));
    let day = Day::new(&stage, 128, (0..12).map(|i| (f64::from(i) + 0.5) / 12.0));
    for variant in RECOMMENDED {
        let found = defects_of(&gpu, &day, MapSettings::new(variant), true).unwrap();
        println!("{variant}: {:.3} % wrong, mean error {:.5}", found.share_wrong() * 100.0, found.mean_error());
        assert_eq!((found.acne.len(), found.leaks.len()), (0, 0), "{variant}");
    }
}

#[test]
fn maps_of_our_gas_station_err_no_more_than_is_written() {
    assert_within("ours", &ours(), &Variant::ALL, &[512, 2048]);
}

#[test]
fn maps_of_a_city_err_no_more_than_is_written() {
    shared("osrf_city/osrf_city.glb", &[Variant::Pcf16, Variant::Cascades, Variant::Perspective], &[2048]);
}

#[test]
fn maps_of_a_tower_crane_err_no_more_than_is_written() {
    shared("gazebo_thin/tower_crane.glb", &Variant::ALL, &[512, 2048]);
}

#[test]
fn maps_of_a_ladder_err_no_more_than_is_written() {
    shared("gazebo_thin/ladder_60deg_2rails.glb", &Variant::ALL, &[512, 2048]);
}

#[test]
fn maps_of_a_truss_bridge_err_no_more_than_is_written() {
    shared("gazebo_thin/truss_bridge.glb", &Variant::ALL, &[512, 2048]);
}
