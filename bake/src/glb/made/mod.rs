//! A glTF file of a scene that was made by code: nodes, meshes, materials, images and cameras, as the scene has them.

mod binary;
mod materials;
mod meshes;
mod nodes;

pub(super) use nodes::transform;

use super::meshes::FilePlaces;
use crate::scene::{Scene, SceneFile};
use binary::Binary;
use materials::MadeMaterials;
use meshes::Groups;
use serde_json::{Map, Value, json};

const GENERATOR: &str = concat!("sunbake ", env!("CARGO_PKG_VERSION"));

/// The file of a scene, and where the scene's parts are in it.
pub(super) fn file_of(scene: &Scene) -> (SceneFile, FilePlaces) {
    let mut binary = Binary::default();
    let groups = Groups::new(scene);
    let MadeMaterials { materials, textures, samplers, images, extensions } = materials::write(scene, &mut binary);
    let meshes = meshes::write(scene, &groups, &mut binary);
    let mut root = Map::new();
    root.insert("asset".into(), json!({ "version": "2.0", "generator": GENERATOR }));
    root.insert("scene".into(), json!(0));
    root.insert("scenes".into(), json!([{ "nodes": nodes::roots(scene) }]));
    let lists = [
        ("nodes", nodes::write(scene, &groups)),
        ("cameras", nodes::cameras(scene)),
        ("meshes", meshes),
        ("materials", materials),
        ("textures", textures),
        ("samplers", samplers),
        ("images", images),
        ("extensionsUsed", extensions),
        ("accessors", binary.accessors),
        ("bufferViews", binary.views),
        ("buffers", vec![json!({ "byteLength": binary.bytes.len() })]),
    ];
    root.extend(lists.into_iter().filter(|(_, list)| !list.is_empty()).map(|(name, list)| (name.into(), list.into())));
    let at = FilePlaces { nodes: (0..scene.nodes.len()).collect(), primitives: groups.primitives_of_instances };
    (SceneFile::made(Value::from(root), binary.bytes), at)
}
