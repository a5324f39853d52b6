//! What is drawn into: made when a size is first asked for, kept until another is.

use super::device::{Gpu, GpuError};

/// Format of lit pictures: linear light, as precise as the CPU's.
pub const LIT_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;
/// Format of visibility pictures.
pub const VISIBILITY_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R32Float;
/// Format of depths.
pub const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Format of depths beside which volumes are counted.
pub const STENCIL_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32FloatStencil8;

/// A picture and its depths.
pub struct Target {
    /// In pixels.
    pub size: [u32; 2],
    /// What is read back.
    pub picture: wgpu::Texture,
    /// The same, to draw into.
    pub view: wgpu::TextureView,
    /// Depths, and the stencil beside them if there is one.
    pub depths: wgpu::Texture,
    /// The same, to draw into.
    pub depth: wgpu::TextureView,
}

impl Target {
    /// A picture of a size and format, with depths.
    pub fn new(
        gpu: &Gpu,
        size: [u32; 2],
        format: wgpu::TextureFormat,
        depth_format: wgpu::TextureFormat,
    ) -> Result<Self, GpuError> {
        let limit = u64::from(gpu.device.limits().max_texture_dimension_2d);
        GpuError::check_limit("the longer edge of the picture", u64::from(size[0].max(size[1])), limit)?;
        let make = |label, format, usage| {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage,
                view_formats: &[],
            })
        };
        let drawn = wgpu::TextureUsages::RENDER_ATTACHMENT;
        gpu.checked("making a picture of this size; give a smaller --size", || {
            let picture = make("picture", format, drawn | wgpu::TextureUsages::COPY_SRC);
            let depth = make("depth", depth_format, drawn | wgpu::TextureUsages::COPY_SRC);
            let view = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
            Self { size, view: view(&picture), depth: view(&depth), picture, depths: depth }
        })
    }

    /// The picture, to be drawn into.
    pub fn picture_attachment(&self, load: wgpu::LoadOp<wgpu::Color>) -> wgpu::RenderPassColorAttachment<'_> {
        drawn_into(&self.view, load)
    }

    /// Its depths alone, to be drawn into.
    pub fn depth_attachment(&self, load: wgpu::LoadOp<f32>) -> wgpu::RenderPassDepthStencilAttachment<'_> {
        depths_drawn_into(&self.depth, load)
    }
}

/// A picture to be drawn into.
pub fn drawn_into(view: &wgpu::TextureView, load: wgpu::LoadOp<wgpu::Color>) -> wgpu::RenderPassColorAttachment<'_> {
    let ops = wgpu::Operations { load, store: wgpu::StoreOp::Store };
    wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops }
}

/// Depths to be drawn into.
pub fn depths_drawn_into(
    view: &wgpu::TextureView,
    load: wgpu::LoadOp<f32>,
) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    let depth_ops = Some(wgpu::Operations { load, store: wgpu::StoreOp::Store });
    wgpu::RenderPassDepthStencilAttachment { view, depth_ops, stencil_ops: None }
}
