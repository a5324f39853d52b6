//! B3, B4 and B17: the same scene elsewhere, at another size and on other numbers of threads bakes the same maps.

use crate::{courtyard, temporary};
use glam::{DMat4, DVec3};
use std::collections::BTreeMap;
use std::path::Path;
use sunbake::scene::Scene;
use sunbake::settings::BakeSettings;
use sunbake::testing::SceneBuilder;
use sunbake_tests::{bake_scene, quick, share_that_differs};

fn transformed(scene: &Scene, matrix: DMat4) -> Scene {
    let mut builder = SceneBuilder::new();
    for instance in &scene.instances {
        let world = DMat4::from_translation(scene.centre_m) * instance.bake_from_object;
        let mesh = scene.meshes[instance.mesh].clone();
        let material = scene.materials[mesh.material].clone();
        builder = builder.mesh_of(mesh, material, &[matrix * world]);
    }
    builder.build()
}

/// Every file of a set; of the manifest, what does not depend on the clock.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files = BTreeMap::new();
    for entry in std::fs::read_dir(folder).expect("a set") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        let mut bytes = std::fs::read(&path).expect("a file");
        if name == "sunbake.json" {
            let mut json: serde_json::Value = serde_json::from_slice(&bytes).expect("JSON");
            json["stats"]["seconds"] = serde_json::Value::Null;
            json["stats"]["threads"] = serde_json::Value::Null;
            bytes = json.to_string().into_bytes();
        }
        files.insert(name, bytes);
    }
    files
}

/// B17.
#[test]
fn the_same_bake_is_the_same_bytes_at_one_thread_and_two() {
    let folder = temporary();
    let scene = courtyard().build();
    let bake = |name: &str, threads| {
        bake_scene(&scene, &BakeSettings { threads, ..quick() }, folder.path(), "set");
        std::fs::rename(folder.path().join("set"), folder.path().join(name)).expect("to rename");
        files(&folder.path().join(name))
    };
    let one = bake("one", 1);
    assert!(one.len() >= 4, "{:?}", one.keys());
    assert_eq!(one, bake("two", 2));
    assert_eq!(one, bake("again", 2));
}

/// B3: under a node far away, whose translation an `f32` could not add, the scene bakes the same maps.
#[test]
fn a_scene_a_million_units_away_bakes_the_same_maps() {
    let folder = temporary();
    let near = bake_scene(&courtyard().build(), &quick(), folder.path(), "near");
    let away = DMat4::from_translation(DVec3::new(1e6 + 0.3, -4e5, 2.7e6));
    let far = bake_scene(&transformed(&courtyard().build(), away), &quick(), folder.path(), "far");
    let share = share_that_differs(&near, &far);
    assert!(share < 1e-3, "{share} of the texels differ");
    let centre = far.manifest.scene.centre_m;
    assert!((centre[0] - 1e6).abs() < 10.0 && (centre[2] - 2.7e6).abs() < 10.0, "{centre:?}");
}

/// B4.
#[test]
fn a_scene_of_another_size_bakes_the_same_maps() {
    let folder = temporary();
    let usual = bake_scene(&courtyard().build(), &quick(), folder.path(), "usual");
    for (name, scale) in [("tiny", 1e-4), ("huge", 1e4)] {
        let scaled = transformed(&courtyard().build(), DMat4::from_scale(DVec3::splat(scale)));
        let set = bake_scene(&scaled, &quick(), folder.path(), name);
        let share = share_that_differs(&usual, &set);
        assert!(share < 1e-3, "{name}: {share} of the texels differ");
    }
}
