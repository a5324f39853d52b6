//! What was built for a stage, counted.

use serde::Serialize;

/// Counts of what a renderer holds.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct Census {
    /// Passes a frame.
    pub passes: usize,
    /// Pipelines.
    pub pipelines: usize,
    /// Pipelines that test alpha.
    pub alpha_test_pipelines: usize,
    /// Pipelines that draw both sides.
    pub two_sided_pipelines: usize,
    /// Textures with stored times.
    pub time_textures: usize,
    /// Bindings of a lamp: one where there is a lamp.
    pub lamp_bindings: usize,
    /// Textures with ambient light.
    pub ambient_textures: usize,
    /// Bindings of the sky in spherical harmonics: one where a page wants it.
    pub sky_bindings: usize,
    /// Base colour textures.
    pub base_color_textures: usize,
    /// Vertex buffers.
    pub vertex_buffers: usize,
    /// Groups of bindings.
    pub bind_groups: usize,
    /// Pictures drawn into, the depth picture among them.
    pub targets: usize,
    /// Draw calls of a pass over the scene.
    pub draws: usize,
    /// Bytes of all textures with stored times or ambient light.
    pub map_bytes: u64,
}
