//! What a glTF file says and another one, made from it, does not: an independent judge of `scene.glb`.
//!
//! Everything is compared by its content, not by where it lies: pictures and accessors by their bytes, the corners of
//! triangles by all their attributes and morph targets, whatever the vertices' order is. The second file may say more:
//! attributes, textures and what refers to them, elements at the end of lists, children of nodes. It shares no code
//! with the writer or with the loader.

use serde_json::{Map, Value};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// What may differ, since the bake says that it does.
#[derive(Debug, Clone, Copy, Default)]
pub struct Allowed {
    /// Occlusion textures, which a bake replaces.
    pub occlusion: bool,
}

/// A glTF file with its buffers and pictures.
struct File {
    root: Value,
    buffers: Vec<Option<Vec<u8>>>,
    /// For each image, its bytes, if they can be read.
    images: Vec<Option<Vec<u8>>>,
}

/// What the file `source` says and the file `made` does not, one line each; the first of each kind.
pub fn lost(source: &Path, made: &Path, allowed: Allowed) -> Vec<String> {
    let mut differ = Differ { a: File::read(source), b: File::read(made), allowed, lost: Vec::new() };
    differ.compare();
    differ.lost.sort();
    differ.lost.dedup();
    differ.lost
}

impl File {
    fn read(path: &Path) -> Self {
        let bytes = std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        let (json, chunk) = if bytes.starts_with(b"glTF") {
            let end = 20 + word(12);
            let has_chunk = bytes.len() >= end + 8;
            (bytes[20..end].to_vec(), has_chunk.then(|| bytes[end + 8..][..word(end)].to_vec()))
        } else {
            (bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(&bytes).to_vec(), None)
        };
        let end = json.iter().rposition(|&b| b != 0).map_or(0, |last| last + 1);
        let root: Value = serde_json::from_slice(&json[..end]).unwrap();
        let folder = path.parent().unwrap();
        let mut buffers: Vec<Option<Vec<u8>>> =
            items(&root, "buffers").map(|b| resource(folder, text(b, "uri")?)).collect();
        if let (Some(first), Some(chunk)) = (buffers.first_mut(), chunk) {
            first.get_or_insert(chunk);
        }
        let image = |image: &Value| match text(image, "uri") {
            Some(uri) => resource(folder, uri),
            None => Some(view_in(&root, &buffers, number(image, "bufferView")?)?.to_vec()),
        };
        let images = items(&root, "images").map(image).collect();
        Self { root, buffers, images }
    }

    fn view(&self, index: usize) -> Option<&[u8]> {
        view_in(&self.root, &self.buffers, index)
    }

    /// Type, component type, whether normalised, and the bytes of each element.
    fn accessor(&self, index: usize) -> Option<Elements> {
        let accessor = item(&self.root, "accessors", index)?;
        let component = number(accessor, "componentType")?;
        let width: usize = match component {
            5120 | 5121 => 1,
            5122 | 5123 => 2,
            _ => 4,
        };
        let shape = text(accessor, "type")?;
        let (columns, rows) = match shape {
            "SCALAR" => (1, 1),
            "MAT2" => (2, 2),
            "MAT3" => (3, 3),
            "MAT4" => (4, 4),
            vector => (1, vector.strip_prefix("VEC")?.parse().ok()?),
        };
        let column = if columns == 1 { rows * width } else { (rows * width).div_ceil(4) * 4 };
        let (size, count) = (columns * column, number(accessor, "count")?);
        let offset = |value: &Value| number(value, "byteOffset").unwrap_or(0);
        let mut bytes = vec![0; size * count];
        if let Some(view) = number(accessor, "bufferView") {
            let stride = number(item(&self.root, "bufferViews", view)?, "byteStride").unwrap_or(size);
            let data = self.view(view)?.get(offset(accessor)..)?;
            for at in 0..count {
                bytes[at * size..][..size].copy_from_slice(data.get(at * stride..at * stride + size)?);
            }
        }
        if let Some(sparse) = accessor.get("sparse") {
            let (places, values) = (&sparse["indices"], &sparse["values"]);
            let place_width = match number(places, "componentType")? {
                5121 => 1,
                5123 => 2,
                _ => 4,
            };
            let place_bytes = self.view(number(places, "bufferView")?)?.get(offset(places)..)?;
            let data = self.view(number(values, "bufferView")?)?.get(offset(values)..)?;
            for at in 0..number(sparse, "count")? {
                let place = little_endian(place_bytes.get(at * place_width..(at + 1) * place_width)?);
                bytes.get_mut(place * size..)?.get_mut(..size)?.copy_from_slice(data.get(at * size..(at + 1) * size)?);
            }
        }
        let kind = format!("{shape} {component} {}", accessor.get("normalized") == Some(&Value::Bool(true)));
        Some(Elements { kind, size, width, bytes })
    }
}

