//! A static scene, as the baker needs it: every drawn primitive under every node that draws it.
//!
//! # The three spaces
//!
//! Names of matrices and factors say which spaces they connect: `bake_from_object` takes object space to bake space.
//!
//! | space | origin and unit | numbers | used by |
//! |---|---|---|---|
//! | **world** | the file's own; metres | `f64` | nodes, sun and lamp paths, manifests, printed texels |
//! | **bake** | [`Scene::centre_m`]; metres | `f32` corners, `f64` points | tracing, sampling, drawing |
//! | **tracer** | as bake; scaled by a power of two | `f32` corners, `f64` rays | [`crate::trace`], the exact engines |
//!
//! * **World** is glTF's: right-handed, +Y up. North is -Z and east +X, unless a sun path turns them. Coordinates may
//!   be millions of metres (a city in map coordinates), so positions and matrices are `f64` and are never rounded.
//! * **Bake** space is world space less [`Scene::centre_m`], axes unchanged, so directions are the same in both.
//!   Matrices are multiplied in `f64`, the centre is subtracted, and only then are corners rounded to `f32`
//!   ([`Geometry`]). The centre is a multiple of a power of two, so subtracting it is exact.
//! * **Tracer** space is bake space times a power of two that brings the scene's half size to between 512 and 1024
//!   units. Scaling by a power of two changes no digit. It is needed because the hierarchy has absolute tolerances.
//!
//! Beside these, *object* space is a mesh's own, before its node's matrix, and *page* coordinates lie on the atlas
//! ([`crate::atlas`]).

use glam::{DMat4, DVec3, Mat3, Vec2, Vec3, Vec4};
use std::sync::Arc;

mod accessors;
mod air;
pub mod alpha;
mod cameras;
mod components;
mod container;
mod document;
mod error;
mod file;
mod geometry;
mod images;
mod instancing;
mod limits;
mod load;
pub mod looks;
mod materials;
mod names;
mod nodes;
mod normals;
mod objects;
mod pose;
mod primitives;
mod refuse;
mod resources;
mod roles;
mod shading;
mod smooth;
#[cfg(test)]
mod tests;
mod triangles;

pub use components::Components;
pub(crate) use components::root;
pub use error::LoadError;
pub(crate) use file::PackedElements;
pub use file::SceneFile;
pub use geometry::{Geometry, SurfaceTriangle};
pub(crate) use instancing::GPU_INSTANCING;
pub use limits::{LoadLimits, SceneWarning};
pub use load::{load, load_without_pictures, parse};
pub use materials::BLEND_CUTOFF;
pub use names::{Selection, names};
pub(crate) use names::{each_once, first_of, label_of};
pub use objects::{ObjectError, ObjectWishes, Wish};
pub use resources::sha256;
pub use roles::Role;
pub use roles::is_density;
pub use shading::ShadingNormals;
pub use smooth::SmoothPoint;

/// A scene read from glTF, checked: every index is in range, every number finite, every mesh drawn by some instance.
///
/// Guarantees, made by [`load`] and relied on by everything downstream:
/// * `indices` are triples below `positions.len()`; optional attributes have one entry a position;
/// * `material`, `image`, `mesh`, `node` indices are in range; `materials` is never empty;
/// * every position is finite in object space and in bake space; every instance matrix is invertible;
/// * no triangle repeats an index, has zero area, or has a non-finite corner: those were dropped and counted.
#[derive(Debug, Clone)]
pub struct Scene {
    /// Which file this came from.
    pub source: Source,
    /// The nodes of the scene that is drawn, in the order of a walk that enters each node before its children.
    pub nodes: Vec<Node>,
    /// Drawn primitives, each once however many nodes draw it.
    pub meshes: Vec<Mesh>,
    /// What is drawn where: one per (node, primitive), in the order of nodes and then of primitives.
    pub instances: Vec<Instance>,
    /// Materials that are drawn, in file order; the last one is glTF's default when some primitive names none.
    pub materials: Vec<Material>,
    /// Decoded images, only those that some material uses.
    pub images: Vec<Image>,
    /// Cameras under nodes, in node order.
    pub cameras: Vec<SceneCamera>,
    /// Direction towards the sun, world space, unit length: the first `KHR_lights_punctual` directional light.
    pub sun_direction: Option<DVec3>,
    /// World position of the origin of bake space: the centre of the scene's bounding box, rounded to a power of two
    /// near a thousandth of its size, so that subtracting it is exact.
    pub centre_m: DVec3,
    /// Half the size of the scene's bounding box along each axis, in metres.
    pub half_extent_m: DVec3,
    /// Triangles that were read and left out, by reason.
    pub dropped: Dropped,
    /// What the user should know about how the file was read.
    pub warnings: Vec<SceneWarning>,
    /// The file itself, from which `scene.glb` is made. None of a scene made by code: then `scene.glb` is made from the
    /// fields above. Whoever changes nodes, meshes, materials or instances of a loaded scene, and wants to see that in
    /// `scene.glb`, sets this to none.
    pub file: Option<Arc<SceneFile>>,
}

