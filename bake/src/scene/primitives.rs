//! Drawn meshes: every primitive that some node draws, read once, triangulated, posed and cleaned.

use super::{
    Dropped, LoadError, Mesh,
    accessors::Reader,
    document::{self, JsonPrimitive, place},
    limits::WarningLog,
    nodes::{NodeTree, label},
    normals,
    pose::{Pose, Skeletons},
    refuse,
    triangles::{self, Topology},
};
use glam::{Vec2, Vec3, Vec4};
use std::collections::{HashMap, hash_map::Entry};

/// Meshes that some node draws.
#[derive(Default)]
pub(super) struct DrawnMeshes {
    pub meshes: Vec<Mesh>,
    /// For each mesh, its material's index in the file; none: the default material.
    pub file_material: Vec<Option<usize>>,
    /// Pairs of a node and a mesh (both indices in the scene), in node order.
    pub draws: Vec<(usize, usize)>,
    pub dropped: Dropped,
}

/// A mesh of the file and, if a node poses it (skin or morph weights), that node.
type PosedMesh = (usize, Option<usize>);

/// Sets of texture coordinates that are read.
const TEXCOORDS: [&str; 8] =
    ["TEXCOORD_0", "TEXCOORD_1", "TEXCOORD_2", "TEXCOORD_3", "TEXCOORD_4", "TEXCOORD_5", "TEXCOORD_6", "TEXCOORD_7"];

/// Memory that an instance takes, here and in later steps.
const BYTES_PER_DRAW: u64 = 256;

/// Memory of a primitive beside its vertices. Counting it bounds the work that a small file can cause.
const BYTES_PER_PRIMITIVE: u64 = 1024;

/// Reads every mesh that the nodes of a tree draw.
pub(super) fn read(reader: Reader, tree: &NodeTree, log: &mut WarningLog) -> Result<DrawnMeshes, LoadError> {
    let mut drawn = DrawnMeshes::default();
    let mut known: HashMap<PosedMesh, Vec<usize>> = HashMap::new();
    let mut skeletons = Skeletons::default();
    for (node, (placed, &mesh)) in tree.nodes.iter().zip(&tree.mesh).enumerate() {
        let (Some(file), Some(mesh_index)) = (tree.file_node(placed), mesh) else { continue };
        let is_posed = file.skin.is_some() || file.weights.is_some();
        let meshes = match known.entry((mesh_index, is_posed.then_some(node))) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(new) => {
                if file.skin.is_some() {
                    log.warn("its skin was baked in its rest pose", label(file, placed.gltf));
                }
                let of_node = |error: LoadError| error.used_as("mesh", label(file, placed.gltf));
                let mesh: document::JsonMesh = reader.doc.get(mesh_index).map_err(of_node)?;
                let pose = match is_posed {
                    true => Pose::of_node(reader, tree, &mut skeletons, node, &mesh)?,
                    false => Pose::of_mesh(&mesh),
                };
                new.insert(drawn.read_mesh(reader, mesh_index, &mesh, &pose, log)?)
            }
        };
        reader
            .budget
            .take(meshes.len() as u64, BYTES_PER_DRAW, || format!("drawing meshes[{mesh_index}] that often"))?;
        drawn.draws.extend(meshes.iter().map(|&mesh| (node, mesh)));
    }
    Ok(drawn)
}

impl DrawnMeshes {
    /// Reads the primitives of a mesh; returns their indices in [`DrawnMeshes::meshes`].
    fn read_mesh(
        &mut self,
        reader: Reader,
        index: usize,
        mesh: &document::JsonMesh,
        pose: &Pose,
        log: &mut WarningLog,
    ) -> Result<Vec<usize>, LoadError> {
        let mut made = Vec::new();
        for (at, primitive) in mesh.primitives.iter().flatten().enumerate() {
            let name = mesh.name.as_ref().map_or_else(String::new, |name| format!(" \"{name}\""));
            let place = format!("{}{name} primitive {at}", place::<document::JsonMesh>(index));
            reader.budget.take(1, BYTES_PER_PRIMITIVE, || place.clone())?;
            let material = known_material(reader, primitive, &place, log);
            let source = PrimitiveReader { reader, primitive, pose, place: &place, material };
            if let Some(mut read) = source.read(&mut self.dropped, log)? {
                read.name.clone_from(&mesh.name);
                read.gltf = (index, at);
                made.push(self.meshes.len());
                self.meshes.push(read);
                self.file_material.push(material);
            }
        }
        Ok(made)
    }
}

fn known_material(reader: Reader, primitive: &JsonPrimitive, place: &str, log: &mut WarningLog) -> Option<usize> {
    let index = primitive.material?;
    if index < reader.doc.count::<document::JsonMaterial>() {
        return Some(index);
    }
    log.warn("its material does not exist; the default material is used", place);
    None
}

struct PrimitiveReader<'a> {
    reader: Reader<'a>,
    primitive: &'a JsonPrimitive,
    pose: &'a Pose,
    place: &'a str,
    material: Option<usize>,
}

