//! What a primitive's materials are, and which texture coordinates they read.

use super::{index, references::items};
use serde_json::Value;

/// The extension that gives a primitive a material for each variant of the scene.
const VARIANTS: &str = "KHR_materials_variants";

/// The materials that a primitive may have: its own and those of its variants.
pub(super) fn materials_of(primitive: &Value) -> impl Iterator<Item = usize> {
    let variants = primitive.get("extensions").and_then(|all| all.get(VARIANTS));
    let mappings = variants.into_iter().flat_map(|variants| items(variants, "mappings"));
    index(primitive, "material").into_iter().chain(mappings.filter_map(|mapping| index(mapping, "material")))
}

/// Changes the materials that a primitive may have.
pub(super) fn map_materials(primitive: &mut Value, mut change: impl FnMut(Option<usize>) -> Option<usize>) {
    let mut replace = |object: &mut Value| {
        if let Some(new) = change(index(object, "material")) {
            object["material"] = new.into();
        }
    };
    replace(primitive);
    let variants = primitive.get_mut("extensions").and_then(|all| all.get_mut(VARIANTS));
    let mappings = variants.and_then(|variants| variants.get_mut("mappings")).and_then(Value::as_array_mut);
    mappings.into_iter().flatten().filter(|mapping| mapping.is_object()).for_each(replace);
}

/// The highest set of texture coordinates that a material's textures read; none without textures.
pub(super) fn last_texcoord(material: &Value) -> Option<usize> {
    let of_member = |(key, value): (&String, &Value)| match key.ends_with("Texture") && value.get("index").is_some() {
        true => {
            let transform = value.get("extensions").and_then(|all| all.get("KHR_texture_transform"));
            let moved = transform.and_then(|transform| index(transform, "texCoord"));
            Some(moved.or(index(value, "texCoord")).unwrap_or(0))
        }
        false => last_texcoord(value),
    };
    material.as_object()?.iter().filter_map(of_member).max()
}
