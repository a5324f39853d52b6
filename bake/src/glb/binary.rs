//! The binary chunk: what the file's views hold, and new views and accessors.
//!
//! Accessors and views keep their indices. An accessor that only rewritten primitives use is replaced in its place, and
//! a view whose last accessor is replaced gives its place to a new one; so nothing is written that nothing reads. Of
//! the file's buffers, each run of bytes that some view covers is copied once, at an offset equal to its old one modulo
//! [`ALIGNMENT`].

use super::references::{self, Free};
use super::{index, list};
use crate::scene::SceneFile;
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// Offsets keep their remainder by this many bytes: more than any component needs.
const ALIGNMENT: usize = 16;
/// Targets of buffer views, as numbered by glTF.
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;
/// Component types.
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const FLOAT: u32 = 5126;
/// Extensions whose data lie in a second place of a buffer, which the view's own object names.
pub(super) const COMPRESSIONS: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];

/// A binary chunk under construction.
pub(super) struct Binary<'a> {
    file: &'a SceneFile,
    views: Vec<View>,
    accessors: Vec<Value>,
    free: Free,
}

enum View {
    /// One of the file's.
    Old(Value),
    /// New data.
    New(Value, Vec<u8>),
}

impl<'a> Binary<'a> {
    /// Takes the views and accessors out of the file's JSON.
    pub fn new(file: &'a SceneFile, root: &mut Value) -> Self {
        let views = std::mem::take(list(root, "bufferViews")).into_iter().map(View::Old).collect();
        let accessors = std::mem::take(list(root, "accessors"));
        Self { file, views, accessors, free: Free::default() }
    }

    /// Frees what only accessors use that `is_replaced` names, by mesh, primitive and accessor.
    pub fn free(&mut self, root: &Value, is_replaced: impl Fn(usize, usize, usize) -> bool) {
        self.free = references::free(root, &self.accessors, self.views.len(), is_replaced);
    }

    /// Adds bytes that an object describes. Returns the view's index.
    pub fn add_view(&mut self, mut view: Value, bytes: Vec<u8>) -> usize {
        view["byteLength"] = json!(bytes.len());
        let new = View::New(view, bytes);
        match self.free.views.pop() {
            Some(index) => {
                self.views[index] = new;
                index
            }
            None => {
                self.views.push(new);
                self.views.len() - 1
            }
        }
    }

    /// Adds an accessor, in the place of an old one if that is free. Returns its index.
    pub fn put_accessor(&mut self, old: Option<usize>, accessor: Value) -> usize {
        match old.filter(|old| self.free.accessors.remove(old)) {
            Some(old) => {
                self.accessors[old] = accessor;
                old
            }
            None => {
                self.accessors.push(accessor);
                self.accessors.len() - 1
            }
        }
    }

    /// Adds elements of an attribute, of `size` bytes each. Returns the view's index.
    pub fn add_elements<'e>(&mut self, elements: impl Iterator<Item = &'e [u8]>, size: usize) -> usize {
        let stride = size.next_multiple_of(4);
        let mut bytes = Vec::new();
        for element in elements {
            bytes.extend(element);
            bytes.resize(bytes.len().next_multiple_of(stride), 0);
        }
        let view = if stride == size { json!({}) } else { json!({ "byteStride": stride }) };
        self.add_view(with(view, "target", json!(ARRAY_BUFFER)), bytes)
    }

    /// Adds an attribute of one to four `f32` per vertex. Returns the accessor's index.
    pub fn add_vectors<const N: usize>(&mut self, old: Option<usize>, vectors: &[[f32; N]]) -> usize {
        let bytes: Vec<[u8; 4]> = vectors.as_flattened().iter().map(|x| x.to_le_bytes()).collect();
        let view = self.add_elements(bytes.as_flattened().chunks_exact(4 * N), 4 * N);
        let shape = if N == 1 { "SCALAR".into() } else { format!("VEC{N}") };
        let accessor = json!({ "bufferView": view, "componentType": FLOAT, "count": vectors.len(), "type": shape });
        self.put_accessor(old, accessor)
    }

    /// Adds texture coordinates that are all zero: an accessor without data.
    pub fn add_zero_texcoords(&mut self, count: usize) -> usize {
        self.put_accessor(None, json!({ "componentType": FLOAT, "count": count, "type": "VEC2" }))
    }

    /// Adds indices, with 16 bits if possible (65,535 itself is reserved). Returns the accessor's index.
    pub fn add_indices(&mut self, old: Option<usize>, indices: &[u32]) -> usize {
        let is_short = indices.iter().all(|&index| index < 0xFFFF);
        let (component, bytes): (u32, Vec<u8>) = match is_short {
            true => (UNSIGNED_SHORT, indices.iter().flat_map(|&index| (index as u16).to_le_bytes()).collect()),
            false => (UNSIGNED_INT, indices.iter().flat_map(|index| index.to_le_bytes()).collect()),
        };
        let view = self.add_view(json!({ "target": ELEMENT_ARRAY_BUFFER }), bytes);
        let mut accessor = old.and_then(|old| self.accessors.get(old)).cloned().unwrap_or_else(|| json!({}));
        for key in ["byteOffset", "sparse", "min", "max", "normalized"] {
            accessor.as_object_mut().into_iter().for_each(|object| drop(object.remove(key)));
        }
        accessor["bufferView"] = json!(view);
        accessor["componentType"] = json!(component);
        accessor["count"] = json!(indices.len());
        accessor["type"] = json!("SCALAR");
        self.put_accessor(old, accessor)
    }

    /// Puts views, accessors and buffers back into the JSON. Gives the chunk.
    pub fn finish(self, root: &mut Value) -> Vec<u8> {
        let Self { file, mut views, accessors, .. } = self;
        let old = || views.iter().filter_map(|view| if let View::Old(json) = view { Some(json) } else { None });
        let covered = covered_runs(file, old());
        let mut bytes = Vec::new();
        let mut moved: BTreeMap<usize, Vec<(Range<usize>, usize)>> = BTreeMap::new();
        for (buffer, runs) in covered {
            for run in runs {
                let start = at_same_remainder(bytes.len(), run.start);
                bytes.resize(start, 0);
                bytes.extend(file.buffer(buffer).and_then(|all| all.get(run.clone())).unwrap_or(&[]));
                moved.entry(buffer).or_default().push((run, start));
            }
        }
        let mut unread = Vec::new();
        for view in &mut views {
            match view {
                View::Old(json) => {
                    move_range(file, &moved, &mut unread, json);
                    for name in COMPRESSIONS {
                        let of_view = json.get_mut("extensions").and_then(|all| all.get_mut(name));
                        of_view.into_iter().for_each(|json| move_range(file, &moved, &mut unread, json));
                    }
                }
                View::New(json, data) => {
                    bytes.resize(bytes.len().next_multiple_of(ALIGNMENT), 0);
                    json["buffer"] = json!(0);
                    json["byteOffset"] = json!(bytes.len());
                    bytes.append(data);
                }
            }
        }
        let json_of = |view| match view {
            View::Old(json) | View::New(json, _) => json,
        };
        put(root, "bufferViews", views.into_iter().map(json_of).collect());
        put(root, "accessors", accessors);
        let old = std::mem::take(list(root, "buffers"));
        let mut buffers: Vec<Value> = unread.iter().filter_map(|&buffer| old.get(buffer).cloned()).collect();
        if !bytes.is_empty() || !buffers.is_empty() {
            let mut chunk = old.into_iter().next().filter(|_| file.buffer(0).is_some()).unwrap_or_else(|| json!({}));
            chunk.as_object_mut().into_iter().for_each(|object| drop(object.remove("uri")));
            bytes.resize(bytes.len().max(1), 0);
            chunk["byteLength"] = json!(bytes.len());
            buffers.insert(0, chunk);
        }
        put(root, "buffers", buffers);
        bytes
    }
}

