//! Meshes: those of the file, with what was baked for their primitives. A mesh whose nodes need different data is
//! copied for all of them but the first; so is one that other nodes draw, which were not baked, if its data are a
//! node's own.

use super::additions::Additions;
use super::binary::Binary;
use super::nodes::remove_extension;
use super::references::{self, DRACO, items};
use super::streams::{Split, Stream};
use super::{WrittenPlace, counted, index, list, materials};
use crate::scene::{Mesh, PackedElements, Scene, SceneFile};
use crate::settings::VertexAttribute;
use glam::{Vec2, Vec4};
use serde_json::{Map, Value, json};
use std::collections::{BTreeMap, BTreeSet};

/// Where the parts of a scene are in its file.
pub(super) struct FilePlaces {
    /// For each of [`Scene::nodes`], its node.
    pub nodes: Vec<usize>,
    /// For each of [`Scene::instances`], its mesh, and its primitive within that mesh.
    pub primitives: Vec<(usize, usize)>,
}

/// What was written.
pub(super) struct Written {
    /// For each instance, where it is.
    pub places: Vec<WrittenPlace>,
    /// For each instance with baked data, the mesh that was written for it.
    pub mesh_of_instance: Vec<Option<usize>>,
    pub not_kept: Vec<String>,
}

/// A primitive of the file as one of [`Scene::meshes`]: a mesh that nodes pose differently has several.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Part {
    primitive: usize,
    scene_mesh: usize,
    /// The instance, if its data are its own.
    instance: Option<usize>,
}

/// What a node draws: a mesh of the file, and the parts of it with baked data.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
struct Drawn {
    mesh: usize,
    parts: Vec<Part>,
}

pub(super) fn write(
    scene: &Scene,
    file: &SceneFile,
    at: &FilePlaces,
    additions: &Additions,
    root: &mut Value,
    binary: &mut Binary,
) -> Written {
    let drawn = drawn_by_nodes(scene, at, additions);
    let written = written_meshes(&drawn, root, additions);
    let mut writer = Writer {
        scene,
        additions,
        file,
        binary,
        streams: streams(scene, file, &drawn, additions),
        rewritten: BTreeMap::new(),
        coordinates: BTreeMap::new(),
        not_kept: BTreeMap::new(),
    };
    writer.free_what_is_replaced(&written);
    let sources = std::mem::take(list(root, "meshes"));
    let mut meshes = sources.clone();
    let mut sets = BTreeMap::new();
    for (one, &index) in in_order(&written) {
        let mut mesh = sources.get(one.mesh).cloned().unwrap_or_default();
        for part in &one.parts {
            let primitive = mesh.get_mut("primitives").and_then(|list| list.get_mut(part.primitive));
            let Some(primitive) = primitive else { continue };
            let set = writer.write_part(one.mesh, part, primitive, root);
            sets.insert((index, part.primitive), set);
        }
        match meshes.get_mut(index) {
            Some(own) => *own = mesh,
            None => meshes.push(mesh),
        }
    }
    *list(root, "meshes") = meshes;
    let nodes = list(root, "nodes");
    for (&node, one) in &drawn {
        nodes[node]["mesh"] = json!(written.get(one).copied().unwrap_or(one.mesh));
    }
    let mut places = Vec::with_capacity(scene.instances.len());
    let mut mesh_of_instance = Vec::with_capacity(scene.instances.len());
    for (instance, &(mesh, primitive)) in scene.instances.iter().zip(&at.primitives) {
        let node = at.nodes[instance.node];
        let mesh = written.get(&drawn[&node]).copied().unwrap_or(mesh);
        let set = sets.get(&(mesh, primitive)).copied();
        places.push(WrittenPlace { node, primitive, uv_set: set.unwrap_or(1) as u32 });
        mesh_of_instance.push(set.map(|_| mesh));
    }
    Written { places, mesh_of_instance, not_kept: writer.notes() }
}

/// Written meshes by index.
fn in_order(written: &BTreeMap<Drawn, usize>) -> Vec<(&Drawn, &usize)> {
    let mut all: Vec<_> = written.iter().collect();
    all.sort_by_key(|(_, index)| **index);
    all
}

