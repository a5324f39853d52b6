//! Textures of surfaces, with the levels of detail that the CPU made, so that both sample the same numbers.

use super::batch::{BatchKey, TextureKey, TextureSet};
use super::page_textures::upload;
use crate::gpu::device::{Gpu, GpuError};
use crate::stage::Stage;
use crate::texture::{Encoding, Level};
use std::collections::{BTreeMap, BTreeSet};

/// What the textures of surfaces are bound with.
pub struct SurfaceTextures {
    /// Layouts of bindings, by which textures of a set there are.
    layouts: BTreeMap<[bool; 4], wgpu::BindGroupLayout>,
    /// Bindings of each set of textures with their samplers.
    bind_groups: BTreeMap<TextureSet, wgpu::BindGroup>,
    /// Number of base colour textures.
    pub base_count: usize,
    /// Number of other textures.
    pub look_count: usize,
}

/// An image that is uploaded: its index, its encoding, and whether it is a base colour.
pub type TextureImage = (usize, Encoding, bool);

impl TextureKey {
    /// The image that it samples.
    pub fn source(&self) -> TextureImage {
        (self.image, self.encoding, self.is_base)
    }
}

impl SurfaceTextures {
    /// Uploads the textures of these sets.
    pub fn new(gpu: &Gpu, stage: &Stage, sets: &BTreeSet<TextureSet>) -> Result<Self, GpuError> {
        let keys: BTreeSet<TextureKey> = sets.iter().flat_map(TextureSet::in_order).flatten().collect();
        let images: BTreeSet<TextureImage> = keys.iter().map(TextureKey::source).collect();
        let wraps: BTreeSet<[u32; 2]> = keys.iter().map(|key| key.wrap).collect();
        let base_count = images.iter().filter(|(.., is_base)| *is_base).count();
        let look_count = images.len() - base_count;
        let views: BTreeMap<TextureImage, wgpu::TextureView> =
            images.into_iter().map(|image| Ok((image, view(gpu, stage, image)?))).collect::<Result<_, GpuError>>()?;
        let samplers: BTreeMap<[u32; 2], wgpu::Sampler> =
            wraps.into_iter().map(|wrap| (wrap, sampler(gpu, wrap))).collect();
        let kinds: BTreeSet<[bool; 4]> = sets.iter().map(TextureSet::kinds).collect();
        let layouts: BTreeMap<_, _> = kinds.into_iter().map(|kinds| (kinds, layout(gpu, kinds))).collect();
        let group = |set: &TextureSet| {
            let bound = |(slot, key): (u32, TextureKey)| {
                let texture = wgpu::BindingResource::TextureView(&views[&key.source()]);
                let sampler = wgpu::BindingResource::Sampler(&samplers[&key.wrap]);
                [(2 * slot, texture), (2 * slot + 1, sampler)]
            };
            let slots = (0..).zip(set.in_order()).filter_map(|(slot, key)| Some((slot, key?)));
            let entries: Vec<_> =
                slots.flat_map(bound).map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource }).collect();
            gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("textures of a surface"),
                layout: &layouts[&set.kinds()],
                entries: &entries,
            })
        };
        let bind_groups = sets.iter().map(|set| (*set, group(set))).collect();
        Ok(Self { layouts, bind_groups, base_count, look_count })
    }

    /// The layout of what a program of this key reads; none where it reads no texture.
    pub fn layout(&self, key: &BatchKey) -> Option<&wgpu::BindGroupLayout> {
        let (surface, look) = (key.surface, key.surface.look);
        let kinds = [surface.is_textured, look.has_metallic_roughness_map, look.has_normal_map, look.has_emissive_map];
        self.layouts.get(&kinds)
    }

    /// Number of groups, and of their bindings.
    pub fn group_counts(&self) -> (usize, usize) {
        (self.bind_groups.len(), self.bind_groups.keys().map(TextureSet::binding_count).sum())
    }

    /// The bindings of a set; none where it is empty.
    pub fn group(&self, set: &TextureSet) -> Option<&wgpu::BindGroup> {
        self.bind_groups.get(set)
    }
}

fn layout(gpu: &Gpu, kinds: [bool; 4]) -> wgpu::BindGroupLayout {
    let entry =
        |binding, ty| wgpu::BindGroupLayoutEntry { binding, visibility: wgpu::ShaderStages::FRAGMENT, ty, count: None };
    let texture = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: true },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
    let slots = (0..).zip(kinds).filter(|(_, is_there)| *is_there);
    let entries: Vec<_> =
        slots.flat_map(|(slot, _)| [entry(2 * slot, texture), entry(2 * slot + 1, sampler)]).collect();
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("textures of a surface"),
        entries: &entries,
    })
}

fn view(gpu: &Gpu, stage: &Stage, (image, encoding, is_base): TextureImage) -> Result<wgpu::TextureView, GpuError> {
    let mips = if is_base { stage.mips(image) } else { stage.look_texture(image, encoding) };
    // Mips exist for every image that an instance's material draws, and batches are made of nothing else.
    let levels: &[Level] = mips.map_or(&[], |mips| &mips.levels);
    let (width, height) = levels.first().map_or((1, 1), |level| (level.width, level.height));
    let limit = u64::from(gpu.device.limits().max_texture_dimension_2d);
    GpuError::check_limit("the longer edge of a texture", u64::from(width.max(height)), limit)?;
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(if is_base { "base colour" } else { "look" }),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: levels.len().max(1) as u32,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: match encoding {
            Encoding::Srgb => wgpu::TextureFormat::Rgba8UnormSrgb,
            Encoding::Linear => wgpu::TextureFormat::Rgba8Unorm,
        },
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
        label: Some("texture of a surface"),
        address_mode_u: mode(wrap[0]),
        address_mode_v: mode(wrap[1]),
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        mipmap_filter: wgpu::MipmapFilterMode::Linear,
        ..Default::default()
    })
}
