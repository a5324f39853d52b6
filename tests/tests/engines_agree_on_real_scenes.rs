//! Hard case I7: random texels of the shared scenes and of our own, against brute force in `f64` with 65,536 suns a path.
//!
//! A few texels a scene by default; `SUNBAKE_TEXELS=1000 tests/run -E 'test(real_scenes)' --no-capture` tries a thousand
//! and prints the table.

use std::path::{Path, PathBuf};
use std::time::Instant;
use sunbake::atlas::{self, AtlasError, AtlasSettings, Density, SurfacePoint};
use sunbake::scene::{LoadLimits, load};
use sunbake::sun::SunPath;
use sunbake::visibility::lit_at;
use sunbake_tests::engines::{EXACT, FINDS_ALL};
use sunbake_tests::paths::{Random, day_at, keyed};
use sunbake_tests::{Agreement, Oracle, Traced, asked_for, shared_scene};

const SUNS: usize = 65_536;

/// Shared scenes: cities near and far from the origin, foliage, thin things, machines, doubled faces.
const SHARED: [&str; 13] = [
    "osrf_city/osrf_city.glb",
    "littlest_tokyo/littlest_tokyo.glb",
    "two_cylinder_engine/2CylinderEngine.glb",
    "delft_3d/delft_node.glb",
    "delft_3d/delft_raw.glb",
    "truck_town/truck_town.glb",
    "japanese_bridge_garden/japanese_bridge_garden.glb",
    "gazebo_thin/oak_tree.glb",
    "gazebo_thin/pine_tree.glb",
    "gazebo_thin/tower_crane.glb",
    "gazebo_thin/playground.glb",
    "pc_house/house.glb",
    "mixed_lighting/MixedLightingExample.gltf",
];

/// An equinox, which takes several arcs; a solstice far north; keys.
fn paths() -> [SunPath; 3] {
    [day_at(40.0, "2026-03-20"), day_at(64.0, "2026-06-21"), keyed()]
}

/// Covered texels of the scene's atlas, drawn at random.
fn texels(here: &Traced, count: usize) -> Vec<SurfacePoint> {
    let mut size = 512;
    let atlas = loop {
        let settings = AtlasSettings { density: Density::Pages(1), page_size_texels: size, ..AtlasSettings::default() };
        match atlas::build(&here.scene, &settings, &|_| true) {
            Err(AtlasError::PageTooSmall { .. }) if size < 8192 => size *= 2,
            built => break built.expect("an atlas"),
        }
    };
    let samples = atlas::sample_page(&here.scene, &here.geometry, &atlas, 0).samples;
    let mut random = Random::new(count as u64);
    (0..count)
        .map(|_| atlas::surface_point(&here.scene, &here.geometry, &samples[random.index(samples.len())]))
        .collect()
}

fn compare(here: &Traced, count: usize) -> Agreement {
    let points = texels(here, count);
    let mut all = Agreement::default();
    for (path, points) in paths().iter().zip(points.chunks(count.div_ceil(3))) {
        let truth = Oracle::new(here, path, SUNS).lit_all(points);
        let engine = (EXACT.make)(&here.tracer, std::slice::from_ref(path));
        for (point, truth) in points.iter().zip(&truth) {
            all.add(&Agreement::of(&lit_at(engine.as_ref(), point)[0], truth));
        }
    }
    all
}

fn row(file: &Path, count: usize) -> Agreement {
    let name = file.file_stem().unwrap_or_default().to_string_lossy();
    let scene = load(file, &LoadLimits::default()).unwrap_or_else(|error| panic!("{name}: {error}"));
    let here = Traced::new(scene);
    let started = Instant::now();
    let found = compare(&here, count);
    println!(
        "{name:<24}{:>8}{:>10}{:>8}{:>16}{:>11}{:>8}{:>9.1} s",
        found.points,
        found.suns >> 10,
        found.edges,
        found.beside_an_edge,
        found.elsewhere,
        found.missed,
        started.elapsed().as_secs_f64()
    );
    found
}

#[test]
fn random_texels_of_real_scenes_agree_with_brute_force() {
    let count = asked_for("SUNBAKE_TEXELS", 9);
    println!("                          texels   k suns   edges  beside an edge  elsewhere  missed     time");
    let own = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../assets/gas_station.glb");
    let mut all = Agreement::default();
    for file in std::iter::once(own).chain(SHARED.iter().filter_map(|name| shared_scene(name))) {
        all.add(&row(&file, count));
    }
    assert!(all.edges >= 2 * count as u64, "there is hardly anything to compare: {all:?}");
    // An engine that is blind to short spells is wrong where they are, and only there.
    assert!(!FINDS_ALL || (all.elsewhere, all.missed) == (0, 0), "{all:?}");
    assert!(all.furthest_t <= EXACT.blind_t + 1.0 / SUNS as f64, "{all:?}");
}
