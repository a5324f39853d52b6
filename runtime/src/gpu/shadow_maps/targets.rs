//! What shadow maps are drawn into and read from.

use super::super::device::{Gpu, GpuError};
use super::super::maps::texture;
use super::super::target::DEPTH_FORMAT;
use super::probe::comparison_sampler;
use crate::shadow_maps::{MOST_MAPS, MapProjection, MapSettings, Variant};
use bytemuck::Zeroable;
use glam::Vec3;
use sunbake_shaders::{ShadowMapsUniform, ShadowTap, ShadowViewUniform};

/// Format of pictures of what casts.
pub const MASK_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R8Unorm;

/// What both kinds of picture are for.
const DRAWN_AND_READ: wgpu::TextureUsages =
    wgpu::TextureUsages::RENDER_ATTACHMENT.union(wgpu::TextureUsages::TEXTURE_BINDING);

/// A picture of what casts.
pub struct Mask {
    /// In texels.
    pub size: [u32; 2],
    /// To draw into and to read.
    pub view: wgpu::TextureView,
}

impl Mask {
    /// One of a size.
    pub fn new(gpu: &Gpu, size: [u32; 2]) -> Self {
        let view = texture(gpu, "what casts", size, 1, MASK_FORMAT, DRAWN_AND_READ).create_view(&Default::default());
        Self { size, view }
    }

    /// Bytes that it takes.
    pub fn bytes(&self) -> u64 {
        u64::from(self.size[0]) * u64::from(self.size[1])
    }
}

/// Maps of depths, one over the other.
pub struct Depths {
    /// Edge of each.
    pub size_texels: u32,
    /// To draw into, one by one.
    pub layers: Vec<wgpu::TextureView>,
    /// To read.
    pub all: wgpu::TextureView,
}

impl Depths {
    /// So many of a size.
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

    /// Bytes that they take.
    pub fn bytes(&self) -> u64 {
        4 * u64::from(self.size_texels).pow(2) * self.layers.len() as u64
    }
}

/// One map's matrix, for the pass that draws it.
pub struct MapView {
    buffer: wgpu::Buffer,
    /// Its binding.
    pub group: wgpu::BindGroup,
}

/// Layouts and buffers that do not depend on how many maps there are.
pub struct Bindings {
    /// Of a map's matrix.
    pub view_layout: wgpu::BindGroupLayout,
    /// Of what surfaces read.
    pub read_layout: wgpu::BindGroupLayout,
    views: Vec<MapView>,
    maps: wgpu::Buffer,
    sampler: Option<wgpu::Sampler>,
    linear: Option<wgpu::Sampler>,
}

/// What surfaces read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Reads {
    /// Maps of depths.
    pub has_depths: bool,
    /// How they are read.
    pub tap: ShadowTap,
    /// A picture of what casts, on the map's place.
    pub has_mask: bool,
    /// A picture of what casts, as the camera sees it.
    pub has_flat_mask: bool,
}

impl Reads {
    /// What surfaces read under shadow maps; `halfway` is what a comparison sampler reads between light and shade, where one was asked.
    pub fn new(settings: &MapSettings, has_ground: bool, halfway: Option<f32>) -> Self {
        let filters = |halfway: f32| settings.means.filtering && halfway > 0.0 && halfway < 1.0;
        Self {
            has_depths: settings.variant != Variant::Planar,
            tap: match halfway.map(filters) {
                Some(true) => ShadowTap::Filtered,
                Some(false) => ShadowTap::Nearest,
                None if settings.gathers() => ShadowTap::Gathered,
                None => ShadowTap::Manual,
            },
            has_mask: settings.variant == Variant::Ground && has_ground,
            has_flat_mask: settings.variant == Variant::Planar,
        }
    }

    /// Whether maps are read through a sampler.
    pub fn has_sampler(&self) -> bool {
        self.has_depths && self.tap != ShadowTap::Manual
    }

    /// Slots of the bindings.
    pub fn slots(&self) -> usize {
        let flat = usize::from(self.has_flat_mask);
        flat + 2 * usize::from(self.has_depths) + usize::from(self.has_sampler()) + 2 * usize::from(self.has_mask)
    }
}

