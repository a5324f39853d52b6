//! Writes `scene.glb`: the scene for any glTF viewer, with the bake's own texture coordinates.
//!
//! The file keeps everything of its source that sunbake reads: the hierarchy with names and full-precision matrices,
//! meshes with unchanged vertices, base colours with their images' original bytes, cameras. It adds `TEXCOORD_1`, the
//! layout of each mesh; vertices on chart borders are duplicated. `TEXCOORD_0` is the set that the base colour uses,
//! since viewers expect sets to be numbered from 0 without gaps.
//!
//! The same scene gives the same bytes. Reading the file back gives the same nodes, instances and triangles in the same
//! order.
//!
//! Based on: Khronos Group, *glTF 2.0 Specification*.

mod binary;
mod materials;
mod meshes;
mod nodes;
mod occlusion;

pub use occlusion::{Occlusion, OcclusionPage};

use crate::{atlas::Layout, scene::Scene, settings::VertexAttribute};
use binary::Binary;
use materials::WrittenMaterials;
use meshes::{Groups, PerInstance};
use serde_json::{Map, Value, json};

/// A scene as a GLB file, and where its instances are in it.
#[derive(Debug, Clone)]
pub struct WrittenScene {
    /// Content of the file.
    pub bytes: Vec<u8>,
    /// For each of [`Scene::instances`], its node and the index of its primitive in that node's mesh.
    pub primitives_of_instances: Vec<(usize, usize)>,
    /// Whether `TEXCOORD_1` holds page coordinates instead of layout coordinates.
    pub has_page_uvs: bool,
}

/// The scene is too large for GLB's 32-bit lengths.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("scene.glb would have {bytes} bytes, and the format ends at 4294967295; bake the scene in parts")]
pub struct GlbTooLarge {
    /// Size that the file would have.
    pub bytes: u64,
}

/// Writes a scene with its layouts, one per [`Scene::meshes`], and with occlusion textures, if given.
///
/// # Errors
///
/// If the file would have 4 GiB or more.
pub fn write_glb(scene: &Scene, layouts: &[Layout], occlusion: Option<Occlusion>) -> Result<WrittenScene, GlbTooLarge> {
    let mut binary = Binary::default();
    let groups = Groups::new(scene, occlusion.is_some());
    let mut materials = materials::write(scene, &mut binary);
    let per_instance = match &occlusion {
        None => PerInstance::Nothing,
        Some(occlusion) => PerInstance::Occlusion(*occlusion, occlusion.add_to(scene, &mut materials, &mut binary)),
    };
    let bytes = finish(scene, layouts, &groups, &per_instance, materials, binary)?;
    Ok(WrittenScene {
        bytes,
        primitives_of_instances: groups.primitives_of_instances,
        has_page_uvs: occlusion.is_some(),
    })
}

/// Writes a scene with ambient visibility at its vertices (for each instance, one number per vertex of its mesh, 0 to
/// 1) and without baked coordinates.
///
/// # Errors
///
/// If the file would have 4 GiB or more.
pub fn write_vertices(scene: &Scene, attribute: VertexAttribute, open: &[Vec<f32>]) -> Result<Vec<u8>, GlbTooLarge> {
    let mut binary = Binary::default();
    let groups = Groups::new(scene, true);
    let materials = materials::write(scene, &mut binary);
    let layouts: Vec<Layout> = scene.meshes.iter().map(Layout::of_mesh).collect();
    finish(scene, &layouts, &groups, &PerInstance::VertexVisibility(attribute, open), materials, binary)
}

fn finish(
    scene: &Scene,
    layouts: &[Layout],
    groups: &Groups,
    per_instance: &PerInstance,
    materials: WrittenMaterials,
    mut binary: Binary,
) -> Result<Vec<u8>, GlbTooLarge> {
    let meshes = meshes::write(scene, layouts, groups, per_instance, &mut binary);
    let mut root = Map::new();
    root.insert("asset".into(), json!({ "version": "2.0", "generator": GENERATOR }));
    root.insert("scene".into(), json!(0));
    root.insert("scenes".into(), json!([{ "nodes": nodes::roots(scene) }]));
    let lists = [
        ("nodes", nodes::write(scene, groups)),
        ("cameras", nodes::cameras(scene)),
        ("meshes", meshes),
        ("materials", materials.materials),
        ("textures", materials.textures),
        ("samplers", materials.samplers),
        ("images", materials.images),
        ("extensionsUsed", materials.extensions),
        ("accessors", binary.accessors),
        ("bufferViews", binary.views),
        ("buffers", vec![json!({ "byteLength": binary.bytes.len() })]),
    ];
    root.extend(lists.into_iter().filter(|(_, list)| !list.is_empty()).map(|(name, list)| (name.into(), list.into())));
    container(&Value::from(root).to_string(), &binary.bytes)
}

const GENERATOR: &str = concat!("sunbake ", env!("CARGO_PKG_VERSION"));

/// Header, JSON chunk padded with spaces, binary chunk padded with zeros.
fn container(json: &str, binary: &[u8]) -> Result<Vec<u8>, GlbTooLarge> {
    let padded = |length: usize| length.next_multiple_of(4);
    let total = 12 + 8 + padded(json.len()) + 8 + padded(binary.len());
    let length = u32::try_from(total).map_err(|_| GlbTooLarge { bytes: total as u64 })?;
    let mut bytes = Vec::with_capacity(total);
    bytes.extend(b"glTF");
    bytes.extend(2u32.to_le_bytes());
    bytes.extend(length.to_le_bytes());
    for (kind, data, padding) in [(b"JSON", json.as_bytes(), b' '), (b"BIN\0", binary, 0)] {
        bytes.extend((padded(data.len()) as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(data);
        bytes.resize(bytes.len().next_multiple_of(4), padding);
    }
    Ok(bytes)
}
