//! The atlas: unique texture coordinates for every instance, and the surface point that each texel stands for.
//!
//! A mesh is unwrapped once, into a layout of its own that fills [0, 1]; each instance owns a rectangle on some page,
//! and `page_uv = layout_uv * scale + offset`. Texel (x, y) of a page of `width` by `height` covers
//! `[x, x + 1] / width` by `[y, y + 1] / height`; row 0 is v = 0, the top of the PNG and of a wgpu texture.

use crate::scene::{Geometry, Mesh, Scene, SmoothPoint};
use crate::warning::Warning;
use glam::{DVec2, DVec3, Vec2};

mod around;
mod arrange;
mod build;
mod chart_box;
mod coverage;
mod error;
mod existing;
mod footprint;
mod free_space;
mod gutter;
mod measure;
mod meter;
mod outline;
mod overlap;
mod reach;
mod samples;
mod search;
mod shared;
mod strip;
#[cfg(test)]
mod tests;
mod tile;
mod unwrap;
mod walls;
mod zones;

pub(crate) use around::Around;
pub use build::build;
pub(crate) use chart_box::is_drawn_together;
pub use error::{AtlasError, Misfit};
pub use footprint::{Filtered, Footprint};
pub use gutter::{GutterTexel, gutter};
pub use reach::{HiddenEnd, OPEN, Reach, is_open, wall_code};
pub use samples::{in_tile_order, sample_page, sample_page_supersampled, surface_point};
pub(crate) use walls::walls_and_borders;
pub use walls::{WallFinder, find_walls};

/// Settings for building an atlas.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AtlasSettings {
    /// Density of texels. Time and memory of a bake grow with the number of texels, so with the density's square.
    pub density: Density,
    /// Longest side of a page, in texels; 16 to 16384, usually 1024 to 4096. Pages are cropped to what is used.
    pub page_size_texels: u32,
    /// Width in texels of the gutter on every side of large charts, from where they end. A bilinear filter needs 1, as
    /// all charts have; the default is 2; each mip level needs twice as much. No gutter is wider than an eighth of its
    /// chart's shorter side.
    pub padding_texels: u32,
    /// Most texels over all pages; a density that needs more is an error. A sample takes 16 bytes, so the default of
    /// 2^28 bounds all samples of a scene at 4 GiB.
    pub most_texels: u64,
    /// Whether a valid `TEXCOORD_1` is used unchanged; if not, every mesh is unwrapped.
    pub keeps_existing: bool,
}

impl Default for AtlasSettings {
    fn default() -> Self {
        Self {
            density: Density::Pages(1),
            page_size_texels: 2048,
            padding_texels: 2,
            most_texels: 1 << 28,
            keeps_existing: true,
        }
    }
}

/// How the density of texels is chosen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Density {
    /// This many texels a metre, on as many pages as it takes.
    TexelsPerMetre(f64),
    /// The highest density that fits this many pages.
    Pages(u32),
}

/// Where every instance's texels lie.
#[derive(Debug, Clone)]
pub struct Atlas {
    /// The pages, in order.
    pub pages: Vec<PageSize>,
    /// Layouts, one per [`crate::scene::Scene::meshes`].
    pub layouts: Vec<Layout>,
    /// Rectangles, one per [`crate::scene::Scene::instances`].
    pub placements: Vec<Placement>,
    /// Density reached: the root of covered texels over surface area, without charts that take one texel or a row.
    pub texels_per_metre: f64,
    /// Number of charts over all pages.
    pub chart_count: usize,
    /// What the user should know about the layout.
    pub warnings: Vec<Warning>,
}

impl Atlas {
    /// Position on the page, in texels, of coordinates of an instance's layout.
    pub fn texel(&self, instance: usize, layout_uv: Vec2, page: PageSize) -> DVec2 {
        let Placement { scale, offset, .. } = self.placements[instance];
        (layout_uv.as_dvec2() * scale.as_dvec2() + offset.as_dvec2()) * page.as_dvec2()
    }

    /// Texels over all pages, covered or not.
    pub fn texel_count(&self) -> u64 {
        self.pages.iter().map(|p| p.texel_count() as u64).sum()
    }
}

/// Size of a page.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PageSize {
    /// In texels.
    pub width: u32,
    /// In texels.
    pub height: u32,
}

impl PageSize {
    /// Texels on the page.
    pub fn texel_count(self) -> usize {
        self.width as usize * self.height as usize
    }

