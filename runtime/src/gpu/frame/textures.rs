//! Base colour textures: sRGB, with the levels of detail that the CPU made, so that both sample the same numbers.

use super::batch::TextureKey;
use super::page_textures::upload;
use crate::gpu::device::{Gpu, GpuError};
use crate::stage::Stage;
use std::collections::{BTreeMap, BTreeSet};

/// What base colour textures are bound with.
pub struct BaseTextures {
    /// The layout of their bindings; none where no surface is textured.
    pub layout: Option<wgpu::BindGroupLayout>,
    /// Bindings of each texture with its sampler.
    pub bind_groups: BTreeMap<TextureKey, wgpu::BindGroup>,
    /// Number of textures.
    pub texture_count: usize,
}

impl BaseTextures {
    /// Bindings of each: the texture and its sampler.
    pub const BINDINGS: usize = 2;

    /// Uploads the textures that some batch draws with.
    pub fn new(gpu: &Gpu, stage: &Stage, keys: &BTreeSet<TextureKey>) -> Result<Self, GpuError> {
        if keys.is_empty() {
            return Ok(Self { layout: None, bind_groups: BTreeMap::new(), texture_count: 0 });
        }
        let layout = layout(gpu);
        let images: BTreeSet<usize> = keys.iter().map(|key| key.image).collect();
        let wraps: BTreeSet<[u32; 2]> = keys.iter().map(|key| key.wrap).collect();
        let views: BTreeMap<usize, wgpu::TextureView> =
            images.into_iter().map(|image| Ok((image, view(gpu, stage, image)?))).collect::<Result<_, GpuError>>()?;
        let samplers: BTreeMap<[u32; 2], wgpu::Sampler> =
            wraps.into_iter().map(|wrap| (wrap, sampler(gpu, wrap))).collect();
        let group = |key: &TextureKey| {
            gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("base colour"),
                layout: &layout,
                entries: &[
                    wgpu::BindGroupEntry {
                        binding: 0,
                        resource: wgpu::BindingResource::TextureView(&views[&key.image]),
                    },
                    wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::Sampler(&samplers[&key.wrap]) },
                ],
            })
        };
        let bind_groups = keys.iter().map(|key| (*key, group(key))).collect();
        Ok(Self { layout: Some(layout), bind_groups, texture_count: views.len() })
    }
}

fn layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let entry =
        |binding, ty| wgpu::BindGroupLayoutEntry { binding, visibility: wgpu::ShaderStages::FRAGMENT, ty, count: None };
    let texture = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: true },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("base colour"),
        entries: &[entry(0, texture), entry(1, sampler)],
    })
}

fn view(gpu: &Gpu, stage: &Stage, image: usize) -> Result<wgpu::TextureView, GpuError> {
    // Mips exist for every image that an instance's material draws, and batches are made of nothing else.
    let levels = stage.mips(image).map_or(&[][..], |mips| &mips.levels);
    let (width, height) = levels.first().map_or((1, 1), |level| (level.width, level.height));
    let limit = u64::from(gpu.device.limits().max_texture_dimension_2d);
    GpuError::check_limit("the longer edge of a texture", u64::from(width.max(height)), limit)?;
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("base colour"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: levels.len().max(1) as u32,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8UnormSrgb,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    for (index, level) in levels.iter().enumerate() {
        let bytes = bytemuck::cast_slice(&level.rgba);
        upload(gpu, &texture, index as u32, 0, [level.width, level.height], 4, bytes);
    }
    Ok(texture.create_view(&wgpu::TextureViewDescriptor::default()))
}

fn sampler(gpu: &Gpu, wrap: [u32; 2]) -> wgpu::Sampler {
    let mode = |code| match code {
        sunbake_shaders::WRAP_CLAMP => wgpu::AddressMode::ClampToEdge,
        sunbake_shaders::WRAP_MIRROR => wgpu::AddressMode::MirrorRepeat,
        _ => wgpu::AddressMode::Repeat,
    };
    gpu.device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("base colour"),
        address_mode_u: mode(wrap[0]),
        address_mode_v: mode(wrap[1]),
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        mipmap_filter: wgpu::MipmapFilterMode::Linear,
        ..Default::default()
    })
}