fn with(mut object: Value, key: &str, value: Value) -> Value {
    object[key] = value;
    object
}

/// A list at the top level; none where it would be empty.
fn put(root: &mut Value, name: &str, values: Vec<Value>) {
    match values.is_empty() {
        true => root.as_object_mut().into_iter().for_each(|root| drop(root.remove(name))),
        false => root[name] = values.into(),
    }
}

/// The next offset, from `least`, with the remainder that `old` has.
fn at_same_remainder(least: usize, old: usize) -> usize {
    let wanted = old % ALIGNMENT;
    least + (wanted + ALIGNMENT - least % ALIGNMENT) % ALIGNMENT
}

/// The bytes that an object covers, of a buffer that could be read.
fn range_of(file: &SceneFile, json: &Value) -> Option<(usize, Range<usize>)> {
    let buffer = index(json, "buffer")?;
    let end_of_buffer = file.buffer(buffer)?.len();
    let start = index(json, "byteOffset").unwrap_or(0).min(end_of_buffer);
    let end = start.saturating_add(index(json, "byteLength")?).min(end_of_buffer);
    Some((buffer, start..end))
}

/// For each buffer, the runs of bytes that views cover, in order and apart.
fn covered_runs<'v>(file: &SceneFile, views: impl Iterator<Item = &'v Value>) -> BTreeMap<usize, Vec<Range<usize>>> {
    let mut ranges = BTreeSet::new();
    for view in views {
        let compressed = COMPRESSIONS.iter().filter_map(|name| view.get("extensions")?.get(name));
        for (buffer, range) in std::iter::once(view).chain(compressed).filter_map(|json| range_of(file, json)) {
            ranges.insert((buffer, range.start, range.end));
        }
    }
    let mut runs: BTreeMap<usize, Vec<Range<usize>>> = BTreeMap::new();
    for (buffer, start, end) in ranges {
        let of_buffer = runs.entry(buffer).or_default();
        match of_buffer.last_mut() {
            Some(last) if start <= last.end => last.end = last.end.max(end),
            _ => of_buffer.push(start..end),
        }
    }
    runs
}

/// Points an object at the place of its bytes in the chunk; or, if its buffer could not be read, at that buffer's new
/// index.
fn move_range(
    file: &SceneFile,
    moved: &BTreeMap<usize, Vec<(Range<usize>, usize)>>,
    unread: &mut Vec<usize>,
    json: &mut Value,
) {
    let Some(buffer) = index(json, "buffer") else { return };
    let Some((_, range)) = range_of(file, json) else {
        let known = unread.iter().position(|&other| other == buffer).unwrap_or_else(|| {
            unread.push(buffer);
            unread.len() - 1
        });
        json["buffer"] = json!(known + 1);
        return;
    };
    let runs = moved.get(&buffer).map_or(&[][..], Vec::as_slice);
    let behind = runs.partition_point(|(run, _)| run.start <= range.start);
    if let Some((run, start)) = behind.checked_sub(1).map(|at| &runs[at]) {
        json["buffer"] = json!(0);
        json["byteOffset"] = json!(start + range.start - run.start);
    }
}