impl Bindings {
    /// Layouts for what is read.
    pub fn new(gpu: &Gpu, reads: &Reads) -> Self {
        let uniform = wgpu::BufferBindingType::Uniform;
        let buffer = wgpu::BindingType::Buffer { ty: uniform, has_dynamic_offset: false, min_binding_size: None };
        let view_layout = layout(gpu, "shadow view", wgpu::ShaderStages::VERTEX, &[(0, buffer)]);
        let depths = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Depth,
            view_dimension: wgpu::TextureViewDimension::D2Array,
            multisampled: false,
        };
        let mask = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: true },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let mut entries = Vec::new();
        if reads.has_flat_mask {
            entries.push((0, mask));
        }
        if reads.has_depths {
            entries.extend([(0, buffer), (1, depths)]);
        }
        let binding = match reads.tap {
            ShadowTap::Manual => None,
            ShadowTap::Nearest | ShadowTap::Filtered => Some(wgpu::SamplerBindingType::Comparison),
            ShadowTap::Gathered => Some(wgpu::SamplerBindingType::NonFiltering),
        };
        entries.extend(binding.filter(|_| reads.has_depths).map(|ty| (2, wgpu::BindingType::Sampler(ty))));
        if reads.has_mask {
            entries.extend([(3, mask), (4, wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering))]);
        }
        let linear = || {
            gpu.device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("mask"),
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                ..Default::default()
            })
        };
        Self {
            view_layout,
            read_layout: layout(gpu, "shadow maps", wgpu::ShaderStages::FRAGMENT, &entries),
            views: Vec::new(),
            maps: uniform_buffer(gpu, size_of::<ShadowMapsUniform>()),
            sampler: match reads.tap {
                _ if !reads.has_depths => None,
                ShadowTap::Manual => None,
                ShadowTap::Nearest => Some(comparison_sampler(gpu, false)),
                ShadowTap::Filtered => Some(comparison_sampler(gpu, true)),
                ShadowTap::Gathered => Some(gpu.device.create_sampler(&wgpu::SamplerDescriptor::default())),
            },
            linear: reads.has_mask.then(linear),
        }
    }

    /// What surfaces read, bound, and in how many slots.
    pub fn read(
        &self,
        gpu: &Gpu,
        depths: Option<&Depths>,
        mask: Option<&Mask>,
        flat: Option<&Mask>,
    ) -> (wgpu::BindGroup, usize) {
        use wgpu::BindingResource::{Sampler, TextureView};
        let mut entries = Vec::new();
        entries.extend(flat.map(|flat| (0, TextureView(&flat.view))));
        if let Some(depths) = depths {
            entries.extend([(0, self.maps.as_entire_binding()), (1, TextureView(&depths.all))]);
        }
        entries.extend(self.sampler.as_ref().map(|sampler| (2, Sampler(sampler))));
        if let (Some(mask), Some(linear)) = (mask, &self.linear) {
            entries.extend([(3, TextureView(&mask.view)), (4, Sampler(linear))]);
        }
        let slots = entries.len();
        (bind_group(gpu, "shadow maps", &self.read_layout, entries), slots)
    }

    /// Number of maps' matrices that are bound, each alone.
    pub fn view_count(&self) -> usize {
        self.views.len()
    }

    /// Writes the maps' matrices.
    pub fn write(&mut self, gpu: &Gpu, maps: &[MapProjection], eye_m: Vec3, ground_height_m: f32) {
        let mut all = ShadowMapsUniform { count: maps.len() as u32, ..Zeroable::zeroed() };
        for (view, map) in all.views.iter_mut().zip(maps.iter().take(MOST_MAPS)) {
            *view = ShadowViewUniform { ground_height_m, ..map.uniform(eye_m) };
        }
        gpu.queue.write_buffer(&self.maps, 0, bytemuck::bytes_of(&all));
        // What is laid flat has no map, and needs the ground's height all the same.
        let only_ground = ShadowViewUniform { ground_height_m, ..Zeroable::zeroed() };
        let views = if maps.is_empty() { &[only_ground][..] } else { &all.views[..maps.len().min(MOST_MAPS)] };
        while self.views.len() < views.len() {
            let buffer = uniform_buffer(gpu, size_of::<ShadowViewUniform>());
            let entries = vec![(0, buffer.as_entire_binding())];
            let group = bind_group(gpu, "shadow view", &self.view_layout, entries);
            self.views.push(MapView { buffer, group });
        }
        for (view, uniform) in self.views.iter().zip(views) {
            gpu.queue.write_buffer(&view.buffer, 0, bytemuck::bytes_of(uniform));
        }
    }

    /// The binding of a map's matrix, once it has been written.
    pub fn view(&self, index: usize) -> &wgpu::BindGroup {
        &self.views[index].group
    }
}

/// The layout of a picture to be blurred.
pub fn blur_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let mask = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: false },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    layout(gpu, "blur", wgpu::ShaderStages::FRAGMENT, &[(0, mask)])
}

/// A picture to be blurred, bound.
pub fn blur_group(gpu: &Gpu, layout: &wgpu::BindGroupLayout, mask: &Mask) -> wgpu::BindGroup {
    bind_group(gpu, "blur", layout, vec![(0, wgpu::BindingResource::TextureView(&mask.view))])
}

fn layout(
    gpu: &Gpu,
    label: &str,
    visibility: wgpu::ShaderStages,
    entries: &[(u32, wgpu::BindingType)],
) -> wgpu::BindGroupLayout {
    let entry = |&(binding, ty)| wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None };
    let entries: Vec<_> = entries.iter().map(entry).collect();
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries: &entries })
}

fn bind_group(
    gpu: &Gpu,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    entries: Vec<(u32, wgpu::BindingResource<'_>)>,
) -> wgpu::BindGroup {
    let entries = entries.into_iter().map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource });
    let entries: Vec<_> = entries.collect();
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some(label), layout, entries: &entries })
}

fn uniform_buffer(gpu: &Gpu, size: usize) -> wgpu::Buffer {
    gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("shadow maps"),
        size: size as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}
