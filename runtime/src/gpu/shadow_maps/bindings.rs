//! Bind groups of shadow maps: each map's matrix, for the pass that draws it, and what surfaces read.

use super::probe::comparison_sampler;
use super::textures::{CasterMask, DepthMaps};
use crate::gpu::device::Gpu;
use crate::gpu::frame::write_in_order;
use crate::shadow_maps::{MOST_MAPS, MapProjection, MapSettings, Variant};
use bytemuck::Zeroable;
use glam::Vec3;
use sunbake_shaders::{ShadowMapUniform, ShadowMapsUniform, ShadowTap};

/// One map's matrix, for the pass that draws it.
pub struct MapMatrix {
    buffer: wgpu::Buffer,
    pub group: wgpu::BindGroup,
}

/// Layouts and buffers that do not depend on how many maps there are.
pub struct MapBindings {
    /// Layout of a map's matrix.
    pub matrix_layout: wgpu::BindGroupLayout,
    /// Layout of what surfaces read.
    pub read_layout: wgpu::BindGroupLayout,
    matrices: Vec<MapMatrix>,
    maps: wgpu::Buffer,
    sampler: Option<wgpu::Sampler>,
    linear: Option<wgpu::Sampler>,
}

/// What surfaces read of shadow maps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MapReads {
    /// Shadow maps.
    pub has_depths: bool,
    /// How they are read.
    pub tap: ShadowTap,
    /// A blurred mask, as the sun sees it.
    pub has_mask: bool,
    /// A mask of casters projected flat onto the ground, as the camera sees it.
    pub has_flat_mask: bool,
}

impl MapReads {
    /// What surfaces read. `halfway` is what a comparison sampler reads between light and shade; none where no
    /// sampler compares.
    pub fn new(settings: &MapSettings, has_ground: bool, halfway: Option<f32>) -> Self {
        let filters = |halfway: f32| settings.optimizations.filtering && halfway > 0.0 && halfway < 1.0;
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

    /// Entries of the group.
    pub fn binding_count(&self) -> usize {
        let flat = usize::from(self.has_flat_mask);
        flat + 2 * usize::from(self.has_depths) + usize::from(self.has_sampler()) + 2 * usize::from(self.has_mask)
    }
}

impl MapBindings {
    /// Layouts for what is read.
    pub fn new(gpu: &Gpu, reads: &MapReads) -> Self {
        let uniform = wgpu::BufferBindingType::Uniform;
        let buffer = wgpu::BindingType::Buffer { ty: uniform, has_dynamic_offset: false, min_binding_size: None };
        let matrix_layout = layout(gpu, "shadow map matrix", wgpu::ShaderStages::VERTEX, &[(0, buffer)]);
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
            matrix_layout,
            read_layout: layout(gpu, "shadow maps", wgpu::ShaderStages::FRAGMENT, &entries),
            matrices: Vec::new(),
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

    /// The group of what surfaces read, and its number of entries.
    pub fn read(
        &self,
        gpu: &Gpu,
        depths: Option<&DepthMaps>,
        mask: Option<&CasterMask>,
        flat: Option<&CasterMask>,
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
        let binding_count = entries.len();
        (bind_group(gpu, "shadow maps", &self.read_layout, entries), binding_count)
    }

    /// Number of matrices with a group each.
    pub fn matrix_count(&self) -> usize {
        self.matrices.len()
    }

    /// Writes the maps' matrices, in the encoder's order.
    pub fn write(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        maps: &[MapProjection],
        eye_m: Vec3,
        ground_height_m: f32,
    ) {
        let mut all = ShadowMapsUniform { count: maps.len() as u32, ..Zeroable::zeroed() };
        for (uniform, map) in all.maps.iter_mut().zip(maps.iter().take(MOST_MAPS)) {
            *uniform = ShadowMapUniform { ground_height_m, ..map.uniform(eye_m) };
        }
        write_in_order(gpu, encoder, &self.maps, bytemuck::bytes_of(&all));
        // A flat mask has no map, but needs the ground's height.
        let only_ground = ShadowMapUniform { ground_height_m, ..Zeroable::zeroed() };
        let uniforms = if maps.is_empty() { &[only_ground][..] } else { &all.maps[..maps.len().min(MOST_MAPS)] };
        while self.matrices.len() < uniforms.len() {
            let buffer = uniform_buffer(gpu, size_of::<ShadowMapUniform>());
            let entries = vec![(0, buffer.as_entire_binding())];
            let group = bind_group(gpu, "shadow map matrix", &self.matrix_layout, entries);
            self.matrices.push(MapMatrix { buffer, group });
        }
        for (matrix, uniform) in self.matrices.iter().zip(uniforms) {
            write_in_order(gpu, encoder, &matrix.buffer, bytemuck::bytes_of(uniform));
        }
    }

    /// The group of a map's matrix, once it has been written.
    pub fn matrix_group(&self, index: usize) -> &wgpu::BindGroup {
        &self.matrices[index].group
    }
}

/// The layout of a mask to be blurred.
pub fn blur_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let mask = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: false },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    layout(gpu, "blur", wgpu::ShaderStages::FRAGMENT, &[(0, mask)])
}

/// The group of a mask to be blurred.
pub fn blur_group(gpu: &Gpu, layout: &wgpu::BindGroupLayout, mask: &CasterMask) -> wgpu::BindGroup {
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
