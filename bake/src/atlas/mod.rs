//! The atlas: unique texture coordinates for every instance, and the surface point that each texel stands for.
//!
//! A mesh is unwrapped once, into a layout of its own that fills [0, 1]; each instance owns a rectangle on some page,
//! and `page_uv = layout_uv * scale + offset`. Texel (x, y) of a page of `width` by `height` covers
//! `[x, x + 1] / width` by `[y, y + 1] / height`; row 0 is v = 0, the top of the PNG and of a wgpu texture.

use glam::{DVec3, Vec2};

/// Where every instance's texels lie.
#[derive(Debug, Clone)]
pub struct Atlas {
    /// The pages, in order.
    pub pages: Vec<PageSize>,
    /// Layouts, one per [`crate::scene::Scene::meshes`].
    pub layouts: Vec<Layout>,
    /// Rectangles, one per [`crate::scene::Scene::instances`].
    pub placements: Vec<Placement>,
    /// Texel density that was reached, for an instance at its placement's full scale.
    pub texels_per_metre: f64,
    /// Charts over all pages.
    pub chart_count: usize,
}

/// Size of a page.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PageSize {
    /// In texels.
    pub width: u32,
    /// In texels.
    pub height: u32,
}

/// Unique coordinates of one mesh. Vertices on chart borders are split: `vertices[i]` is which vertex of the mesh the
/// layout's vertex i came from, `indices` has the mesh's triangles in the mesh's order.
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

/// Whose coordinates a layout holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LayoutOrigin {
    /// The file's own `TEXCOORD_1`, as it was.
    File,
    /// Made by unwrapping.
    Unwrapped,
}

/// An instance's rectangle: `page_uv = layout_uv * scale + offset`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    /// Index in [`Atlas::pages`].
    pub page: u32,
    /// In page coordinates.
    pub scale: Vec2,
    /// In page coordinates.
    pub offset: Vec2,
}

/// The texels of one page that stand for a surface point, in row order.
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
    /// Weights of the triangle's second and third corner. The point is inside the triangle or on its edge.
    pub barycentric: [f32; 2],
}

/// A sample placed in the scene: what an engine is asked about.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfacePoint {
    /// On the surface, bake space.
    pub position_m: DVec3,
    /// Unit front normal of the triangle's plane.
    pub normal: DVec3,
    /// Whether light from behind counts as well (see [`crate::visibility`]).
    pub is_double_sided: bool,
    /// Flat index of the triangle it lies on.
    pub triangle: u32,
}
