//! Textures of shadow maps: depths as the sun sees them, and masks of casters on the ground.

use crate::gpu::device::{Gpu, GpuError};
use crate::gpu::frame::{DEPTH_FORMAT, texture};

/// Format of masks of casters: 1 is lit.
pub const MASK_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R8Unorm;

/// Usage of both.
const DRAWN_AND_READ: wgpu::TextureUsages =
    wgpu::TextureUsages::RENDER_ATTACHMENT.union(wgpu::TextureUsages::TEXTURE_BINDING);

/// A mask of casters on the ground: 0 where something does, 1 elsewhere.
pub struct CasterMask {
    /// In texels.
    pub size: [u32; 2],
    pub view: wgpu::TextureView,
}

impl CasterMask {
    /// A mask of a size.
    pub fn new(gpu: &Gpu, size: [u32; 2]) -> Self {
        let view = texture(gpu, "casters", size, 1, MASK_FORMAT, DRAWN_AND_READ).create_view(&Default::default());
        Self { size, view }
    }

    /// Its bytes.
    pub fn bytes(&self) -> u64 {
        u64::from(self.size[0]) * u64::from(self.size[1])
    }
}

/// Shadow maps: the layers of one array texture.
pub struct DepthMaps {
    /// Edge of each map.
    pub size_texels: u32,
    /// Each map, to draw into.
    pub layers: Vec<wgpu::TextureView>,
    /// All maps, to read.
    pub all: wgpu::TextureView,
}

impl DepthMaps {
    /// `count` maps of a size.
    pub fn new(gpu: &Gpu, size_texels: u32, count: u32) -> Result<Self, GpuError> {
        let mebibytes = (4 * u64::from(size_texels).pow(2) * u64::from(count)) >> 20;
        let too_large = || GpuError::MapMemory { mebibytes };
        if size_texels > gpu.device.limits().max_texture_dimension_2d {
            return Err(too_large());
        }
        let make = || texture(gpu, "shadow maps", [size_texels; 2], count, DEPTH_FORMAT, DRAWN_AND_READ);
        let texture = gpu.checked("making shadow maps", make).map_err(|_| too_large())?;
        let layer = |layer| {
            texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2),
                base_array_layer: layer,
                array_layer_count: Some(1),
                ..Default::default()
            })
        };
        let all = texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        Ok(Self { size_texels, layers: (0..count).map(layer).collect(), all })
    }

    /// Their bytes.
    pub fn bytes(&self) -> u64 {
        4 * u64::from(self.size_texels).pow(2) * self.layers.len() as u64
    }
}