/// For each node of the file that is drawn, what it draws.
fn drawn_by_nodes(scene: &Scene, at: &FilePlaces, additions: &Additions) -> BTreeMap<usize, Drawn> {
    let mut drawn: BTreeMap<usize, Drawn> = BTreeMap::new();
    for (index, (instance, &(mesh, primitive))) in scene.instances.iter().zip(&at.primitives).enumerate() {
        let node = drawn.entry(at.nodes[instance.node]).or_insert(Drawn { mesh, parts: Vec::new() });
        if additions.concern(scene, index) {
            let instance_of = additions.is_per_instance().then_some(index);
            node.parts.push(Part { primitive, scene_mesh: instance.mesh, instance: instance_of });
        }
    }
    drawn
}

/// The mesh that is written for each thing drawn with baked data: the file's own for the first, else one behind the
/// last.
fn written_meshes(drawn: &BTreeMap<usize, Drawn>, root: &Value, additions: &Additions) -> BTreeMap<Drawn, usize> {
    let mut taken = BTreeSet::new();
    if additions.is_per_instance() {
        let is_baked = |node: usize| drawn.get(&node).is_some_and(|one| !one.parts.is_empty());
        let others = items(root, "nodes").enumerate().filter(|(node, _)| !is_baked(*node));
        taken.extend(others.filter_map(|(_, node)| index(node, "mesh")));
    }
    let mut next = items(root, "meshes").count();
    let mut written = BTreeMap::new();
    for one in drawn.values().filter(|one| !one.parts.is_empty()) {
        if written.contains_key(one) {
            continue;
        }
        let index = if taken.insert(one.mesh) { one.mesh } else { next };
        next += usize::from(index == next);
        written.insert(one.clone(), index);
    }
    written
}

/// Mesh and primitive in the file, and the mesh in the scene.
type StreamKey = (usize, usize, usize);

fn streams(
    scene: &Scene,
    file: &SceneFile,
    drawn: &BTreeMap<usize, Drawn>,
    additions: &Additions,
) -> BTreeMap<StreamKey, Stream> {
    let root = file.json();
    let mut users: BTreeMap<usize, u32> = BTreeMap::new();
    let positions_of = |primitive: &Value| index(primitive.get("attributes")?, "POSITION");
    for position in references::primitives(root).filter_map(|(.., primitive)| positions_of(primitive)) {
        *users.entry(position).or_default() += 1;
    }
    let mut streams = BTreeMap::new();
    for (one, part) in drawn.values().flat_map(|one| one.parts.iter().map(move |part| (one, part))) {
        streams.entry((one.mesh, part.primitive, part.scene_mesh)).or_insert_with(|| {
            let mesh = &scene.meshes[part.scene_mesh];
            let primitive = root["meshes"][one.mesh]["primitives"].get(part.primitive).unwrap_or(&Value::Null);
            let position = positions_of(primitive);
            let count = position.and_then(|at| index(root["accessors"].get(at)?, "count"));
            let least = mesh.file_vertices.iter().max().map_or(mesh.positions.len(), |&last| last as usize + 1);
            let count = count.unwrap_or(0).max(least);
            let shares = position.and_then(|at| users.get(&at)).is_some_and(|&users| users > 1);
            let triangles = || file.triangles(primitive, count).unwrap_or_default();
            Stream::new(mesh, &additions.layout(scene, part.scene_mesh), count, shares, triangles)
        });
    }
    streams
}

/// A primitive's new attributes, targets and indices.
struct Rewritten {
    attributes: Map<String, Value>,
    targets: Option<Value>,
    indices: usize,
}

struct Writer<'w, 'f> {
    scene: &'w Scene,
    additions: &'w Additions<'w>,
    file: &'w SceneFile,
    binary: &'w mut Binary<'f>,
    streams: BTreeMap<StreamKey, Stream>,
    rewritten: BTreeMap<StreamKey, Rewritten>,
    /// Accessors of coordinates that instances share.
    coordinates: BTreeMap<StreamKey, usize>,
    /// What is lost, and how often.
    not_kept: BTreeMap<String, usize>,
}

