//! Extensions that change geometry and that sunbake does not read: refused by name, with the command that removes them.
//!
//! The commands were tried with gltf-transform 4.5. Extensions that only change shading, or that have nothing to do
//! with geometry, are ignored even if a file requires them.

use super::{
    LoadError,
    document::{Document, JsonBufferView, JsonPrimitive},
};
use serde_json::Value;
use std::collections::BTreeMap;

const DRACO: &str = "KHR_draco_mesh_compression";
const MESHOPT: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];

/// Extensions that are read completely, or that affect neither geometry nor base colour.
const HARMLESS: [&str; 15] = [
    "EXT_mesh_gpu_instancing",
    "KHR_lights_punctual",
    "KHR_texture_transform",
    "KHR_mesh_quantization",
    "KHR_animation_pointer",
    "KHR_xmp",
    "KHR_xmp_json_ld",
    "EXT_lights_image_based",
    "EXT_lights_ies",
    "EXT_texture_procedurals",
    "FB_geometry_metadata",
    "KHR_audio",
    "KHR_audio_emitter",
    "KHR_node_visibility",
    "MSFT_packing_occlusionRoughnessMetallic",
];

/// Refuses a file that requires an extension which sunbake does not read.
pub(super) fn check_required(doc: &Document) -> Result<(), LoadError> {
    match doc.strings("extensionsRequired").find(|name| !is_harmless(name)) {
        Some(name) => Err(refusal(name)),
        None => Ok(()),
    }
}

fn is_harmless(name: &str) -> bool {
    HARMLESS.contains(&name) || name.starts_with("KHR_materials_") || name.starts_with("KHR_physics")
}

fn refusal(name: &str) -> LoadError {
    LoadError::Extension { extension: name.to_owned(), advice: advice(name) }
}

fn advice(name: &str) -> String {
    let command = match name {
        DRACO | "EXT_meshopt_compression" | "KHR_meshopt_compression" => "copy IN OUT.glb",
        "KHR_texture_basisu" => "ktxdecompress IN OUT.glb",
        "EXT_texture_webp" | "EXT_texture_avif" => "png IN OUT.glb --formats \"*\"",
        _ => return "export the scene without it".into(),
    };
    format!("remove it: npx @gltf-transform/cli {command}")
}

fn has(extensions: Option<&BTreeMap<String, Value>>, name: &str) -> bool {
    extensions.is_some_and(|map| map.contains_key(name))
}

/// The error for a view without its buffer: the compression extension, if the view's bytes are compressed elsewhere.
pub(super) fn missing_buffer(view: &JsonBufferView, error: &LoadError) -> LoadError {
    match MESHOPT.iter().find(|name| has(view.extensions.as_ref(), name)) {
        Some(name) => refusal(name),
        None => error.clone(),
    }
}

/// Refuses a primitive that has only Draco data.
pub(super) fn check_primitive(primitive: &JsonPrimitive, has_plain_positions: bool) -> Result<(), LoadError> {
    match has(primitive.extensions.as_ref(), DRACO) && !has_plain_positions {
        true => Err(refusal(DRACO)),
        false => Ok(()),
    }
}