/// The elements of an accessor.
#[derive(PartialEq)]
struct Elements {
    kind: String,
    size: usize,
    width: usize,
    bytes: Vec<u8>,
}

impl Elements {
    fn get(&self, index: usize) -> &[u8] {
        &self.bytes[index * self.size..][..self.size]
    }

    fn count(&self) -> usize {
        self.bytes.len() / self.size
    }

    fn integers(&self) -> Vec<usize> {
        self.bytes.chunks_exact(self.width).map(little_endian).collect()
    }
}

fn little_endian(bytes: &[u8]) -> usize {
    bytes.iter().rev().fold(0, |sum, &byte| sum << 8 | usize::from(byte))
}

fn items<'a>(value: &'a Value, name: &str) -> impl Iterator<Item = &'a Value> {
    value.get(name).and_then(Value::as_array).into_iter().flatten()
}

fn item<'a>(value: &'a Value, name: &str, index: usize) -> Option<&'a Value> {
    value.get(name)?.get(index)
}

fn number(value: &Value, name: &str) -> Option<usize> {
    value.get(name)?.as_f64().map(|x| x as usize)
}

fn text<'a>(value: &'a Value, name: &str) -> Option<&'a str> {
    value.get(name)?.as_str()
}

fn view_in<'a>(root: &Value, buffers: &'a [Option<Vec<u8>>], index: usize) -> Option<&'a [u8]> {
    let view = item(root, "bufferViews", index)?;
    let start = number(view, "byteOffset").unwrap_or(0);
    buffers.get(number(view, "buffer")?)?.as_ref()?.get(start..start + number(view, "byteLength")?)
}

/// What a URI names: data, or a file below the scene's own folder.
fn resource(folder: &Path, uri: &str) -> Option<Vec<u8>> {
    if let Some((head, body)) = uri.strip_prefix("data:").and_then(|data| data.split_once(',')) {
        return if head.ends_with(";base64") { base64(body) } else { Some(unescaped(body)) };
    }
    let relative = String::from_utf8(unescaped(uri)).ok()?.replace('\\', "/");
    if relative.contains(':') || relative.starts_with('/') || relative.split('/').any(|part| part == "..") {
        return None;
    }
    std::fs::read(folder.join(relative)).ok()
}

fn unescaped(text: &str) -> Vec<u8> {
    let mut out = Vec::new();
    let mut rest = text.as_bytes();
    while let Some((&first, tail)) = rest.split_first() {
        let escape = (first == b'%').then(|| tail.get(..2)).flatten();
        match escape.and_then(|hex| u8::from_str_radix(std::str::from_utf8(hex).ok()?, 16).ok()) {
            Some(byte) => (out.push(byte), rest = &tail[2..]).1,
            None => (out.push(first), rest = tail).1,
        }
    }
    out
}

/// Decodes RFC 4648.
pub(crate) fn base64(text: &str) -> Option<Vec<u8>> {
    const DIGITS: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let digits: Option<Vec<u32>> = text
        .bytes()
        .filter(|byte| !byte.is_ascii_whitespace() && *byte != b'=')
        .map(|byte| DIGITS.iter().position(|&digit| digit == byte).map(|at| at as u32))
        .collect();
    let decode = |four: &[u32]| {
        let bits = four.iter().enumerate().fold(0, |sum, (at, digit)| sum | digit << (18 - 6 * at));
        bits.to_be_bytes()[1..four.len()].to_vec()
    };
    Some(digits?.chunks(4).flat_map(decode).collect())
}

struct Differ {
    a: File,
    b: File,
    allowed: Allowed,
    lost: Vec<String>,
}

/// Lists whose elements are compared by rules of their own, and what only says where data lie.
const SPECIAL: [&str; 11] = [
    "accessors",
    "bufferViews",
    "buffers",
    "images",
    "meshes",
    "nodes",
    "materials",
    "skins",
    "animations",
    "extensionsUsed",
    "extensionsRequired",
];

