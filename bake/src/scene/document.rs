//! The parts of glTF's JSON that a bake reads.
//!
//! An item is parsed when it is first needed. So errors in a file's animations, samplers or unused accessors do not
//! stop a bake, and an error in something that is used is reported with its place. The types of the `gltf` crate are
//! not used because they parse and validate a whole file or none of it, hold node matrices in `f32`, and index out of
//! range without that validation.

use super::{LoadError, container::strip_position};
use serde::{Deserialize, de::DeserializeOwned};
use serde_json::Value;
use std::collections::BTreeMap;

/// The JSON of a scene.
pub(super) struct Document {
    pub root: Value,
}

/// An element of one of the lists at the top level.
pub(super) trait ListItem: DeserializeOwned {
    /// The list's key in the file.
    const LIST: &'static str;
}

/// Where an item is, for messages: `accessors[12]`.
pub(super) fn place<T: ListItem>(index: usize) -> String {
    format!("{}[{index}]", T::LIST)
}

impl Document {
    /// Parses item `index` of its list.
    pub fn get<T: ListItem>(&self, index: usize) -> Result<T, LoadError> {
        let value = self.list(T::LIST).get(index).ok_or_else(|| {
            let count = self.count::<T>();
            LoadError::structure(place::<T>(index), format!("it is referred to, but there are only {count}"))
        })?;
        T::deserialize(value)
            .map_err(|error| LoadError::structure(place::<T>(index), strip_position(&error.to_string())))
    }

    /// Length of the item's list; 0 if the file has none.
    pub fn count<T: ListItem>(&self) -> usize {
        self.list(T::LIST).len()
    }

    /// The `extras` of item `index` of its list, if they are an object.
    pub fn extras<T: ListItem>(&self, index: usize) -> Option<&serde_json::Map<String, Value>> {
        self.list(T::LIST).get(index)?.get("extras")?.as_object()
    }

    fn list(&self, name: &str) -> &[Value] {
        self.root.get(name).and_then(Value::as_array).map_or(&[], Vec::as_slice)
    }

    /// The strings in a list at the top level.
    pub fn strings(&self, name: &str) -> impl Iterator<Item = &str> {
        self.list(name).iter().filter_map(Value::as_str)
    }
}

