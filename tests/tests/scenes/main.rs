//! What must hold of real scenes: our own, and those of the shared folder. One test a claim and scene.
//!
//! The harness is not the usual one: a scene that is not on this machine is listed as ignored, and counted as skipped.
//! `SUNBAKE_FULL=1` tests at full size. Drawing needs a GPU adapter, and fails without one.

mod atlases_are_sound;
mod bakes_do_not_speckle;
mod engines_agree_with_brute_force;
mod files_bake_or_are_refused;
mod files_load_or_are_refused;
mod playback_agrees_with_its_twin;
mod shadow_maps_match_truth;
mod volumes_match_truth;

use sunbake::sun::{DayOutcome, SunPath, day};

fn main() {
    let trials = [
        atlases_are_sound::trials(),
        bakes_do_not_speckle::trials(),
        engines_agree_with_brute_force::trials(),
        files_bake_or_are_refused::trials(),
        files_load_or_are_refused::trials(),
        playback_agrees_with_its_twin::trials(),
        shadow_maps_match_truth::trials(),
        volumes_match_truth::trials(),
    ];
    libtest_mimic::run(&libtest_mimic::Arguments::from_args(), trials.into_iter().flatten().collect()).exit();
}

/// Midsummer at 40 degrees north.
fn june() -> SunPath {
    match day(&sunbake_tests::june_day()) {
        Ok(DayOutcome::Path(path)) => path,
        _ => panic!("the sun rises in June"),
    }
}

/// Whether tests run at full size, as figures in documents were measured.
fn is_full() -> bool {
    sunbake_tests::needs::is_set("SUNBAKE_FULL")
}

/// Evenly spaced times of the day: 12 at full size, else 4 of the same 12.
fn times() -> impl Iterator<Item = f64> {
    let count = if is_full() { 12 } else { 4 };
    (0..count).map(move |i| (f64::from(i) + 0.5) / f64::from(count))
}

/// Every .glb and .gltf file below a folder, in the order of their paths.
fn scene_files(folder: &std::path::Path) -> Vec<std::path::PathBuf> {
    let (mut found, mut folders) = (Vec::new(), vec![folder.to_owned()]);
    while let Some(folder) = folders.pop() {
        for path in std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()) {
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "glb" || e == "gltf") {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}