    fn as_dvec2(self) -> DVec2 {
        DVec2::new(f64::from(self.width), f64::from(self.height))
    }
}

/// Unique coordinates of one mesh. Vertices on chart borders are split: layout vertex i is a copy of mesh vertex
/// `vertices[i]`. `indices` has the mesh's triangles in the mesh's order.
#[derive(Debug, Clone)]
pub struct Layout {
    /// Where the coordinates came from.
    pub origin: LayoutOrigin,
    /// For each layout vertex, the mesh vertex it copies.
    pub vertices: Vec<u32>,
    /// For each layout vertex, its coordinates in [0, 1].
    pub uvs: Vec<Vec2>,
    /// Three per triangle, into `vertices` and `uvs`.
    pub indices: Vec<u32>,
}

/// The set of a file's own texture coordinates that may serve as a layout.
const FILE_SET: usize = 1;

/// Whose coordinates a layout holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LayoutOrigin {
    /// The file's own `TEXCOORD_1`, as it was.
    File,
    /// Made by unwrapping the mesh.
    Unwrapped,
}

impl Layout {
    /// The mesh with the coordinates that its file has in `TEXCOORD_n`, n being `set`; zero where it has none.
    pub fn of_file(mesh: &Mesh, set: usize) -> Self {
        let layout = Self { origin: LayoutOrigin::File, ..Self::of_mesh(mesh) };
        Self { uvs: mesh.texcoord_set(set).map_or_else(|| layout.uvs.clone(), <[Vec2]>::to_vec), ..layout }
    }

    /// The mesh's own vertices with all coordinates zero: for a mesh without texels.
    pub fn of_mesh(mesh: &Mesh) -> Self {
        let count = mesh.positions.len();
        Self {
            origin: LayoutOrigin::Unwrapped,
            vertices: (0..count as u32).collect(),
            uvs: vec![Vec2::ZERO; count],
            indices: mesh.indices.clone(),
        }
    }
}

/// An instance's rectangle: `page_uv = layout_uv * scale + offset`. An invisible instance
/// ([`crate::scene::Alpha::Invisible`]) has no texels: see [`Placement::is_empty`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    /// Index in [`Atlas::pages`].
    pub page: u32,
    /// Size of the layout's unit square, in page coordinates (0 to 1).
    pub scale: Vec2,
    /// Position of the layout's origin, in page coordinates (0 to 1).
    pub offset: Vec2,
}

impl Placement {
    /// An instance without texels.
    pub const EMPTY: Self = Self { page: 0, scale: Vec2::ZERO, offset: Vec2::ZERO };

    /// Whether the instance has no texels.
    pub fn is_empty(&self) -> bool {
        self.scale == Vec2::ZERO
    }
}

/// The covered texels of one page, in row order. A texel is covered if some triangle touches it.
#[derive(Debug, Clone, Default)]
pub struct PageSamples {
    /// Ascending in `texel`, each texel at most once.
    pub samples: Vec<Sample>,
}

/// A covered texel and its point on the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// `y * width + x`.
    pub texel: u32,
    /// Flat triangle index of [`crate::scene::Geometry`].
    pub triangle: u32,
    /// Weights of the triangle's second and third corner, 0 to 1. The point is inside the triangle or on its edge.
    pub barycentric: [f32; 2],
}

/// A sample's point in the scene: the input of visibility engines.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfacePoint {
    /// Position on the surface, bake space, in metres.
    pub position_m: DVec3,
    /// Unit front normal of the triangle's plane.
    pub normal: DVec3,
    /// Whether light from behind counts as well (see [`crate::visibility`]).
    pub is_double_sided: bool,
    /// Flat index of the triangle it lies on.
    pub triangle: u32,
    /// What shading normals say of it; none on flat triangles.
    pub smooth: Option<SmoothPoint>,
}

impl SurfacePoint {
    /// The point of a triangle with these weights of its second and third corner.
    pub fn of_triangle(scene: &Scene, geometry: &Geometry, triangle: usize, barycentric: [f64; 2]) -> Self {
        Self {
            position_m: geometry.point(triangle, barycentric),
            normal: geometry.normal(triangle),
            is_double_sided: scene.material(geometry.instance[triangle] as usize).is_double_sided,
            triangle: triangle as u32,
            smooth: geometry.smooth_point(triangle, barycentric),
        }
    }
}