impl Writer<'_, '_> {
    /// Says what the primitives that stay in their place will replace.
    fn free_what_is_replaced(&mut self, written: &BTreeMap<Drawn, usize>) {
        let mut replaced = BTreeSet::new();
        for (one, part) in in_order(written)
            .into_iter()
            .filter(|(one, index)| one.mesh == **index)
            .flat_map(|(one, _)| one.parts.iter().map(move |part| (one, part)))
        {
            let Some(split) = &self.streams[&(one.mesh, part.primitive, part.scene_mesh)].split else { continue };
            let primitive = &self.file.json()["meshes"][one.mesh]["primitives"][part.primitive];
            let indices = index(primitive, "indices");
            let is_replaced = |at: &usize| indices == Some(*at) || packed(self.file, *at, split.file_count).is_some();
            let accessors = references::accessors_of(primitive).filter(is_replaced);
            replaced.extend(accessors.map(|accessor| (one.mesh, part.primitive, accessor)));
        }
        self.binary.free(self.file.json(), |mesh, primitive, at| replaced.contains(&(mesh, primitive, at)));
    }

    /// Gives a primitive its baked data. Returns the set of its baked coordinates.
    fn write_part(&mut self, mesh: usize, part: &Part, primitive: &mut Value, root: &Value) -> usize {
        let key = (mesh, part.primitive, part.scene_mesh);
        self.split(key, primitive);
        let object = primitive.as_object_mut();
        if object.is_some_and(|object| remove_extension(object, DRACO)) {
            *self.not_kept.entry(format!("{DRACO} is gone")).or_default() += 1;
        }
        match self.additions {
            Additions::Nothing => BAKED_SET,
            Additions::Coordinates { .. } => self.add_coordinates(key, part, primitive, root),
            Additions::VertexVisibility { attribute, visibility } => {
                let of_instance = part.instance.map_or(&[][..], |instance| &visibility[instance]);
                let accessor = self.add_visibility(key, *attribute, of_instance);
                primitive["attributes"][attribute.name()] = json!(accessor);
                BAKED_SET
            }
        }
    }

    /// Gives a primitive the vertices and triangles of its stream.
    fn split(&mut self, key: StreamKey, primitive: &mut Value) {
        let Some(split) = &self.streams[&key].split else { return };
        if !self.rewritten.contains_key(&key) {
            let rewritten = rewrite(self.file, self.binary, split, primitive, &mut self.not_kept);
            self.rewritten.insert(key, rewritten);
        }
        let Rewritten { attributes, targets, indices } = &self.rewritten[&key];
        primitive["attributes"] = attributes.clone().into();
        if let Some(targets) = targets {
            primitive["targets"] = targets.clone();
        }
        primitive["indices"] = json!(indices);
        if index(primitive, "mode").is_some_and(|mode| mode != TRIANGLES) {
            primitive["mode"] = json!(TRIANGLES);
            *self.not_kept.entry("strips and fans are lists of triangles".into()).or_default() += 1;
        }
    }

    /// Adds texture coordinates, unless the file has the same. Returns their set.
    fn add_coordinates(&mut self, key: StreamKey, part: &Part, primitive: &mut Value, root: &Value) -> usize {
        let (stream, mesh) = (&self.streams[&key], &self.scene.meshes[part.scene_mesh]);
        let layout = self.additions.layout(self.scene, part.scene_mesh);
        let uvs = self.additions.coordinates(self.scene, part.scene_mesh, part.instance);
        if stream.split.is_none() && has_same(mesh, &layout.vertices, &uvs) {
            return BAKED_SET;
        }
        let binary = &mut *self.binary;
        let mut add = || {
            let mut all = vec![[0.0; 2]; stream.len];
            stream.slots.iter().zip(&*uvs).for_each(|(&slot, uv)| all[slot as usize] = uv.to_array());
            binary.add_vectors(None, &all)
        };
        let accessor = match part.instance {
            None => *self.coordinates.entry(key).or_insert_with(add),
            Some(_) => add(),
        };
        let name = |set: usize| format!("TEXCOORD_{set}");
        let last_read = materials::materials_of(primitive)
            .filter_map(|material| materials::last_texcoord(root.get("materials")?.get(material)?))
            .max();
        let attributes = &mut primitive["attributes"];
        // A set that a texture reads and the file has not is zero: it stays so.
        for set in (0..last_read.map_or(0, |last| last + 1))
            .filter(|&set| attributes.get(name(set)).is_none())
            .collect::<Vec<_>>()
        {
            attributes[name(set)] = json!(self.binary.add_zero_texcoords(stream.len));
        }
        if attributes.get(name(0)).is_none() {
            attributes[name(0)] = json!(accessor);
        }
        let set = (BAKED_SET..).find(|&set| attributes.get(name(set)).is_none()).unwrap_or(BAKED_SET);
        attributes[name(set)] = json!(accessor);
        set
    }

