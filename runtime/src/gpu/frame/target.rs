//! What is drawn into. Textures are made when a size is first asked for, and kept until another is.

use super::Output;
use crate::gpu::device::{Gpu, GpuError};
use std::collections::BTreeMap;

/// Format of depths where no stencil is needed.
pub const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Format of depths with a stencil, in which shadow volumes are counted.
pub const STENCIL_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32FloatStencil8;

/// A texture view that a picture is drawn into. Its texture has the size of the [`View`](crate::View), one sample per
/// pixel, and the usage `RENDER_ATTACHMENT`.
///
/// Lit pictures are in linear light: an sRGB format encodes them and clips what is beyond 1; a float format keeps it
/// for a tone curve of the caller's.
#[derive(Debug, Clone, Copy)]
pub struct PictureTarget<'a> {
    /// What is drawn into. All of it is overwritten.
    pub view: &'a wgpu::TextureView,
    /// The view's format. Pipelines are built once per format.
    pub format: wgpu::TextureFormat,
}

impl<'a> PictureTarget<'a> {
    /// To be drawn into, after clearing or loading.
    pub(in crate::gpu) fn attachment(self, load: wgpu::LoadOp<wgpu::Color>) -> wgpu::RenderPassColorAttachment<'a> {
        let ops = wgpu::Operations { load, store: wgpu::StoreOp::Store };
        wgpu::RenderPassColorAttachment { view: self.view, depth_slice: None, resolve_target: None, ops }
    }
}

/// A picture that can be read back.
#[derive(Clone)]
pub struct OwnPicture {
    /// In pixels.
    pub size: [u32; 2],
    pub texture: wgpu::Texture,
    pub view: wgpu::TextureView,
}

impl OwnPicture {
    /// The view that passes draw into.
    pub fn target(&self) -> PictureTarget<'_> {
        PictureTarget { view: &self.view, format: self.texture.format() }
    }
}

/// Depths, with a stencil if the format has one.
#[derive(Clone)]
pub struct DepthBuffer {
    /// In pixels.
    pub size: [u32; 2],
    pub texture: wgpu::Texture,
    pub view: wgpu::TextureView,
}

impl DepthBuffer {
    /// Cleared: depths to infinity, the stencil to 0.
    pub fn cleared(&self) -> wgpu::RenderPassDepthStencilAttachment<'_> {
        let has_stencil = self.texture.format().has_stencil_aspect();
        let depth_ops = Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store });
        wgpu::RenderPassDepthStencilAttachment { depth_ops, ..self.attachment(has_stencil) }
    }

    /// Depths that are only read, and a stencil cleared to 0.
    pub fn with_stencil_cleared(&self) -> wgpu::RenderPassDepthStencilAttachment<'_> {
        self.attachment(true)
    }

    /// Depths and stencil that are only read.
    pub fn read_only(&self) -> wgpu::RenderPassDepthStencilAttachment<'_> {
        self.attachment(false)
    }

    fn attachment(&self, clears_stencil: bool) -> wgpu::RenderPassDepthStencilAttachment<'_> {
        let clear = wgpu::Operations { load: wgpu::LoadOp::Clear(0), store: wgpu::StoreOp::Store };
        wgpu::RenderPassDepthStencilAttachment {
            view: &self.view,
            depth_ops: None,
            stencil_ops: clears_stencil.then_some(clear),
        }
    }
}

/// A renderer's own textures, one picture and one depth buffer per output.
pub struct OwnTargets {
    depth_format: wgpu::TextureFormat,
    pictures: BTreeMap<Output, OwnPicture>,
    depths: BTreeMap<Output, DepthBuffer>,
}

impl OwnTargets {
    /// Holds no texture until one is asked for.
    pub fn new(depth_format: wgpu::TextureFormat) -> Self {
        Self { depth_format, pictures: BTreeMap::new(), depths: BTreeMap::new() }
    }

    /// The output's picture of a size.
    pub fn picture(&mut self, gpu: &Gpu, output: Output, size: [u32; 2]) -> Result<OwnPicture, GpuError> {
        if let Some(picture) = self.pictures.get(&output).filter(|picture| picture.size == size) {
            return Ok(picture.clone());
        }
        let (texture, view) = make(gpu, "picture", size, output.readback_format())?;
        let picture = OwnPicture { size, texture, view };
        self.pictures.insert(output, picture.clone());
        Ok(picture)
    }

    /// The output's depth buffer of a size.
    pub fn depth(&mut self, gpu: &Gpu, output: Output, size: [u32; 2]) -> Result<DepthBuffer, GpuError> {
        if let Some(depth) = self.depths.get(&output).filter(|depth| depth.size == size) {
            return Ok(depth.clone());
        }
        let (texture, view) = make(gpu, "depth", size, self.depth_format)?;
        let depth = DepthBuffer { size, texture, view };
        self.depths.insert(output, depth.clone());
        Ok(depth)
    }

    /// Depths of the last picture of an output, if there was one.
    pub fn last_depth(&self, output: Output) -> Option<&DepthBuffer> {
        self.depths.get(&output)
    }

    /// Number of textures.
    pub fn count(&self) -> usize {
        self.pictures.len() + self.depths.len()
    }
}

fn make(
    gpu: &Gpu,
    label: &str,
    [width, height]: [u32; 2],
    format: wgpu::TextureFormat,
) -> Result<(wgpu::Texture, wgpu::TextureView), GpuError> {
    let limit = u64::from(gpu.device.limits().max_texture_dimension_2d);
    GpuError::check_limit("the longer edge of the picture", u64::from(width.max(height)), limit)?;
    let made = gpu.checked("making a picture", || {
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some(label),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        (texture, view)
    });
    made.map_err(|error| match error {
        GpuError::Failed { reason, .. } => GpuError::Picture { reason },
        error => error,
    })
}