impl PrimitiveReader<'_> {
    /// `None` if there is no surface.
    fn read(&self, dropped: &mut Dropped, log: &mut WarningLog) -> Result<Option<Mesh>, LoadError> {
        let position = self.primitive.attributes.get("POSITION").copied();
        refuse::check_primitive(self.primitive, position.is_some_and(|accessor| self.reader.has_data(accessor)))?;
        let Some(topology) = Topology::from_mode(self.primitive.mode.unwrap_or(4)) else {
            log.warn("points and lines cast no shadow; left out", self.place);
            return Ok(None);
        };
        let Some(position) = position else {
            log.warn("it has no positions; left out", self.place);
            return Ok(None);
        };
        let read = self.reader.floats(position).map_err(|error| error.used_as("POSITION", self.place))?;
        let mut positions: Vec<Vec3> = read.into_iter().map(Vec3::from_array).collect();
        let indices = self.indices(topology, positions.len())?;
        let mut normals =
            self.optional_attribute("NORMAL", positions.len(), log, |r, at| Ok(vectors(r.floats::<3>(at)?)))?;
        if self.primitive.targets.is_some() {
            log.warn("its morph targets were baked at their default weights", self.place);
        }
        let posed = self.pose.apply(self.reader, self.primitive, &mut positions, normals.as_mut());
        posed.map_err(|error| error.used_as("pose", self.place))?;
        let indices = triangles::clean(&indices, &positions, dropped);
        if indices.is_empty() {
            return Ok(None);
        }
        let (used, indices) = triangles::compact(&indices, positions.len());
        let count = positions.len();
        let positions = gather(&positions, &used);
        let normals = normals.map(|all| normals::repaired(gather(&all, &used), &positions, &indices));
        let texcoords = self.texcoords(count, &used, log)?;
        let colors = self.optional_attribute("COLOR_0", count, log, colors)?.map(|all| gather(&all, &used));
        let is_whole = used.len() == count;
        let file_vertices = if is_whole { Vec::new() } else { used };
        Ok(Some(Mesh { positions, normals, texcoords, colors, indices, file_vertices, ..Mesh::default() }))
    }

    fn indices(&self, topology: Topology, vertex_count: usize) -> Result<Vec<u32>, LoadError> {
        let order: Vec<u32> = match self.primitive.indices {
            Some(accessor) => {
                let read = self.reader.integers::<1>(accessor).map_err(|error| error.used_as("indices", self.place))?;
                read.into_iter().flatten().collect()
            }
            None => (0..vertex_count as u32).collect(),
        };
        triangles::check_range(&order, vertex_count, self.place)?;
        self.reader.budget.take(order.len() as u64, 12, || format!("the triangles of {}", self.place))?;
        Ok(topology.triangulate(&order))
    }

    /// An attribute that shadows do not depend on: if it cannot be read, it is left out with a warning.
    fn optional_attribute<T>(
        &self,
        name: &'static str,
        count: usize,
        log: &mut WarningLog,
        read: impl Fn(Reader, usize) -> Result<Vec<T>, LoadError>,
    ) -> Result<Option<Vec<T>>, LoadError> {
        let Some(&accessor) = self.primitive.attributes.get(name) else { return Ok(None) };
        self.checked(name, count, log, read(self.reader, accessor))
    }

    /// The values of an attribute that were read, if they are as many as the positions.
    fn checked<T>(
        &self,
        name: &'static str,
        count: usize,
        log: &mut WarningLog,
        read: Result<Vec<T>, LoadError>,
    ) -> Result<Option<Vec<T>>, LoadError> {
        match read {
            Ok(values) if values.len() == count => return Ok(Some(values)),
            Err(error @ LoadError::TooLarge { .. }) => return Err(error),
            Ok(_) => log.warn(format!("its {name} has another count than its positions; left out"), self.place),
            Err(error) => log.warn(format!("its {name} cannot be read; left out ({error})"), self.place),
        }
        Ok(None)
    }

    /// Every set of texture coordinates. One that the base colour uses must be readable.
    fn texcoords(&self, count: usize, used: &[u32], log: &mut WarningLog) -> Result<Vec<Option<Vec<Vec2>>>, LoadError> {
        let material = self.material.and_then(|index| self.reader.doc.get::<document::JsonMaterial>(index).ok());
        let wanted = material.and_then(|m| m.base_color().1).map(|info| info.texcoord());
        let mut sets = Vec::new();
        for (set, name) in TEXCOORDS.iter().enumerate() {
            let Some(&accessor) = self.primitive.attributes.get(*name) else { continue };
            let values = match self.reader.floats::<2>(accessor) {
                Err(error) if wanted == Some(set) => return Err(error.used_as(name, self.place)),
                read => self.checked(name, count, log, read)?,
            };
            sets.resize(set, None);
            sets.push(values.map(|all| gather(&all, used).into_iter().map(finite_texcoord).collect()));
        }
        Ok(sets)
    }
}

fn vectors(values: Vec<[f32; 3]>) -> Vec<Vec3> {
    values.into_iter().map(Vec3::from_array).collect()
}

fn finite_texcoord([u, v]: [f32; 2]) -> Vec2 {
    let finite = |x: f32| if x.is_finite() { x } else { 0.0 };
    Vec2::new(finite(u), finite(v))
}

/// RGB or RGBA, clamped to [0, 1] as the specification requires.
fn colors(reader: Reader, accessor: usize) -> Result<Vec<Vec4>, LoadError> {
    let clamped = |c: Vec4| if c.is_finite() { c.clamp(Vec4::ZERO, Vec4::ONE) } else { Vec4::ONE };
    Ok(match reader.lanes(accessor)? {
        3 => vectors(reader.floats::<3>(accessor)?).into_iter().map(|c| clamped(c.extend(1.0))).collect(),
        _ => reader.floats::<4>(accessor)?.into_iter().map(|c| clamped(Vec4::from_array(c))).collect(),
    })
}

/// The entries of an attribute that are used, in their order.
fn gather<T: Copy>(values: &[T], used: &[u32]) -> Vec<T> {
    used.iter().filter_map(|&index| values.get(index as usize).copied()).collect()
}