/// The file a scene was read from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Source {
    /// File name without its folder.
    pub file_name: String,
    /// SHA-256, in lower-case hex, over the file and then, in file order, every external buffer and image it names that
    /// could be read.
    pub sha256: String,
}

/// A node of the drawn scene. Kept so that `scene.glb` has the file's hierarchy and names.
#[derive(Debug, Clone)]
pub struct Node {
    /// Name, if the file gives one.
    pub name: Option<String>,
    /// Index in the file's nodes; of a copy of a mesh, its parent's.
    pub gltf: usize,
    /// Index of the parent in [`Scene::nodes`]; always smaller than the node's own.
    pub parent: Option<usize>,
    /// The node's own transform. Nodes with a singular matrix are left out, with all nodes below them.
    pub parent_from_node: DMat4,
    /// Product of all transforms up to the root.
    pub world_from_node: DMat4,
}

impl Node {
    /// Whether a node is a copy of its parent's mesh (see `instancing.rs`), and no node of the file.
    pub fn is_copy(&self, nodes: &[Node]) -> bool {
        self.parent.and_then(|parent| nodes.get(parent)).is_some_and(|parent| parent.gltf == self.gltf)
    }
}

/// One glTF primitive, triangulated: one material and one vertex buffer, in object space.
#[derive(Debug, Clone, Default)]
pub struct Mesh {
    /// Name of the glTF mesh, if any.
    pub name: Option<String>,
    /// Index of the glTF mesh in its file, and of the primitive within that mesh.
    pub gltf: (usize, usize),
    /// Object space, metres before the node's scale.
    pub positions: Vec<Vec3>,
    /// Unit shading normals, object space; absent: flat shading.
    pub normals: Option<Vec<Vec3>>,
    /// The sets `TEXCOORD_n` that the file has. A texture whose set is absent shows its texel at (0, 0) everywhere.
    pub texcoords: Vec<Option<Vec<Vec2>>>,
    /// Linear RGBA vertex colour, multiplied with the material's base colour.
    pub colors: Option<Vec<Vec4>>,
    /// Three per triangle, counter-clockwise seen from the front.
    pub indices: Vec<u32>,
    /// Index in [`Scene::materials`].
    pub material: usize,
    /// For each vertex, its index in the file's primitive; empty where that is the same index.
    pub file_vertices: Vec<u32>,
}

impl Mesh {
    /// A set of texture coordinates, if the mesh has it.
    pub fn texcoord_set(&self, set: usize) -> Option<&[Vec2]> {
        self.texcoords.get(set)?.as_deref()
    }

    /// The index in the file's primitive of a vertex.
    pub fn file_vertex(&self, vertex: u32) -> u32 {
        self.file_vertices.get(vertex as usize).copied().unwrap_or(vertex)
    }

    /// Number of triangles.
    pub fn triangle_count(&self) -> usize {
        self.indices.len() / 3
    }

    /// What messages call it: its name in quotes, else its place in the file, as `meshes[3]`.
    pub fn label(&self) -> String {
        self.name.as_ref().map_or_else(|| format!("meshes[{}]", self.gltf.0), |name| format!("\"{name}\""))
    }
}

/// One mesh under one node.
#[derive(Debug, Clone, Copy)]
pub struct Instance {
    /// Index in [`Scene::nodes`].
    pub node: usize,
    /// Index in [`Scene::meshes`].
    pub mesh: usize,
    /// Object space to bake space, composed in `f64` before the scene's centre was subtracted.
    pub bake_from_object: DMat4,
    /// Whether the matrix mirrors (negative determinant): the winding is reversed, but the front stays the front.
    pub is_mirrored: bool,
    /// Whether it casts shadows, takes them, and how dense its texels are.
    pub role: Role,
}

