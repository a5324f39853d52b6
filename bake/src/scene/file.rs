//! The file that a scene was read from, kept so that `scene.glb` can be that file with the bake's additions.

use super::{
    LoadError, LoadLimits,
    accessors::{self, Reader},
    document::{Document, JsonPrimitive},
    images::Picture,
    limits::MemoryBudget,
    resources::Buffers,
    triangles::Topology,
};
use serde::Deserialize;
use serde_json::{Map, Value, json};

/// A scene's JSON, and the bytes that it names.
pub struct SceneFile {
    doc: Document,
    buffers: Buffers,
    pictures: Vec<Picture>,
}

/// The component type of `f32`.
const FLOAT: u64 = 5126;

/// Elements of an accessor as they are stored, one after the other.
pub(crate) struct PackedElements {
    pub bytes: Vec<u8>,
    /// Bytes of one.
    pub size: usize,
}

impl std::fmt::Debug for SceneFile {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.debug_struct("SceneFile").finish_non_exhaustive()
    }
}

impl SceneFile {
    pub(super) fn new(doc: Document, buffers: Buffers, pictures: Vec<Picture>) -> Self {
        Self { doc, buffers, pictures }
    }

    /// What it holds, for reading more of it.
    pub(super) fn parts(&self) -> (&Document, &Buffers, &[Picture]) {
        (&self.doc, &self.buffers, &self.pictures)
    }

    /// A file made by code, of one buffer.
    pub(crate) fn made(json: Value, binary: Vec<u8>) -> Self {
        Self::new(Document { root: json }, Buffers::of_one(binary), Vec::new())
    }

    /// The file's JSON; integers that it writes as floats (`24.0`) are integers.
    pub fn json(&self) -> &Value {
        &self.doc.root
    }

    /// The bytes of a buffer; `None` if it could not be read.
    pub(crate) fn buffer(&self, index: usize) -> Option<&[u8]> {
        self.buffers.get(index)
    }

    /// The bytes of an image that a URI names, or why there are none; `None` for an image without a URI.
    pub(crate) fn picture(&self, index: usize) -> Option<Result<&[u8], &LoadError>> {
        Some(self.pictures.get(index)?.as_ref()?.as_deref())
    }

    /// The elements of an accessor.
    pub(crate) fn packed(&self, accessor: usize) -> Result<PackedElements, LoadError> {
        let (bytes, size) = self.with_reader(|reader| reader.packed(accessor))?;
        Ok(PackedElements { bytes, size })
    }

    /// The members `min` and `max` of an accessor with these elements.
    pub(crate) fn stored_range(accessor: &Map<String, Value>, packed: &[u8]) -> Option<[(String, Value); 2]> {
        let component_type = accessor.get("componentType")?.as_u64()?;
        let lanes = accessors::lanes_of(accessor.get("type")?.as_str()?)?;
        let range = accessors::stored_range(component_type, packed, lanes)?;
        let number = |x: f64| if component_type == FLOAT { json!(x) } else { json!(x as i64) };
        let [low, high] = range.map(|values| values.into_iter().map(number).collect());
        Some([("min".into(), low), ("max".into(), high)])
    }

    /// The triangles of a primitive, of whatever topology, as triples of its vertices; degenerate ones as well.
    pub(crate) fn triangles(&self, primitive: &Value, vertex_count: usize) -> Option<Vec<u32>> {
        let primitive = JsonPrimitive::deserialize(primitive).ok()?;
        let topology = Topology::from_mode(primitive.mode.unwrap_or(4))?;
        let order: Vec<u32> = match primitive.indices {
            Some(accessor) => self.with_reader(|r| r.integers::<1>(accessor)).ok()?.into_iter().flatten().collect(),
            None => (0..vertex_count as u32).collect(),
        };
        Some(topology.triangulate(&order))
    }

    /// The bytes were counted when the file was loaded.
    fn with_reader<T>(&self, read: impl FnOnce(Reader) -> T) -> T {
        let budget = MemoryBudget::new(&LoadLimits { max_memory_bytes: u64::MAX });
        read(Reader { doc: &self.doc, buffers: &self.buffers, budget: &budget })
    }
}
