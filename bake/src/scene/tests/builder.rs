//! Builds small scenes, in GLB, by code.

use crate::scene::{LoadError, LoadLimits, Scene, load};
use serde_json::{Value, json};
use std::io::Cursor;

/// A glTF file under construction: one scene, one buffer.
#[derive(Clone)]
pub(crate) struct Builder {
    pub root: Value,
    binary: Vec<u8>,
}

/// A right triangle in the plane z = 0, facing +Z.
pub const TRIANGLE: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

/// Loads a file of that name with that content.
pub fn load_bytes(name: &str, bytes: &[u8]) -> Result<Scene, LoadError> {
    load_limited(name, bytes, &LoadLimits::default())
}

pub fn load_limited(name: &str, bytes: &[u8], limits: &LoadLimits) -> Result<Scene, LoadError> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).expect("space for a small file");
    load(&path, limits)
}

/// A PNG of one row.
pub fn png(texels: &[[u8; 4]]) -> Vec<u8> {
    let flat = texels.as_flattened().to_vec();
    let image = image::RgbaImage::from_raw(texels.len() as u32, 1, flat).expect("one row");
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, image::ImageFormat::Png).expect("encoded");
    bytes.into_inner()
}

impl Builder {
    pub fn new() -> Self {
        let root = json!({ "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [] }] });
        Self { root, binary: Vec::new() }
    }

    /// A scene of one triangle under one node with these properties.
    pub fn triangle(mut node: Value) -> Self {
        let mut builder = Self::new();
        node["mesh"] = json!(builder.triangle_mesh(json!({})));
        builder.node(node);
        builder
    }

    /// Adds to a list at the top level.
    pub fn push(&mut self, list: &str, value: Value) -> usize {
        let entry = &mut self.root[list];
        if entry.is_null() {
            *entry = json!([]);
        }
        let entry = entry.as_array_mut().expect("a list");
        entry.push(value);
        entry.len() - 1
    }

    /// Adds a node to the scene's roots.
    pub fn node(&mut self, node: Value) -> usize {
        let index = self.push("nodes", node);
        self.root["scenes"][0]["nodes"].as_array_mut().expect("a list").push(json!(index));
        index
    }

    /// Adds a node that is no root.
    pub fn child(&mut self, node: Value) -> usize {
        self.push("nodes", node)
    }

    pub fn view(&mut self, bytes: &[u8]) -> usize {
        let start = self.binary.len();
        self.binary.extend(bytes);
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        self.push("bufferViews", json!({ "buffer": 0, "byteOffset": start, "byteLength": bytes.len() }))
    }

    /// Adds an accessor over bytes of its own; `more` overrides its properties.
    pub fn accessor(&mut self, component: u32, shape: &str, count: usize, bytes: &[u8], more: Value) -> usize {
        let view = self.view(bytes);
        let mut accessor = json!({ "bufferView": view, "componentType": component, "type": shape, "count": count });
        if let Value::Object(more) = more {
            more.into_iter().for_each(|(key, value)| accessor[key] = value);
        }
        self.push("accessors", accessor)
    }

    pub fn floats<const N: usize>(&mut self, values: &[[f32; N]]) -> usize {
        let bytes: Vec<u8> = values.iter().flatten().flat_map(|v| v.to_le_bytes()).collect();
        let shape = match N {
            1 => "SCALAR",
            16 => "MAT4",
            2 => "VEC2",
            3 => "VEC3",
            _ => "VEC4",
        };
        self.accessor(5126, shape, values.len(), &bytes, json!({}))
    }

    pub fn indices(&mut self, values: &[u16]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        self.accessor(5123, "SCALAR", values.len(), &bytes, json!({}))
    }

    /// Adds a mesh of one primitive.
    pub fn mesh(&mut self, primitive: Value) -> usize {
        let mut mesh = json!({});
        mesh["primitives"] = Value::Array(vec![primitive]);
        self.push("meshes", mesh)
    }

    /// Adds a mesh of [`TRIANGLE`], with more attributes.
    pub fn triangle_mesh(&mut self, attributes: Value) -> usize {
        self.triangle_mesh_of(attributes, json!({}))
    }

    /// Adds a mesh of [`TRIANGLE`], with more attributes and more properties.
    pub fn triangle_mesh_of(&mut self, mut attributes: Value, mut primitive: Value) -> usize {
        attributes["POSITION"] = json!(self.floats(&TRIANGLE));
        primitive["attributes"] = attributes;
        self.mesh(primitive)
    }

    /// Adds an image in the file, a texture of it, and says the texture's index.
    pub fn texture(&mut self, bytes: &[u8]) -> usize {
        let view = self.view(bytes);
        let image = self.push("images", json!({ "bufferView": view, "mimeType": "image/png" }));
        self.push("textures", json!({ "source": image }))
    }

    pub fn json(&self) -> Value {
        let mut root = self.root.clone();
        if !self.binary.is_empty() && root.get("buffers").is_none() {
            root["buffers"] = json!([{ "byteLength": self.binary.len() }]);
        }
        root
    }

    pub fn glb(&self) -> Vec<u8> {
        Self::glb_of(self.json().to_string().as_bytes(), &self.binary)
    }

    pub fn glb_of(json: &[u8], binary: &[u8]) -> Vec<u8> {
        let mut json = json.to_vec();
        json.resize(json.len().next_multiple_of(4), b' ');
        let total = 12 + 8 + json.len() + 8 + binary.len();
        let mut bytes = b"glTF\x02\0\0\0".to_vec();
        bytes.extend((total as u32).to_le_bytes());
        for (kind, data) in [(b"JSON", json.as_slice()), (b"BIN\0", binary)] {
            bytes.extend((data.len() as u32).to_le_bytes());
            bytes.extend(kind);
            bytes.extend(data);
        }
        bytes
    }

    pub fn binary(&self) -> &[u8] {
        &self.binary
    }

    pub fn load(&self) -> Result<Scene, LoadError> {
        load_bytes("built.glb", &self.glb())
    }

    /// Loads what must load.
    pub fn scene(&self) -> Scene {
        self.load().unwrap_or_else(|error| panic!("{error}\n{:#}", self.root))
    }

    /// The message of what must not load.
    pub fn refusal(&self) -> String {
        self.load().map(|_| "it was loaded".to_owned()).unwrap_or_else(|error| error.to_string())
    }
}
