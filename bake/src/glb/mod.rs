//! Writes `scene.glb`: the scene's own file with the bake's additions, for any glTF viewer.
//!
//! The file stays what it was: every node, mesh, material, texture, extension, extra, light, camera and animation is
//! still there, in its old order and under its old index. Added are
//!
//! * a set of texture coordinates for each baked primitive, in the first `TEXCOORD_n` that is free (from 1). Vertices
//!   on the borders of charts are copied, with all their attributes and morph targets; copies come after the old
//!   vertices ([`streams`]);
//! * where ambient light was baked, occlusion textures, and copies of materials and meshes that need one of their own
//!   ([`occlusion`], [`meshes`]);
//! * nodes for the copies of `EXT_mesh_gpu_instancing`, which the bake tells apart ([`nodes`]).
//!
//! All buffers and pictures that could be read become one binary chunk ([`binary`]). What could not be kept is named in
//! [`WrittenScene::not_kept`]. A scene made by code has no file; one is made of it first ([`made`]).
//!
//! The same scene gives the same bytes. Reading the file back gives the same nodes, instances and triangles in the same
//! order.
//!
//! Based on: Khronos Group, *glTF 2.0 Specification*.

mod additions;
mod binary;
mod made;
mod materials;
mod meshes;
mod nodes;
mod occlusion;
mod pictures;
mod references;
mod streams;

pub use occlusion::{Occlusion, OcclusionPage};

use crate::{atlas::Layout, scene::Scene, settings::VertexAttribute};
use additions::Additions;
use binary::Binary;
use meshes::FilePlaces;
use serde_json::Value;

/// A scene as a GLB file, and where its instances are in it.
#[derive(Debug, Clone)]
pub struct WrittenScene {
    /// Content of the file.
    pub bytes: Vec<u8>,
    /// For each of [`Scene::instances`], where it is in the file.
    pub places: Vec<WrittenPlace>,
    /// Whether baked coordinates are page coordinates instead of layout coordinates.
    pub has_page_uvs: bool,
    /// What the scene's own file has and this one has not, one sentence each.
    pub not_kept: Vec<String>,
}

/// Where an instance is in a written file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WrittenPlace {
    /// Index of its node.
    pub node: usize,
    /// Index of its primitive in that node's mesh.
    pub primitive: usize,
    /// Which `TEXCOORD_n` holds its baked coordinates.
    pub uv_set: u32,
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
    write(scene, &Additions::Coordinates { layouts, occlusion })
}

/// Writes a scene as it is, for instance one that was made by code.
///
/// # Errors
///
/// If the file would have 4 GiB or more.
pub fn write_plain(scene: &Scene) -> Result<Vec<u8>, GlbTooLarge> {
    Ok(write(scene, &Additions::Nothing)?.bytes)
}

/// Writes a scene with ambient visibility at its vertices (for each instance, one number per vertex of its mesh, 0 to
/// 1) and without baked coordinates.
///
/// # Errors
///
/// If the file would have 4 GiB or more.
pub fn write_vertices(
    scene: &Scene,
    attribute: VertexAttribute,
    visibility: &[Vec<f32>],
) -> Result<Vec<u8>, GlbTooLarge> {
    Ok(write(scene, &Additions::VertexVisibility { attribute, visibility })?.bytes)
}

fn write(scene: &Scene, additions: &Additions) -> Result<WrittenScene, GlbTooLarge> {
    let made;
    let (file, mut root, at, mut not_kept) = match &scene.file {
        Some(file) => {
            let mut root = file.json().clone();
            let (nodes, not_kept) = nodes::expand_copies(scene, &mut root);
            let primitives = scene.instances.iter().map(|instance| scene.meshes[instance.mesh].gltf).collect();
            (&**file, root, FilePlaces { nodes, primitives }, not_kept)
        }
        None => {
            let at;
            (made, at) = made::file_of(scene);
            (&made, made.json().clone(), at, Vec::new())
        }
    };
    let mut binary = Binary::new(file, &mut root);
    let written = meshes::write(scene, file, &at, additions, &mut root, &mut binary);
    if let Additions::Coordinates { occlusion: Some(occlusion), .. } = additions {
        occlusion.add_to(&written, &mut root, &mut binary, &mut not_kept);
    }
    pictures::embed(file, &mut root, &mut binary, &mut not_kept);
    let bytes = binary.finish(&mut root);
    references::list_extensions(&mut root);
    not_kept.extend(written.not_kept);
    Ok(WrittenScene {
        bytes: container(&root.to_string(), &bytes)?,
        places: written.places,
        has_page_uvs: additions.is_per_instance(),
        not_kept,
    })
}

/// A list at the top level, made if there is none.
fn list<'a>(root: &'a mut Value, name: &str) -> &'a mut Vec<Value> {
    if !root.get(name).is_some_and(Value::is_array) {
        root[name] = Value::Array(Vec::new());
    }
    root[name].as_array_mut().expect("it is an array")
}

/// A number of things: `1 node`, `2 nodes`.
fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

/// An index in a JSON object.
fn index(value: &Value, key: &str) -> Option<usize> {
    Some(value.get(key)?.as_u64()? as usize)
}

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