macro_rules! items {
    ($($name:ident = $list:literal),* $(,)?) => { $(impl ListItem for $name { const LIST: &'static str = $list; })* };
}

items! {
    JsonAccessor = "accessors", JsonBuffer = "buffers", JsonBufferView = "bufferViews", JsonCamera = "cameras",
    JsonImage = "images", JsonMaterial = "materials", JsonMesh = "meshes", JsonNode = "nodes",
    JsonSampler = "samplers", JsonSceneRoots = "scenes",
    JsonSkin = "skins", JsonTexture = "textures",
}

#[derive(Deserialize)]
pub(super) struct JsonSceneRoots {
    pub nodes: Option<Vec<usize>>,
}

#[derive(Deserialize, Default)]
#[serde(rename_all = "camelCase")]
pub(super) struct JsonNode {
    pub name: Option<String>,
    pub children: Option<Vec<usize>>,
    pub matrix: Option<[f64; 16]>,
    pub translation: Option<[f64; 3]>,
    pub rotation: Option<[f64; 4]>,
    pub scale: Option<[f64; 3]>,
    pub mesh: Option<usize>,
    pub skin: Option<usize>,
    pub camera: Option<usize>,
    pub weights: Option<Vec<f32>>,
    pub extensions: Option<BTreeMap<String, Value>>,
}

#[derive(Deserialize)]
pub(super) struct JsonMesh {
    pub name: Option<String>,
    pub primitives: Option<Vec<JsonPrimitive>>,
    pub weights: Option<Vec<f32>>,
}

#[derive(Deserialize)]
pub(super) struct JsonPrimitive {
    #[serde(default)]
    pub attributes: BTreeMap<String, usize>,
    pub indices: Option<usize>,
    pub material: Option<usize>,
    pub mode: Option<u64>,
    pub targets: Option<Vec<BTreeMap<String, usize>>>,
    pub extensions: Option<BTreeMap<String, Value>>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct JsonAccessor {
    pub buffer_view: Option<usize>,
    #[serde(default)]
    pub byte_offset: u64,
    pub component_type: u64,
    pub count: u64,
    #[serde(rename = "type")]
    pub shape: String,
    #[serde(default)]
    pub normalized: bool,
    pub sparse: Option<Sparse>,
}

#[derive(Deserialize)]
pub(super) struct Sparse {
    pub count: u64,
    pub indices: SparseIndices,
    pub values: SparseValues,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SparseIndices {
    pub buffer_view: usize,
    #[serde(default)]
    pub byte_offset: u64,
    pub component_type: u64,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SparseValues {
    pub buffer_view: usize,
    #[serde(default)]
    pub byte_offset: u64,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct JsonBufferView {
    pub buffer: usize,
    #[serde(default)]
    pub byte_offset: u64,
    pub byte_length: u64,
    pub byte_stride: Option<u64>,
    pub extensions: Option<BTreeMap<String, Value>>,
}

#[derive(Deserialize)]
pub(super) struct JsonBuffer {
    pub uri: Option<String>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct JsonImage {
    pub name: Option<String>,
    pub uri: Option<String>,
    pub buffer_view: Option<usize>,
}

#[derive(Deserialize)]
pub(super) struct JsonTexture {
    pub source: Option<usize>,
    pub sampler: Option<usize>,
    pub extensions: Option<BTreeMap<String, Value>>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct JsonSampler {
    pub wrap_s: Option<u64>,
    pub wrap_t: Option<u64>,
}

#[derive(Deserialize, Default)]
#[serde(rename_all = "camelCase")]
pub(super) struct JsonMaterial {
    pub name: Option<String>,
    pub pbr_metallic_roughness: Option<MetallicRoughness>,
    pub emissive_factor: Option<[f32; 3]>,
    pub alpha_mode: Option<String>,
    pub alpha_cutoff: Option<f32>,
    #[serde(default)]
    pub double_sided: bool,
    #[serde(default)]
    pub extensions: MaterialExtensions,
}

#[derive(Deserialize, Default)]
#[serde(rename_all = "camelCase")]
pub(super) struct MetallicRoughness {
    pub base_color_factor: Option<[f32; 4]>,
    pub base_color_texture: Option<TextureInfo>,
}

#[derive(Deserialize, Default)]
pub(super) struct MaterialExtensions {
    #[serde(rename = "KHR_materials_unlit")]
    pub unlit: Option<Value>,
    #[serde(rename = "KHR_materials_emissive_strength")]
    pub emissive_strength: Option<EmissiveStrength>,
    #[serde(rename = "KHR_materials_transmission")]
    pub transmission: Option<Transmission>,
    #[serde(rename = "KHR_materials_pbrSpecularGlossiness")]
    pub specular_glossiness: Option<SpecularGlossiness>,
}

#[derive(Deserialize, Default)]
#[serde(rename_all = "camelCase")]
pub(super) struct EmissiveStrength {
    pub emissive_strength: Option<f32>,
}

#[derive(Deserialize, Default)]
#[serde(rename_all = "camelCase")]
pub(super) struct Transmission {
    pub transmission_factor: Option<f32>,
}

#[derive(Deserialize, Default)]
#[serde(rename_all = "camelCase")]
pub(super) struct SpecularGlossiness {
    pub diffuse_factor: Option<[f32; 4]>,
    pub diffuse_texture: Option<TextureInfo>,
}

#[derive(Deserialize, Default)]
#[serde(rename_all = "camelCase")]
pub(super) struct TextureInfo {
    pub index: usize,
    #[serde(default)]
    pub tex_coord: usize,
    #[serde(default)]
    pub extensions: TextureInfoExtensions,
}

#[derive(Deserialize, Default)]
pub(super) struct TextureInfoExtensions {
    #[serde(rename = "KHR_texture_transform")]
    pub transform: Option<TextureTransform>,
}

#[derive(Deserialize, Default)]
#[serde(rename_all = "camelCase")]
pub(super) struct TextureTransform {
    pub offset: Option<[f32; 2]>,
    pub rotation: Option<f32>,
    pub scale: Option<[f32; 2]>,
    pub tex_coord: Option<usize>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct JsonSkin {
    pub joints: Vec<usize>,
    pub inverse_bind_matrices: Option<usize>,
}

#[derive(Deserialize)]
pub(super) struct JsonCamera {
    pub name: Option<String>,
    pub perspective: Option<Perspective>,
}

#[derive(Deserialize)]
pub(super) struct Perspective {
    pub yfov: f64,
}

impl JsonMaterial {
    /// Factor and texture of the base colour: metallic-roughness, else the older specular-glossiness model's diffuse
    /// colour.
    pub fn base_color(self) -> ([f32; 4], Option<TextureInfo>) {
        let standard = self.pbr_metallic_roughness.unwrap_or_default();
        let has_standard = standard.base_color_factor.is_some() || standard.base_color_texture.is_some();
        let (factor, texture) = match self.extensions.specular_glossiness {
            Some(older) if !has_standard => (older.diffuse_factor, older.diffuse_texture),
            _ => (standard.base_color_factor, standard.base_color_texture),
        };
        (factor.unwrap_or([1.0; 4]), texture)
    }
}

impl TextureInfo {
    /// Which `TEXCOORD_n` the texture reads.
    pub fn texcoord(&self) -> usize {
        self.extensions.transform.as_ref().and_then(|t| t.tex_coord).unwrap_or(self.tex_coord)
    }
}