/// Extensions that a bake may undo, because it says the same without them.
const UNDONE: [&str; 4] =
    ["EXT_mesh_gpu_instancing", "KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression"];

impl Differ {
    fn compare(&mut self) {
        let (a, b) = (self.a.root.clone(), self.b.root.clone());
        let root = a.as_object().expect("an object");
        for (name, value) in root.iter().filter(|(name, _)| !SPECIAL.contains(&name.as_str())) {
            let made = b.get(name).unwrap_or(&Value::Null);
            match (value, made) {
                // The bake's own textures, samplers and so on are behind those of the file.
                (Value::Array(old), Value::Array(new))
                    if ["textures", "samplers", "scenes", "cameras"].contains(&name.as_str()) =>
                {
                    self.prefix(name, old, new);
                }
                _ => self.covers(name, value, made),
            }
        }
        for name in ["extensionsUsed", "extensionsRequired"] {
            let made: BTreeSet<String> = items(&b, name).map(ToString::to_string).collect();
            let gone = items(&a, name).filter(|one| !UNDONE.contains(&one.as_str().unwrap_or("")));
            self.note_all(gone.filter(|one| !made.contains(&one.to_string())).map(|one| format!("{name}: {one}")));
        }
        self.images(&a, &b);
        self.materials(&a, &b);
        let pairs = self.nodes(&a, &b);
        self.skins_and_animations(&a, &b);
        for (old, new) in pairs {
            self.mesh(&a, &b, old, new);
        }
    }

    fn note(&mut self, line: impl Into<String>) {
        self.lost.push(line.into());
    }

    fn note_all(&mut self, lines: impl Iterator<Item = String>) {
        self.lost.extend(lines);
    }

    /// The elements of a list are the first of another.
    fn prefix(&mut self, place: &str, old: &[Value], new: &[Value]) {
        for (at, value) in old.iter().enumerate() {
            self.covers(&format!("{place}[{at}]"), value, new.get(at).unwrap_or(&Value::Null));
        }
    }

    /// Whatever a value says, another says too.
    fn covers(&mut self, place: &str, old: &Value, new: &Value) {
        match (old, new) {
            (Value::Object(old), Value::Object(new)) => self.members(place, old, new, &[]),
            (Value::Array(old), Value::Array(new)) if old.len() == new.len() => self.prefix(place, old, new),
            (Value::Number(old), Value::Number(new)) if old.as_f64() == new.as_f64() => {}
            _ if old == new => {}
            _ => self.note(format!("{place}: {} became {}", brief(old), brief(new))),
        }
    }

    fn members(&mut self, place: &str, old: &Map<String, Value>, new: &Map<String, Value>, except: &[&str]) {
        for (name, value) in old.iter().filter(|(name, _)| !except.contains(&name.as_str())) {
            self.covers(&format!("{place}.{name}"), value, new.get(name).unwrap_or(&Value::Null));
        }
    }

    fn object(&mut self, place: &str, old: &Value, new: &Value, except: &[&str]) {
        match (old, new) {
            (Value::Object(old), Value::Object(new)) => self.members(place, old, new, except),
            _ => self.note(format!("{place} is missing")),
        }
    }

    fn images(&mut self, a: &Value, b: &Value) {
        for (at, (old, new)) in pairs(a, b, "images").enumerate() {
            let place = format!("images[{at}]");
            match (self.a.images[at].is_some(), self.a.images[at] == self.b.images.get(at).cloned().flatten()) {
                (true, false) => self.note(format!("{place}: other bytes")),
                (true, true) => self.object(&place, old, new, &["uri", "bufferView", "mimeType"]),
                (false, _) => self.object(&place, old, new, &[]),
            }
        }
    }

    fn materials(&mut self, a: &Value, b: &Value) {
        for (at, (old, new)) in pairs(a, b, "materials").enumerate() {
            self.material(&format!("materials[{at}]"), old, new);
        }
    }

    fn material(&mut self, place: &str, old: &Value, new: &Value) {
        let except: &[&str] = if self.allowed.occlusion { &["occlusionTexture"] } else { &[] };
        self.object(place, old, new, except);
    }