    /// Adds ambient visibility of vertices. Returns the accessor.
    fn add_visibility(&mut self, key: StreamKey, attribute: VertexAttribute, visibility: &[f32]) -> usize {
        let (stream, mesh) = (&self.streams[&key], &self.scene.meshes[key.2]);
        let placed = stream.slots.iter().zip(visibility);
        match attribute {
            VertexAttribute::Ao => {
                let mut all = vec![[1.0]; stream.len];
                placed.for_each(|(&slot, &open)| all[slot as usize] = [open]);
                self.binary.add_vectors(None, &all)
            }
            VertexAttribute::Color => {
                let mut all = vec![[1.0; 4]; stream.len];
                for (vertex, (&slot, &open)) in placed.enumerate() {
                    let color = mesh.colors.as_ref().map_or(Vec4::ONE, |colors| colors[vertex]);
                    all[slot as usize] = (color.truncate() * open).extend(color.w).to_array();
                }
                self.binary.add_vectors(None, &all)
            }
        }
    }

    fn notes(self) -> Vec<String> {
        self.not_kept.into_iter().map(|(what, count)| format!("{what}, of {}", counted(count, "primitive"))).collect()
    }
}

/// The set of baked coordinates, where it is free.
const BAKED_SET: usize = 1;
/// The mode of a primitive that is a list of triangles.
const TRIANGLES: usize = 4;

/// Whether the file's own set holds these coordinates already.
fn has_same(mesh: &Mesh, vertices: &[u32], uvs: &[Vec2]) -> bool {
    let Some(own) = mesh.texcoord_set(BAKED_SET) else { return false };
    vertices.iter().zip(uvs).all(|(&vertex, uv)| own[vertex as usize] == *uv)
}

/// The elements of an attribute, if it has one for each vertex.
fn packed(file: &SceneFile, accessor: usize, count: usize) -> Option<PackedElements> {
    let declared = index(file.json().get("accessors")?.get(accessor)?, "count")?;
    (declared == count).then(|| file.packed(accessor).ok()).flatten()
}

fn rewrite(
    file: &SceneFile,
    binary: &mut Binary,
    split: &Split,
    primitive: &Value,
    not_kept: &mut BTreeMap<String, usize>,
) -> Rewritten {
    let mut known = BTreeMap::new();
    let mut all = |object: &Map<String, Value>| -> Map<String, Value> {
        let one = |(name, accessor): (&String, &Value)| {
            let old = accessor.as_u64()? as usize;
            let new = *known.entry(old).or_insert_with(|| copy_elements(file, binary, split, old));
            if new.is_none() {
                *not_kept.entry(format!("{name} cannot be read, and is gone")).or_default() += 1;
            }
            Some((name.clone(), json!(new?)))
        };
        object.iter().filter_map(one).collect()
    };
    let attributes = primitive.get("attributes").and_then(Value::as_object).map(&mut all).unwrap_or_default();
    let targets = primitive.get("targets").and_then(Value::as_array);
    let targets =
        targets.map(|list| list.iter().map(|target| target.as_object().map(&mut all)).map(|t| json!(t)).collect());
    Rewritten { attributes, targets, indices: binary.add_indices(index(primitive, "indices"), &split.indices) }
}

/// An accessor with the elements of the vertices of a stream.
fn copy_elements(file: &SceneFile, binary: &mut Binary, split: &Split, old: usize) -> Option<usize> {
    let mut accessor = file.json().get("accessors")?.get(old)?.clone();
    let PackedElements { bytes, size } = packed(file, old, split.file_count)?;
    let object = accessor.as_object_mut()?;
    let has_data = object.contains_key("bufferView") || object.contains_key("sparse");
    ["byteOffset", "sparse"].iter().for_each(|key| drop(object.remove(*key)));
    object.insert("count".into(), json!(split.sources.len()));
    if has_data {
        let elements = || split.sources.iter().map(|&vertex| &bytes[vertex as usize * size..][..size]);
        if split.is_part && object.contains_key("min") {
            let kept: Vec<u8> = elements().flatten().copied().collect();
            let range = SceneFile::stored_range(object, &kept);
            object.extend(range.into_iter().flatten());
        }
        object.insert("bufferView".into(), json!(binary.add_elements(elements(), size)));
    }
    Some(binary.put_accessor(Some(old), accessor))
}