/// A surface's material, as far as sunbake draws and traces it.
#[derive(Debug, Clone)]
pub struct Material {
    /// Name, if any.
    pub name: Option<String>,
    /// Index in the file's materials; none for glTF's default material.
    pub gltf: Option<usize>,
    /// Linear RGB and alpha.
    pub base_color: Vec4,
    /// Multiplied with `base_color` (the texture is sRGB, its alpha linear).
    pub base_color_texture: Option<TextureRef>,
    /// Linear RGB, with `KHR_materials_emissive_strength` multiplied in.
    pub emissive: Vec3,
    /// How alpha is used.
    pub alpha: Alpha,
    /// Whether both sides are drawn, and can be lit.
    pub is_double_sided: bool,
    /// `KHR_materials_unlit`: drawn in its base colour, without shading.
    pub is_unlit: bool,
    /// Whether it lets light through: it transmits at least half of it, or is `BLEND` and nowhere half opaque. Such
    /// surfaces neither cast nor take shadows, unless their file says otherwise ([`Role`]).
    pub is_clear: bool,
}

/// What alpha means for light. `BLEND` in the file is [`Alpha::Mask`] at one half: what is at least half opaque casts,
/// what is less does not (see docs/decisions.md, "Blended materials"). A surface that is less everywhere is opaque here
/// and [clear](Material::is_clear) to light. Lit pictures blend both: [`looks::MeshLook::is_blended`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Alpha {
    /// Alpha is ignored.
    Opaque,
    /// Alpha mask: points whose alpha is below the cutoff are not there.
    Mask {
        /// Least alpha of a solid point, 0 to 1 (0: every point is solid).
        cutoff: f32,
    },
    /// The user left the surface out, or it is blended with an alpha of 0: not drawn, not traced and not baked.
    Invisible,
}

/// A texture as a material uses it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TextureRef {
    /// Index in [`Scene::images`].
    pub image: usize,
    /// Which of [`Mesh::texcoords`].
    pub texcoord: usize,
    /// `KHR_texture_transform`: image coordinates from texture coordinates (homogeneous, column-major).
    pub image_from_texcoord: Mat3,
    /// What coordinates outside [0, 1] mean, for u and v.
    pub wrap: [Wrap; 2],
}

/// glTF's wrapping modes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wrap {
    /// Tile.
    Repeat,
    /// Tile, every second one mirrored.
    Mirror,
    /// The border's texel is repeated.
    Clamp,
}

/// A decoded image. Rows run from the top, as in the file.
#[derive(Debug, Clone)]
pub struct Image {
    /// Name or URI, for messages.
    pub name: String,
    /// Width in texels.
    pub width: u32,
    /// Height in texels.
    pub height: u32,
    /// RGBA, 8 bits a channel, `width * height` of them. Colour as stored (sRGB).
    pub rgba: Vec<[u8; 4]>,
}

/// A perspective camera. (Orthographic ones are left out with a warning.)
#[derive(Debug, Clone)]
pub struct SceneCamera {
    /// Name of the camera or, failing that, of its node.
    pub name: Option<String>,
    /// Index in [`Scene::nodes`].
    pub node: usize,
    /// Bake space from camera space (looking along -Z, +Y up); a rigid motion.
    pub bake_from_camera: DMat4,
    /// Vertical field of view in radians.
    pub fov_y_rad: f64,
}

/// Triangles left out, by reason.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Dropped {
    /// Two corners share an index.
    pub repeated_index: u64,
    /// The corners lie on one line, exactly or as nearly as `f32` can tell.
    pub zero_area: u64,
    /// A corner is NaN or infinite.
    pub non_finite: u64,
}

impl Dropped {
    /// Sum over all reasons.
    pub fn total(&self) -> u64 {
        self.repeated_index + self.zero_area + self.non_finite
    }
}

impl Scene {
    /// Number of triangles drawn, counting every instance.
    pub fn triangle_count(&self) -> usize {
        self.instances.iter().map(|i| self.meshes[i.mesh].triangle_count()).sum()
    }

    /// Whether any surface has an alpha mask, so that rays must sample its alpha.
    pub fn has_alpha_mask(&self) -> bool {
        self.instances.iter().any(|i| matches!(self.materials[self.meshes[i.mesh].material].alpha, Alpha::Mask { .. }))
    }

    /// The material of an instance.
    pub fn material(&self, instance: usize) -> &Material {
        &self.materials[self.meshes[self.instances[instance].mesh].material]
    }
}
