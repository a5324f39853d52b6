//! Every file of the Khronos validator's test corpus, and every shared scene, is loaded without a panic; and what
//! loads is written as `scene.glb` and read back as the same scene.
//!
//! With `SUNBAKE_KEEP_GLB` set to a folder, the written files stay there, for the Khronos validator to look at.

use crate::scene_files;
use glam::Vec2;
use libtest_mimic::Trial;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Instant;
use sunbake::atlas::{Layout, LayoutOrigin};
use sunbake::glb::write_glb;
use sunbake::scene::{Alpha, Instance, LoadError, LoadLimits, Mesh, Scene, load};
use sunbake_tests::needs::{Need, shared, trial};

/// A layout that splits nothing.
fn plain_layout(mesh: &Mesh) -> Layout {
    let count = mesh.positions.len() as u32;
    let uvs = (0..count).map(|i| Vec2::new(i as f32 / count as f32, 0.25)).collect();
    Layout { origin: LayoutOrigin::Unwrapped, vertices: (0..count).collect(), uvs, indices: mesh.indices.clone() }
}

/// A scene written and read again; and for each mesh, the set of its new coordinates.
fn rewrite(scene: &Scene, name: &str) -> (Scene, Vec<usize>) {
    let layouts: Vec<Layout> = scene.meshes.iter().map(plain_layout).collect();
    let written = write_glb(scene, &layouts, None).expect("small");
    let folder = tempfile::tempdir().expect("folder");
    let kept = std::env::var_os("SUNBAKE_KEEP_GLB").map(PathBuf::from);
    let path = kept.as_deref().unwrap_or(folder.path()).join(format!("{name}.glb"));
    std::fs::write(&path, &written.bytes).expect("written");
    let again = load(&path, &LoadLimits::default()).unwrap_or_else(|error| panic!("{name}: {error}"));
    let place = |i: &Instance| (again.nodes[i.node].gltf, again.meshes[i.mesh].gltf.1);
    let found: Vec<(usize, usize)> = again.instances.iter().map(place).collect();
    let said: Vec<(usize, usize)> = written.places.iter().map(|place| (place.node, place.primitive)).collect();
    assert_eq!(found, said, "{name}");
    let mut sets = vec![1; again.meshes.len()];
    for (instance, place) in again.instances.iter().zip(&written.places) {
        sets[instance.mesh] = place.uv_set as usize;
    }
    (again, sets)
}

fn assert_same(scene: &Scene, (again, sets): &(Scene, Vec<usize>), name: &str) {
    assert_eq!(scene.nodes.len(), again.nodes.len(), "{name}");
    assert_eq!(scene.meshes.len(), again.meshes.len(), "{name}");
    assert_eq!(scene.centre_m, again.centre_m, "{name}");
    for (a, b) in scene.instances.iter().zip(&again.instances) {
        assert_eq!((a.node, a.mesh, a.bake_from_object), (b.node, b.mesh, b.bake_from_object), "{name}");
    }
    for ((a, b), &set) in scene.meshes.iter().zip(&again.meshes).zip(sets) {
        assert_eq!((&a.positions, &a.indices, &a.colors), (&b.positions, &b.indices, &b.colors), "{name}");
        // What takes no shadow has no coordinates: what is not drawn, and glass.
        let material = &scene.materials[a.material];
        let takes_shadows = material.alpha != Alpha::Invisible && !material.is_clear;
        assert!(!takes_shadows || b.texcoord_set(set) == Some(&plain_layout(a).uvs), "{name}");
    }
    for (a, b) in scene.materials.iter().zip(&again.materials) {
        assert_eq!((a.alpha, a.base_color, &a.name), (b.alpha, b.base_color, &b.name), "{name}");
    }
}

fn kind(error: &LoadError) -> String {
    let debug = format!("{error:?}");
    debug.split([' ', '{', '(']).next().unwrap_or_default().to_owned()
}

fn validator_files_load_or_are_refused(folder: &Path) {
    let files = scene_files(folder);
    let mut table: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for path in &files {
        let name = path.strip_prefix(folder).expect("inside").display().to_string();
        let outcome = match load(path, &LoadLimits::default()) {
            Ok(scene) => {
                assert_same(&scene, &rewrite(&scene, &name.replace('/', "_")), &name);
                "loaded".to_owned()
            }
            Err(error) => {
                println!("{name}: {error}");
                kind(&error)
            }
        };
        table.entry(outcome).or_default().push(name);
    }
    println!("{} files", files.len());
    for (outcome, names) in &table {
        println!("{:5} {outcome:12} for example {}", names.len(), names[0]);
    }
    let counts: Vec<(&str, usize)> = table.iter().map(|(outcome, names)| (outcome.as_str(), names.len())).collect();
    assert_eq!(counts, CORPUS, "what the corpus does has changed: if that is right, change the table");
}

/// What the 372 files do. Most of them are about something other than a drawn triangle, and draw none.
const CORPUS: [(&str, usize); 8] = [
    ("Extension", 1),
    ("Json", 4),
    ("NoTriangles", 337),
    ("NodeCycle", 2),
    ("NotGltf", 7),
    ("Structure", 6),
    ("Truncated", 10),
    ("Version", 5),
];

fn shared_scenes_load_or_are_refused(folder: &Path) {
    for path in &scene_files(folder) {
        let name = path.strip_prefix(folder).expect("inside").display().to_string();
        let start = Instant::now();
        match load(path, &LoadLimits::default()) {
            Ok(scene) => {
                let seconds = start.elapsed().as_secs_f64();
                println!(
                    "{name}: {} triangles, {} meshes, {} instances, {} materials, {} images, {:?}, {seconds:.2} s, \
                     size {} at {}",
                    scene.triangle_count(),
                    scene.meshes.len(),
                    scene.instances.len(),
                    scene.materials.len(),
                    scene.images.len(),
                    scene.dropped,
                    scene.half_extent_m * 2.0,
                    scene.centre_m,
                );
                scene.warnings.iter().for_each(|warning| println!("    {warning}"));
                assert_same(&scene, &rewrite(&scene, &name.replace('/', "_")), &name);
            }
            Err(error) => println!("{name}: {error}"),
        }
    }
}

pub fn trials() -> Vec<Trial> {
    let of_folder = |name: &str, folder: &str, test: fn(&Path)| {
        let path = shared(folder);
        trial(name, vec![Need::shared(folder)], move || test(&path))
    };
    vec![
        of_folder(
            "validator_files_load_or_are_refused",
            "corpora/gltf_validator_test",
            validator_files_load_or_are_refused,
        ),
        of_folder("shared_scenes_load_or_are_refused", "scenes", shared_scenes_load_or_are_refused),
    ]
}