    /// Compares nodes. Gives pairs of a mesh and the mesh that is drawn for it.
    fn nodes(&mut self, a: &Value, b: &Value) -> BTreeSet<(usize, usize)> {
        let mut meshes: BTreeSet<(usize, usize)> = items(a, "meshes").enumerate().map(|(at, _)| (at, at)).collect();
        for (at, (old, new)) in pairs(a, b, "nodes").enumerate() {
            let place = format!("nodes[{at}]");
            let copies = old.get("extensions").and_then(|all| all.get("EXT_mesh_gpu_instancing"));
            let copies = copies.filter(|_| new.get("mesh").is_none());
            let except = if copies.is_some() { &["children", "mesh", "extensions"][..] } else { &["children", "mesh"] };
            self.object(&place, old, new, except);
            let children: Vec<usize> =
                items(new, "children").filter_map(|child| Some(child.as_u64()? as usize)).collect();
            let kept = items(old, "children").filter_map(|child| Some(child.as_u64()? as usize));
            self.note_all(
                kept.filter(|child| !children.contains(child)).map(|child| format!("{place}: child {child}")),
            );
            match (number(old, "mesh"), number(new, "mesh"), copies) {
                (Some(old), Some(new), _) => drop(meshes.insert((old, new))),
                (None, None, _) => {}
                (Some(mesh), None, Some(copies)) => {
                    let counts = copies["attributes"].as_object().into_iter().flat_map(Map::values);
                    let count =
                        counts.filter_map(|at| number(item(a, "accessors", at.as_u64()? as usize)?, "count")).max();
                    let drawn: Vec<usize> =
                        children.iter().filter_map(|&child| number(item(b, "nodes", child)?, "mesh")).collect();
                    if drawn.len() < count.unwrap_or(0) {
                        self.note(format!("{place}: {count:?} copies became {}", drawn.len()));
                    }
                    meshes.extend(drawn.into_iter().map(|new| (mesh, new)));
                }
                _ => self.note(format!("{place}: its mesh")),
            }
        }
        meshes
    }

    fn skins_and_animations(&mut self, a: &Value, b: &Value) {
        for (at, (old, new)) in pairs(a, b, "skins").enumerate() {
            let place = format!("skins[{at}]");
            self.object(&place, old, new, &["inverseBindMatrices"]);
            self.same_accessor(&place, number(old, "inverseBindMatrices"), number(new, "inverseBindMatrices"));
        }
        for (at, (old, new)) in pairs(a, b, "animations").enumerate() {
            let place = format!("animations[{at}]");
            self.object(&place, old, new, &["samplers"]);
            for (old, new) in pairs(old, new, "samplers") {
                self.object(&place, old, new, &["input", "output"]);
                for end in ["input", "output"] {
                    self.same_accessor(&place, number(old, end), number(new, end));
                }
            }
        }
    }

    fn same_accessor(&mut self, place: &str, old: Option<usize>, new: Option<usize>) {
        let Some(old) = old.and_then(|at| self.a.accessor(at)) else { return };
        if new.and_then(|at| self.b.accessor(at)) != Some(old) {
            self.note(format!("{place}: other numbers"));
        }
    }

    fn mesh(&mut self, a: &Value, b: &Value, old: usize, new: usize) {
        let place = format!("meshes[{old}]");
        let (Some(mesh), Some(made)) = (item(a, "meshes", old), item(b, "meshes", new)) else {
            return self.note(format!("{place} is missing"));
        };
        self.object(&place, mesh, made, &["primitives"]);
        if items(mesh, "primitives").count() != items(made, "primitives").count() {
            self.note(format!("{place}: another number of primitives"));
        }
        for (at, (one, other)) in pairs(mesh, made, "primitives").enumerate() {
            let place = format!("{place} primitive {at}");
            self.object(&place, one, other, &["attributes", "targets", "indices", "material", "mode", "extensions"]);
            self.extensions_of_primitive(&place, one, other);
            if let Some(index) = number(one, "material") {
                let material = |root: &Value, index: Option<usize>| {
                    index.and_then(|index| item(root, "materials", index).cloned()).unwrap_or_default()
                };
                let (old, new) = (material(a, Some(index)), material(b, number(other, "material")));
                if !old.is_null() {
                    self.material(&format!("{place}: material"), &old, &new);
                }
            }
            self.corners(&place, one, other);
        }
    }

