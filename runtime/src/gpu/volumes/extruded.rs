//! What a light makes of the casters: volumes, kept while the light stands still.

use super::caster_buffers::{CasterBuffers, EdgeBuffers, storage};
use crate::gpu::device::{Gpu, GpuError};
use crate::volumes::nearest::distance_m;
use crate::volumes::overlap;
use crate::volumes::silhouettes::volumes;
use crate::volumes::{
    Casters, Extrusion, Facings, Light, MOST_COUNTED, MOST_COUNTED_BY_RUN, Mode, Parts, Sharing, VolumeOptimizations,
};
use std::borrow::Cow;
use std::time::Instant;
use sunbake_shaders::{VolumeCorners, VolumeLight};
use wgpu::util::{BufferInitDescriptor, DeviceExt};

/// Code of a triangle that is spared; as in `volumes/silhouettes_by_gpu.wgsl`.
const SPARED: u32 = 3;
/// The farthest end of a lamp's volume, as a multiple of its caster's distance.
const MOST_TIMES: f64 = 1e4;

/// The volumes of a light.
pub struct Extruded {
    /// The light that these volumes are of.
    pub light: Light,
    /// What the light makes of the triangles.
    pub facings: Facings,
    /// Which shaders draw them.
    pub kind: (VolumeLight, VolumeCorners),
    /// Casters in as many runs as the stencil's bits need; mostly one.
    pub runs: Vec<CountedRun>,
    /// Seconds to find which triangles face the light, and the silhouettes.
    pub find_seconds: f64,
    /// Of these, seconds to make sure that the stencil can count them.
    pub overlap_seconds: f64,
    buffers: (usize, u64),
}

/// Volumes that the stencil can count together.
pub struct CountedRun {
    /// The parts of each caster, as ranges of corners.
    pub parts: Vec<Parts>,
    /// Corners, where the CPU found silhouettes.
    pub indices: Option<wgpu::Buffer>,
    pub group: wgpu::BindGroup,
    /// Entries of the group.
    pub binding_count: usize,
}

impl Extruded {
    /// Finds what a light makes of the casters.
    pub fn new(
        gpu: &Gpu,
        casters: &Casters,
        buffers: &CasterBuffers,
        light: Light,
        mode: Mode,
        optimizations: VolumeOptimizations,
    ) -> Result<Self, GpuError> {
        let started = Instant::now();
        let facings = light.facings(casters, optimizations.solids);
        let counting = Instant::now();
        let runs = match overlap::runs(casters, &facings.of_triangle, &light, MOST_COUNTED) {
            one if one.len() == 1 => one,
            _ => overlap::runs(casters, &facings.of_triangle, &light, MOST_COUNTED_BY_RUN),
        };
        let overlap_seconds = counting.elapsed().as_secs_f64();
        let corners = if buffers.edges.is_some() { VolumeCorners::FromEdges } else { VolumeCorners::Indexed };
        let reaches = match light {
            Light::Lamp { position_m, range_m: Some(range_m) } => reaches(casters, position_m, range_m),
            _ => None,
        };
        let reaches = reaches.map(|all| storage(gpu, "reaches", bytemuck::cast_slice(&all))).transpose()?;
        let (extrusion, volume_light) = match light {
            Light::Sun { .. } => (Extrusion::ToPoint, VolumeLight::Sun),
            Light::Lamp { .. } if reaches.is_none() => (Extrusion::Spread, VolumeLight::Lamp),
            Light::Lamp { .. } => (Extrusion::Spread, VolumeLight::LampWithRange),
        };
        let mut made = Self {
            light,
            kind: (volume_light, corners),
            runs: Vec::with_capacity(runs.len()),
            find_seconds: 0.0,
            overlap_seconds,
            buffers: (usize::from(reaches.is_some()), reaches.as_ref().map_or(0, wgpu::Buffer::size)),
            facings: Facings::default(),
        };
        for run in &runs {
            let of_run = match runs.len() {
                1 => Cow::Borrowed(&facings),
                _ => Cow::Owned(facings.within(run)),
            };
            let run = match &buffers.edges {
                Some(edges) => made.find(gpu, casters, buffers, edges, reaches.as_ref(), &of_run, extrusion)?,
                None => {
                    let sharing = if mode == Mode::Triangles { Sharing::Prisms } else { Sharing::Silhouettes };
                    made.list(gpu, casters, buffers, reaches.as_ref(), &of_run, (extrusion, sharing))?
                }
            };
            made.runs.push(run);
        }
        made.facings = facings;
        made.find_seconds = started.elapsed().as_secs_f64();
        Ok(made)
    }

