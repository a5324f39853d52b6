//! What was built for a stage, counted.

use super::scene::SceneOnGpu;
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
    /// Pipelines that count volumes in the stencil, or keep what was counted.
    pub stencil_pipelines: usize,
    /// Buffers from which volumes are drawn.
    pub volume_buffers: usize,
    /// Bytes of these.
    pub volume_bytes: u64,
    /// Pipelines that draw shadow maps or pictures of what casts.
    pub shadow_pipelines: usize,
    /// Shadow maps, each face or cascade counted.
    pub shadow_maps: usize,
    /// Pictures of what casts, and those that blur them.
    pub shadow_masks: usize,
    /// Bytes of both.
    pub shadow_bytes: u64,
}

impl Census {
    /// Counts of what every technique shares.
    pub(super) fn of_scene(scene: &SceneOnGpu) -> Self {
        let page_groups = scene.pages.iter().filter(|page| page.bind_group.is_some()).count();
        Self {
            time_textures: scene.pages.iter().map(|page| page.time_textures).sum(),
            lamp_bindings: usize::from(scene.frame.lamp.is_some()),
            ambient_textures: scene.pages.iter().map(|page| page.ambient_textures).sum(),
            sky_bindings: usize::from(scene.frame.sky.is_some()),
            base_color_textures: scene.textures.texture_count,
            vertex_buffers: scene.streams.len(),
            bind_groups: 1 + page_groups + scene.textures.bind_groups.len(),
            draws: scene.batches.len(),
            map_bytes: scene.pages.iter().map(|page| page.bytes).sum(),
            ..Self::default()
        }
    }
}
