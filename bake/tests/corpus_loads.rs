//! Every file of the Khronos validator's test corpus, and every shared scene, goes through `load` without a panic; and
//! what loads is written as `scene.glb` and read back as the same scene.
//!
//! The files are not part of the repository. They are looked for in `$SUNBAKE_SHARED`, else beside the workspace. With
//! `$SUNBAKE_KEEP_GLB` set to a folder, the written files stay there, for the Khronos validator to look at.

use glam::Vec2;
use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
    time::Instant,
};
use sunbake::{
    atlas::{Layout, LayoutOrigin},
    glb::write_glb,
    scene::{LoadError, LoadLimits, Mesh, Scene, load},
};

fn shared(folder: &str) -> Option<PathBuf> {
    let root = std::env::var_os("SUNBAKE_SHARED")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared"), PathBuf::from);
    let folder = root.join(folder);
    if !folder.is_dir() {
        eprintln!("skipped: shared scenes absent ({} is no folder; set SUNBAKE_SHARED)", folder.display());
        return None;
    }
    Some(folder)
}

fn scene_files(folder: &Path, found: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> =
        std::fs::read_dir(folder).expect("readable").map(|e| e.expect("entry").path()).collect();
    entries.sort();
    for path in entries {
        if path.is_dir() {
            scene_files(&path, found);
        } else if path.extension().is_some_and(|e| e == "gltf" || e == "glb") {
            found.push(path);
        }
    }
}

/// A layout that splits nothing.
fn plain_layout(mesh: &Mesh) -> Layout {
    let count = mesh.positions.len() as u32;
    let uvs = (0..count).map(|i| Vec2::new(i as f32 / count as f32, 0.25)).collect();
    Layout { origin: LayoutOrigin::Unwrapped, vertices: (0..count).collect(), uvs, indices: mesh.indices.clone() }
}

fn rewrite(scene: &Scene, name: &str) -> Scene {
    let layouts: Vec<Layout> = scene.meshes.iter().map(plain_layout).collect();
    let written = write_glb(scene, &layouts, None).expect("small");
    let folder = tempfile::tempdir().expect("folder");
    let kept = std::env::var_os("SUNBAKE_KEEP_GLB").map(PathBuf::from);
    let path = kept.as_deref().unwrap_or(folder.path()).join(format!("{name}.glb"));
    std::fs::write(&path, &written.bytes).expect("written");
    let again = load(&path, &LoadLimits::default()).unwrap_or_else(|error| panic!("{name}: {error}"));
    let places: Vec<(usize, usize)> = again.instances.iter().map(|i| (i.node, again.meshes[i.mesh].gltf.1)).collect();
    assert_eq!(places, written.places, "{name}");
    again
}

fn assert_same(scene: &Scene, again: &Scene, name: &str) {
    assert_eq!(scene.nodes.len(), again.nodes.len(), "{name}");
    assert_eq!(scene.meshes.len(), again.meshes.len(), "{name}");
    assert_eq!(scene.centre_m, again.centre_m, "{name}");
    for (a, b) in scene.instances.iter().zip(&again.instances) {
        assert_eq!((a.node, a.mesh, a.bake_from_object), (b.node, b.mesh, b.bake_from_object), "{name}");
    }
    for (a, b) in scene.meshes.iter().zip(&again.meshes) {
        assert_eq!((&a.positions, &a.indices, &a.colors), (&b.positions, &b.indices, &b.colors), "{name}");
        assert_eq!(b.texcoords[1].as_ref(), Some(&plain_layout(a).uvs), "{name}");
    }
    for (a, b) in scene.materials.iter().zip(&again.materials) {
        assert_eq!((a.alpha, a.base_color, &a.name), (b.alpha, b.base_color, &b.name), "{name}");
    }
}

fn kind(error: &LoadError) -> String {
    let debug = format!("{error:?}");
    debug.split([' ', '{', '(']).next().unwrap_or_default().to_owned()
}

#[test]
fn every_file_of_the_validator_corpus_loads_or_is_refused() {
    let Some(folder) = shared("corpora/gltf_validator_test") else { return };
    let mut files = Vec::new();
    scene_files(&folder, &mut files);
    let mut table: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for path in &files {
        let name = path.strip_prefix(&folder).expect("inside").display().to_string();
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
const CORPUS: [(&str, usize); 9] = [
    ("Extension", 1),
    ("Json", 4),
    ("NoTriangles", 335),
    ("NodeCycle", 2),
    ("NotGltf", 7),
    ("Outside", 2),
    ("Structure", 6),
    ("Truncated", 10),
    ("Version", 5),
];

#[test]
fn every_shared_scene_loads_or_is_refused_by_name_and_comes_back_from_its_scene_glb() {
    let Some(folder) = shared("scenes") else { return };
    let mut files = Vec::new();
    scene_files(&folder, &mut files);
    for path in &files {
        let name = path.strip_prefix(&folder).expect("inside").display().to_string();
        let start = Instant::now();
        match load(path, &LoadLimits::default()) {
            Ok(scene) => {
                let seconds = start.elapsed().as_secs_f64();
                println!(
                    "{name}: {} triangles, {} meshes, {} instances, {} materials, {} images, {:?}, {seconds:.2} s, size {} at {}",
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