    /// Materials of variants are compared elsewhere; Draco may be gone.
    fn extensions_of_primitive(&mut self, place: &str, one: &Value, other: &Value) {
        for (name, value) in one.get("extensions").and_then(Value::as_object).into_iter().flatten() {
            let made = other.get("extensions").and_then(|all| all.get(name)).unwrap_or(&Value::Null);
            match name.as_str() {
                "KHR_draco_mesh_compression" => {}
                "KHR_materials_variants" => {
                    for (old, new) in pairs(value, made, "mappings") {
                        self.object(place, old, new, &["material"]);
                    }
                }
                _ => self.covers(&format!("{place}.{name}"), value, made),
            }
        }
    }

    /// Every corner of every triangle, line or point has the attributes it had.
    fn corners(&mut self, place: &str, one: &Value, other: &Value) {
        let (Some(old), Some(new)) = (order(&self.a, one), order(&self.b, other)) else { return };
        if old.len() != new.len() {
            return self.note(format!("{place}: {} corners became {}", old.len(), new.len()));
        }
        let targets = items(one, "targets").count();
        if targets != items(other, "targets").count() {
            return self.note(format!("{place}: morph targets"));
        }
        let map = |value: Option<&Value>| value.and_then(Value::as_object).cloned().unwrap_or_default();
        let mut attributes = vec![(String::new(), [map(one.get("attributes")), map(other.get("attributes"))])];
        for (at, (old, new)) in pairs(one, other, "targets").enumerate() {
            attributes.push((format!(" target {at}"), [map(Some(old)), map(Some(new))]));
        }
        let mut known: BTreeMap<usize, Option<Elements>> = BTreeMap::new();
        for (which, [of_old, of_new]) in attributes {
            for (name, accessor) in &of_old {
                let Some(accessor) = accessor.as_f64().map(|x| x as usize) else { continue };
                let Some(before) = known.entry(accessor).or_insert_with(|| self.a.accessor(accessor)) else { continue };
                let after = of_new.get(name).and_then(Value::as_f64).and_then(|at| self.b.accessor(at as usize));
                let problem = match &after {
                    None => Some("is missing".to_owned()),
                    Some(after) if after.kind != before.kind => Some(format!("{} became {}", before.kind, after.kind)),
                    Some(after) => old.iter().zip(&new).find_map(|(&old, &new)| {
                        let is_there = old < before.count() && new < after.count();
                        let differs = if is_there { before.get(old) != after.get(new) } else { old < before.count() };
                        differs.then(|| format!("differs, vertex {old} now {new}"))
                    }),
                };
                if let Some(problem) = problem {
                    self.lost.push(format!("{place}{which} {name} {problem}"));
                }
            }
        }
    }
}

/// The vertices of a primitive's corners in the order in which they are drawn, strips and fans as triangles.
fn order(file: &File, primitive: &Value) -> Option<Vec<usize>> {
    let listed = match number(primitive, "indices") {
        Some(accessor) => file.accessor(accessor)?.integers(),
        None => {
            let attributes = primitive.get("attributes")?.as_object()?;
            let position = attributes.get("POSITION").or_else(|| attributes.values().next())?.as_f64()? as usize;
            (0..number(item(&file.root, "accessors", position)?, "count")?).collect()
        }
    };
    let count = listed.len().saturating_sub(2);
    Some(match number(primitive, "mode").unwrap_or(4) {
        4 => listed[..listed.len() / 3 * 3].to_vec(),
        5 => (0..count)
            .flat_map(|i| match i % 2 {
                0 => [listed[i], listed[i + 1], listed[i + 2]],
                _ => [listed[i], listed[i + 2], listed[i + 1]],
            })
            .collect(),
        6 => (0..count).flat_map(|i| [listed[i + 1], listed[i + 2], listed[0]]).collect(),
        _ => listed,
    })
}

/// The elements of two lists of one name; null where the second is too short.
fn pairs<'v>(a: &'v Value, b: &'v Value, name: &'v str) -> impl Iterator<Item = (&'v Value, &'v Value)> {
    let made: Vec<&Value> = items(b, name).collect();
    items(a, name).enumerate().map(move |(at, old)| (old, made.get(at).copied().unwrap_or(&Value::Null)))
}

fn brief(value: &Value) -> String {
    value.to_string().chars().take(80).collect()
}
