//! Shadow maps against truth on real scenes: four times of day (twelve at full size), six cameras, two of them in
//! shadow.
//!
//! What each variant gets wrong may be a tenth more than what is written down, a line a measurement, in
//! `shadow_maps_match_truth.txt` or, at full size, in `shadow_maps_match_truth_full.txt`. A measurement without a
//! line fails; `BLESS=1` rewrites the lines. On our own scene the recommended variants have neither acne nor
//! leaks, whatever is written.

use crate::{is_full, june, times};
use libtest_mimic::Trial;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use sunbake::scene::{LoadLimits, load};
use sunbake_runtime::Stage;
use sunbake_runtime::compare::Defects;
use sunbake_runtime::shadow_maps::{MapSettings, Variant};
use sunbake_runtime::testing::maps::{ReferenceDay, defects_of};
use sunbake_runtime::testing::masks::gpu;
use sunbake_tests::needs::{of_gas_station, of_scene};

/// How much worse than written a figure may be.
const SLACK: f64 = 1.1;
/// Pixels that may come on top: adapters differ in a few.
const SLACK_PIXELS: f64 = 8.0;

fn written() -> PathBuf {
    let name = if is_full() { "shadow_maps_match_truth_full.txt" } else { "shadow_maps_match_truth.txt" };
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes").join(name)
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

fn errors_are_within_what_is_written(name: &str, scene: &Path, variants: &[Variant], sizes: &[u32]) {
    let gpu = gpu();
    let scene = load(scene, &LoadLimits { max_memory_bytes: 8 << 30 }).unwrap();
    let stage = Stage::plain(scene, Some(june()));
    let day = ReferenceDay::new(&stage, 64, times());
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

/// Variants that are recommended, for one thing or another, and soft.
const RECOMMENDED: [Variant; 4] = [Variant::Cascades, Variant::Pcf16, Variant::Pcf4, Variant::Pcss];

fn recommended_maps_have_neither_acne_nor_leaks(scene: &Path) {
    let gpu = gpu();
    let stage = Stage::plain(load(scene, &LoadLimits::default()).unwrap(), Some(june()));
    let day = ReferenceDay::new(&stage, 128, times());
    for variant in RECOMMENDED {
        let found = defects_of(&gpu, &day, MapSettings::new(variant), true).unwrap();
        println!("{variant}: {:.3} % wrong, mean error {:.5}", found.share_wrong() * 100.0, found.mean_error());
        assert_eq!((found.acne.len(), found.leaks.len()), (0, 0), "{variant}");
    }
}

pub fn trials() -> Vec<Trial> {
    const CITY: &[Variant] = &[Variant::Pcf16, Variant::Cascades, Variant::Perspective];
    let claim = "errors_of_shadow_maps_are_within_what_is_written";
    let of_shared = |scene: &str, variants: &'static [Variant], sizes: &'static [u32]| {
        of_scene(claim, scene, move |file| {
            let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            errors_are_within_what_is_written(&name, file, variants, sizes);
        })
    };
    vec![
        of_gas_station(
            "recommended_shadow_maps_have_neither_acne_nor_leaks",
            recommended_maps_have_neither_acne_nor_leaks,
        ),
        of_gas_station(claim, |file| {
            // Maps of 2048 are drawn slowly in software, and our scene has been measured with them above.
            let sizes: &[u32] = if is_full() { &[512, 2048] } else { &[512] };
            errors_are_within_what_is_written("ours", file, &Variant::ALL, sizes);
        }),
        of_shared("osrf_city/osrf_city.glb", CITY, &[2048]),
        of_shared("gazebo_thin/tower_crane.glb", &Variant::ALL, &[512, 2048]),
        of_shared("gazebo_thin/ladder_60deg_2rails.glb", &Variant::ALL, &[512, 2048]),
        of_shared("gazebo_thin/truss_bridge.glb", &Variant::ALL, &[512, 2048]),
    ]
}
