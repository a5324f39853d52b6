//! `EXT_mesh_gpu_instancing`: a node that draws its mesh once for each entry of some accessors. The entries become
//! children of that node, so that everything downstream sees plain nodes.
//!
//! Based on: Khronos Group, *EXT_mesh_gpu_instancing*, glTF extension registry.

use super::{
    LoadError,
    accessors::Reader,
    document::{JsonNode, place},
    nodes::label,
};
use glam::{DMat4, DQuat, DVec3, DVec4, Vec3};
use serde_json::Value;

/// The extension's name.
pub const GPU_INSTANCING: &str = "EXT_mesh_gpu_instancing";

/// Memory of a copy, as a node and as an instance of its mesh.
const BYTES_PER_COPY: u64 = 512;

/// Transforms of the copies of a node's mesh, relative to the node; `None` where the node draws its mesh once.
///
/// # Errors
///
/// If the accessors differ in length or cannot be read.
pub(super) fn copies(reader: Reader, node: &JsonNode, index: usize) -> Result<Option<Vec<DMat4>>, LoadError> {
    let extension = node.mesh.and(node.extensions.as_ref()).and_then(|all| all.get(GPU_INSTANCING));
    let Some(extension) = extension else { return Ok(None) };
    let accessor = |name: &str| {
        let attribute = extension.get("attributes").and_then(|attributes| attributes.get(name));
        attribute.and_then(Value::as_u64).map(|accessor| accessor as usize)
    };
    let of_node = |error: LoadError| error.used_as(GPU_INSTANCING, label(node, index));
    let [translations, scales] = ["TRANSLATION", "SCALE"].map(|name| accessor(name).map(|a| reader.floats::<3>(a)));
    let (translations, scales) = (translations.transpose(), scales.transpose());
    let (translations, scales) = (translations.map_err(of_node)?, scales.map_err(of_node)?);
    let rotations = accessor("ROTATION").map(|a| reader.floats::<4>(a)).transpose().map_err(of_node)?;
    let lengths =
        [translations.as_ref().map(Vec::len), rotations.as_ref().map(Vec::len), scales.as_ref().map(Vec::len)];
    // Copies without a transform lie on one another.
    let count = lengths.iter().flatten().copied().max().unwrap_or(1);
    if let Some(other) = lengths.iter().flatten().find(|&&length| length != count) {
        let problem =
            format!("the attributes of its {GPU_INSTANCING} have {count} and {other} entries: they must be as many");
        return Err(LoadError::structure(place::<JsonNode>(index), problem));
    }
    reader.budget.take(count as u64, BYTES_PER_COPY, || format!("{count} copies of {}", place::<JsonNode>(index)))?;
    let vector = |list: &Option<Vec<[f32; 3]>>, at: usize, default: DVec3| {
        list.as_ref().and_then(|list| list.get(at)).map_or(default, |v| Vec3::from_array(*v).as_dvec3())
    };
    let rotation = |at: usize| {
        let turn = rotations.as_ref().and_then(|list| list.get(at)).map(|turn| DVec4::from_array(turn.map(f64::from)));
        DQuat::from_vec4(turn.and_then(DVec4::try_normalize).unwrap_or(DVec4::W))
    };
    let matrix = |at: usize| {
        let (scale, translation) = (vector(&scales, at, DVec3::ONE), vector(&translations, at, DVec3::ZERO));
        DMat4::from_scale_rotation_translation(scale, rotation(at), translation)
    };
    Ok(Some((0..count).map(matrix).collect()))
}
