//! Casters on the GPU: built once per stage, whatever the light.

use crate::gpu::device::{Gpu, GpuError};
use crate::volumes::{Casters, Mode};
use std::ops::Range;
use sunbake_shaders::VolumeLight;
use wgpu::util::{BufferInitDescriptor, DeviceExt};

/// Marks a missing second triangle; as in `volumes/silhouettes_by_gpu.wgsl`.
const NO_TRIANGLE: u32 = u32::MAX;

/// Points of the casters and, where the vertex shader finds silhouettes, edges and triangles.
pub struct CasterBuffers {
    pub points: wgpu::Buffer,
    /// Only where the vertex shader finds silhouettes.
    pub edges: Option<EdgeBuffers>,
}

/// What the vertex shader finds silhouettes in.
pub struct EdgeBuffers {
    /// Edges, with two triangles each.
    pub walls: wgpu::Buffer,
    /// Corners of triangles.
    pub triangles: wgpu::Buffer,
    /// For each caster, its range of `walls`.
    pub of_caster: Vec<Range<u32>>,
}

impl CasterBuffers {
    /// Uploads casters, with their edges where the vertex shader is to find silhouettes.
    pub fn new(gpu: &Gpu, casters: &Casters, mode: Mode) -> Result<Self, GpuError> {
        // An empty buffer cannot be bound.
        let points: Vec<f32> = casters.points_m.iter().flat_map(|p| p.to_array()).chain([0.0; 3]).collect();
        let used = if casters.points_m.is_empty() { 3 } else { points.len() - 3 };
        let points = storage(gpu, "points of casters", bytemuck::cast_slice(&points[..used]))?;
        let has_edges = mode == Mode::Gpu && !casters.triangles.is_empty();
        let edges = has_edges.then(|| EdgeBuffers::new(gpu, casters)).transpose()?;
        Ok(Self { points, edges })
    }

    /// Layout of the bind group of what a light extrudes.
    pub fn layout(&self, gpu: &Gpu, light: VolumeLight) -> wgpu::BindGroupLayout {
        let entry = |binding: u32| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::VERTEX,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Storage { read_only: true },
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        };
        let entries: Vec<_> = self.bindings(light).map(entry).collect();
        let descriptor = wgpu::BindGroupLayoutDescriptor { label: Some("volumes"), entries: &entries };
        gpu.device.create_bind_group_layout(&descriptor)
    }

    /// The bindings that are used.
    fn bindings(&self, light: VolumeLight) -> impl Iterator<Item = u32> + use<> {
        let (has_edges, has_reaches) = (self.edges.is_some(), light == VolumeLight::LampWithRange);
        let used = [(0, true), (1, has_reaches), (2, has_edges), (3, has_edges), (4, has_edges)];
        used.into_iter().filter(|(_, is_used)| *is_used).map(|(binding, _)| binding)
    }

    /// Entries of the bind group of what a light extrudes.
    pub fn binding_count(&self, light: VolumeLight) -> usize {
        self.bindings(light).count()
    }

    /// Number of buffers, and their bytes.
    pub fn size(&self) -> (usize, u64) {
        let of_edges = self.edges.iter().flat_map(|edges| [&edges.walls, &edges.triangles]);
        let all: Vec<&wgpu::Buffer> = std::iter::once(&self.points).chain(of_edges).collect();
        (all.len(), all.iter().map(|buffer| buffer.size()).sum())
    }
}

/// Number of the buffers that all lights share, and an upper bound of their bytes.
pub fn size_of(casters: &Casters, mode: Mode) -> (usize, u64) {
    let points = 12 * casters.points_m.len().max(1) as u64;
    match mode == Mode::Gpu && !casters.triangles.is_empty() {
        true => (3, points + 16 * casters.uses.len() as u64 + 12 * casters.triangles.len() as u64),
        false => (1, points),
    }
}

impl EdgeBuffers {
    fn new(gpu: &Gpu, casters: &Casters) -> Result<Self, GpuError> {
        let mut records: Vec<[u32; 4]> = Vec::new();
        let mut of_caster = Vec::new();
        for caster in &casters.all {
            let first = records.len() as u32;
            for edge in caster.edges.clone() {
                // Triangles that run along the edge are paired with those that run against it. Then no pair of a closed
                // mesh needs more than one wall.
                let [along, against]: [Vec<_>; 2] = [1, -1]
                    .map(|sign| casters.uses_of(edge).iter().filter(|u| u.sign() == sign).map(|u| u.code()).collect());
                let paired = along.len().min(against.len());
                let [low, high] = casters.edges[edge];
                records.extend((0..paired).map(|i| [low, high, along[i], against[i]]));
                let rest: Vec<u32> = along[paired..].iter().chain(&against[paired..]).copied().collect();
                records
                    .extend(rest.chunks(2).map(|two| [low, high, two[0], two.get(1).copied().unwrap_or(NO_TRIANGLE)]));
            }
            of_caster.push(first..records.len() as u32);
        }
        Ok(Self {
            walls: storage(gpu, "edges of casters", bytemuck::cast_slice(&records))?,
            triangles: storage(gpu, "triangles of casters", bytemuck::cast_slice(&casters.triangles))?,
            of_caster,
        })
    }
}

/// A storage buffer, if it fits the device.
pub fn storage(gpu: &Gpu, label: &'static str, contents: &[u8]) -> Result<wgpu::Buffer, GpuError> {
    let limit = gpu.device.limits().max_storage_buffer_binding_size;
    GpuError::check_limit(format!("the buffer of {label}, in bytes,"), contents.len() as u64, limit)?;
    let usage = wgpu::BufferUsages::STORAGE;
    Ok(gpu.device.create_buffer_init(&BufferInitDescriptor { label: Some(label), contents, usage }))
}