    /// Silhouettes found by the CPU.
    fn list(
        &mut self,
        gpu: &Gpu,
        casters: &Casters,
        buffers: &CasterBuffers,
        reaches: Option<&wgpu::Buffer>,
        facings: &Facings,
        (extrusion, sharing): (Extrusion, Sharing),
    ) -> Result<CountedRun, GpuError> {
        let volumes = volumes(casters, facings, extrusion, sharing);
        let contents: &[u8] = bytemuck::cast_slice(&volumes.indices);
        let limit = gpu.device.limits().max_buffer_size;
        GpuError::check_limit("the buffer of shadow volumes, in bytes,", contents.len() as u64, limit)?;
        let descriptor = BufferInitDescriptor { label: Some("volumes"), contents, usage: wgpu::BufferUsages::INDEX };
        let indices = (!contents.is_empty()).then(|| gpu.device.create_buffer_init(&descriptor));
        self.buffers.0 += usize::from(indices.is_some());
        self.buffers.1 += contents.len() as u64;
        let bound = [(0, Some(&buffers.points)), (1, reaches)];
        let (group, binding_count) = group(gpu, &buffers.layout(gpu, self.kind.0), &bound);
        Ok(CountedRun { parts: volumes.parts, indices, group, binding_count })
    }

    /// Silhouettes to be found by the vertex shader, from how each triangle counts.
    #[expect(clippy::too_many_arguments, reason = "what is bound, one by one")]
    fn find(
        &mut self,
        gpu: &Gpu,
        casters: &Casters,
        buffers: &CasterBuffers,
        edges: &EdgeBuffers,
        reaches: Option<&wgpu::Buffer>,
        facings: &Facings,
        extrusion: Extrusion,
    ) -> Result<CountedRun, GpuError> {
        let code = |(&facing, &is_spared): (&i8, &bool)| if is_spared { SPARED } else { (facing + 1) as u32 };
        let codes: Vec<u32> = facings.of_triangle.iter().zip(&facings.is_spared).map(code).collect();
        let word = |of: &[u32]| of.iter().enumerate().fold(0, |word, (i, code)| word | code << (2 * i));
        let packed: Vec<u32> = codes.chunks(16).map(word).collect();
        let packed = storage(gpu, "facings", bytemuck::cast_slice(&packed))?;
        self.buffers.0 += 1;
        self.buffers.1 += packed.size();
        let corners = 3 * extrusion.wall_triangles();
        let parts = casters.all.iter().zip(&edges.of_caster).map(|(caster, walls)| {
            let caps = 3 * caster.triangles.start as u32..3 * caster.triangles.end as u32;
            let dark_caps = if extrusion == Extrusion::Spread { caps.clone() } else { 0..0 };
            let spares = facings.is_spared[caster.triangles.clone()].contains(&true);
            let spared = if spares { caps.clone() } else { 0..0 };
            Parts { walls: corners * walls.start..corners * walls.end, caps, dark_caps, spared }
        });
        let bound = [
            (0, Some(&buffers.points)),
            (1, reaches),
            (2, Some(&edges.walls)),
            (3, Some(&edges.triangles)),
            (4, Some(&packed)),
        ];
        let (group, binding_count) = group(gpu, &buffers.layout(gpu, self.kind.0), &bound);
        Ok(CountedRun { parts: parts.collect(), indices: None, group, binding_count })
    }

    /// Number of buffers, and their bytes.
    pub fn size(&self) -> (usize, u64) {
        self.buffers
    }

    /// Whether a caster's edges may need two walls, where the vertex shader finds them.
    pub fn may_double(&self, caster: usize, optimizations: VolumeOptimizations) -> bool {
        !(optimizations.solids && self.facings.is_solid[caster])
    }
}

/// For each point, the end of its caster's volume as a multiple of the point's distance from the lamp, so that the
/// flat end of each prism lies beyond the lamp's range. None where the lamp all but touches a caster: its volume
/// would end too far away for `f32`.
fn reaches(casters: &Casters, lamp_m: glam::DVec3, range_m: f64) -> Option<Vec<f32>> {
    let mut reaches = vec![1.0f32; casters.points_m.len().max(1)];
    for caster in &casters.all {
        let distances = caster.triangles.clone().map(|triangle| distance_m(&casters.corners_m(triangle), lamp_m));
        let nearest_m = distances.fold(f64::INFINITY, f64::min);
        let times = (1.01 * range_m / nearest_m.max(f64::MIN_POSITIVE)).max(1.01);
        if times > MOST_TIMES {
            return None;
        }
        for triangle in caster.triangles.clone() {
            casters.triangles[triangle].iter().for_each(|&point| reaches[point as usize] = times as f32);
        }
    }
    Some(reaches)
}

/// A bind group of buffers, and its number of entries.
fn group(
    gpu: &Gpu,
    layout: &wgpu::BindGroupLayout,
    buffers: &[(u32, Option<&wgpu::Buffer>)],
) -> (wgpu::BindGroup, usize) {
    let bound = buffers.iter().filter_map(|(binding, buffer)| {
        buffer.map(|buffer| wgpu::BindGroupEntry { binding: *binding, resource: buffer.as_entire_binding() })
    });
    let entries: Vec<_> = bound.collect();
    let descriptor = wgpu::BindGroupDescriptor { label: Some("volumes"), layout, entries: &entries };
    (gpu.device.create_bind_group(&descriptor), entries.len())
}
