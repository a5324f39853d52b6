//! Hard case I7: random texels of real scenes, against brute force in `f64` with 65,536 suns a path.
//!
//! Nine texels a scene by default. `SUNBAKE_TEXELS=1000 tests/run scenes -E 'test(brute_force)' --no-capture` tries a
//! thousand, and prints a line a scene.

use libtest_mimic::Trial;
use std::path::Path;
use std::time::Instant;
use sunbake::atlas::{self, AtlasError, AtlasSettings, Density, SurfacePoint};
use sunbake::scene::{Alpha, LoadLimits, Material, Scene, load};
use sunbake::sun::SunPath;
use sunbake::visibility::lit_at;
use sunbake_tests::engines::{EXACT, FINDS_ALL};
use sunbake_tests::needs::{of_gas_station, of_scene};
use sunbake_tests::paths::{Random, day_at, keyed};
use sunbake_tests::{Agreement, Oracle, Traced, asked_for};

const SUNS: usize = 65_536;

/// Cities near and far from the origin, foliage, thin things, machines, doubled faces.
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

/// Makes outline hulls invisible: around littlest_tokyo one keeps all light out, and nothing is left to compare.
fn leave_out_hulls(scene: &mut Scene) {
    let is_hull = |material: &&mut Material| material.name.as_deref().is_some_and(|name| name.contains("outline"));
    scene.materials.iter_mut().filter(is_hull).for_each(|material| material.alpha = Alpha::Invisible);
}

/// Hard case I7.
fn random_texels_agree_with_brute_force(file: &Path) {
    let name = file.file_stem().unwrap_or_default().to_string_lossy();
    let mut scene = load(file, &LoadLimits::default()).unwrap_or_else(|error| panic!("{name}: {error}"));
    leave_out_hulls(&mut scene);
    let started = Instant::now();
    let found = compare(&Traced::new(scene), asked_for("SUNBAKE_TEXELS", 9));
    println!(
        "{name}: {} texels, {} k suns, {} edges; disagreement about {} suns beside an edge, {} elsewhere, {} \
         intervals; {:.1} s",
        found.points,
        found.suns >> 10,
        found.edges,
        found.beside_an_edge,
        found.elsewhere,
        found.missed,
        started.elapsed().as_secs_f64()
    );
    assert!(found.edges > 0, "there is nothing to compare: {found:?}");
    // An engine that is blind to short intervals is wrong where they are, and only there.
    assert!(!FINDS_ALL || (found.elsewhere, found.missed) == (0, 0), "{found:?}");
    assert!(found.furthest_t <= EXACT.blind_interval_t + 1.0 / SUNS as f64, "{found:?}");
}

pub fn trials() -> Vec<Trial> {
    let claim = "random_texels_agree_with_brute_force";
    let shared = SHARED.iter().map(|scene| of_scene(claim, scene, random_texels_agree_with_brute_force));
    shared.chain([of_gas_station(claim, random_texels_agree_with_brute_force)]).collect()
}
