//! The binary chunk of a GLB file, with its buffer views and accessors.

use serde_json::{Value, json};

/// A binary chunk under construction. Every view starts at a multiple of four bytes.
#[derive(Default)]
pub(super) struct Binary {
    pub bytes: Vec<u8>,
    pub views: Vec<Value>,
    pub accessors: Vec<Value>,
}

/// Targets of buffer views, as numbered by glTF.
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

impl Binary {
    /// Adds raw bytes, for an image. Returns the view's index.
    pub fn add_view(&mut self, bytes: impl IntoIterator<Item = u8>) -> usize {
        let start = self.bytes.len();
        self.bytes.extend(bytes);
        self.views.push(json!({ "buffer": 0, "byteOffset": start, "byteLength": self.bytes.len() - start }));
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.len() - 1
    }

    fn add_targeted_view(&mut self, target: u32, bytes: impl IntoIterator<Item = u8>) -> usize {
        let view = self.add_view(bytes);
        self.views[view]["target"] = json!(target);
        view
    }

    fn add_accessor(&mut self, accessor: Value) -> usize {
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// Adds an attribute of one to four numbers per vertex. Returns the accessor's index.
    pub fn add_vectors<const N: usize>(&mut self, vectors: impl Iterator<Item = [f32; N]>) -> usize {
        let start = self.bytes.len();
        let view = self.add_targeted_view(ARRAY_BUFFER, vectors.flatten().flat_map(f32::to_le_bytes));
        let count = (self.bytes.len() - start) / (4 * N);
        self.add_accessor(json!({
            "bufferView": view, "componentType": 5126, "count": count,
            "type": if N == 1 { "SCALAR".into() } else { format!("VEC{N}") },
        }))
    }

    /// Adds positions, with the bounds that glTF requires.
    pub fn add_positions(&mut self, positions: impl Iterator<Item = [f32; 3]> + Clone) -> usize {
        let fold = |start: f32, pick: fn(f32, f32) -> f32| {
            positions.clone().fold([start; 3], |m, p| [0, 1, 2].map(|k| pick(m[k], p[k])))
        };
        let (low, high) = (fold(f32::INFINITY, f32::min), fold(f32::NEG_INFINITY, f32::max));
        let accessor = self.add_vectors(positions);
        self.accessors[accessor]["min"] = json!(low);
        self.accessors[accessor]["max"] = json!(high);
        accessor
    }

    /// Adds indices, with 16 bits if possible (65,535 itself is reserved).
    pub fn add_indices(&mut self, indices: &[u32]) -> usize {
        let is_short = indices.iter().all(|&index| index < 0xFFFF);
        let (view, component) = match is_short {
            true => {
                let bytes = indices.iter().flat_map(|&index| (index as u16).to_le_bytes());
                (self.add_targeted_view(ELEMENT_ARRAY_BUFFER, bytes), 5123)
            }
            false => {
                let bytes = indices.iter().flat_map(|index| index.to_le_bytes());
                (self.add_targeted_view(ELEMENT_ARRAY_BUFFER, bytes), 5125)
            }
        };
        self.add_accessor(json!({
            "bufferView": view, "componentType": component, "count": indices.len(), "type": "SCALAR",
        }))
    }
}
