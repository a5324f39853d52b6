//! Casters on the GPU, and what a light makes of them.

use super::super::device::{Gpu, GpuError};
use crate::volumes::nearest::distance_m;
use crate::volumes::overlap;
use crate::volumes::silhouettes::volumes;
use crate::volumes::{
    Casters, Extrusion, Faces, FramePlan, Light, MOST_COUNTED, MOST_COUNTED_BY_RUN, Mode, Part, Parts, Savings, Sharing,
};
use std::borrow::Cow;
use std::ops::Range;
use std::time::Instant;
use sunbake_shaders::{VolumeCorners, VolumeLight};
use wgpu::util::{BufferInitDescriptor, DeviceExt};

/// How many times as far from a lamp as its caster a volume may end.
const MOST_TIMES: f64 = 1e4;
/// A triangle that is not there, in `volume_found.wgsl`.
const NO_TRIANGLE: u32 = u32::MAX;

/// What never changes: points and, where the vertex shader finds silhouettes, edges and triangles.
pub struct CasterBuffers {
    points: wgpu::Buffer,
    found: Option<FoundBuffers>,
}

/// What the vertex shader finds silhouettes in.
struct FoundBuffers {
    walls: wgpu::Buffer,
    triangles: wgpu::Buffer,
    /// For each caster, places in `walls`.
    of_caster: Vec<Range<u32>>,
}

impl CasterBuffers {
    /// Uploads casters, with their edges where the vertex shader is to find silhouettes.
    pub fn new(gpu: &Gpu, casters: &Casters, mode: Mode) -> Result<Self, GpuError> {
        // An empty buffer cannot be bound.
        let points: Vec<f32> = casters.points_m.iter().flat_map(|p| p.to_array()).chain([0.0; 3]).collect();
        let used = if casters.points_m.is_empty() { 3 } else { points.len() - 3 };
        let points = storage(gpu, "points of casters", bytemuck::cast_slice(&points[..used]))?;
        let found = (mode == Mode::Gpu && !casters.triangles.is_empty()).then(|| found(gpu, casters)).transpose()?;
        Ok(Self { points, found })
    }

    /// Layout of the bindings of what a light extrudes. All layouts of the same bindings are alike.
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
        let entries: Vec<_> = self.places(light).map(entry).collect();
        let descriptor = wgpu::BindGroupLayoutDescriptor { label: Some("volumes"), entries: &entries };
        gpu.device.create_bind_group_layout(&descriptor)
    }

    /// Places of bindings.
    fn places(&self, light: VolumeLight) -> impl Iterator<Item = u32> + use<> {
        let (is_found, has_reaches) = (self.found.is_some(), light == VolumeLight::LampWithRange);
        let used = [(0, true), (1, has_reaches), (2, is_found), (3, is_found), (4, is_found)];
        used.into_iter().filter(|(_, is_used)| *is_used).map(|(binding, _)| binding)
    }

    /// Slots of the bindings of what a light extrudes.
    pub fn slots(&self, light: VolumeLight) -> usize {
        self.places(light).count()
    }

    /// Number of buffers, and their bytes.
    pub fn size(&self) -> (usize, u64) {
        let found = self.found.iter().flat_map(|found| [&found.walls, &found.triangles]);
        let all: Vec<&wgpu::Buffer> = std::iter::once(&self.points).chain(found).collect();
        (all.len(), all.iter().map(|buffer| buffer.size()).sum())
    }
}

/// Number of the buffers that all lights share, and the most bytes that they may have.
pub fn size_of(casters: &Casters, mode: Mode) -> (usize, u64) {
    let points = 12 * casters.points_m.len().max(1) as u64;
    match mode == Mode::Gpu && !casters.triangles.is_empty() {
        true => (3, points + 16 * casters.uses.len() as u64 + 12 * casters.triangles.len() as u64),
        false => (1, points),
    }
}

fn found(gpu: &Gpu, casters: &Casters) -> Result<FoundBuffers, GpuError> {
    let mut records: Vec<[u32; 4]> = Vec::new();
    let mut of_caster = Vec::new();
    for caster in &casters.all {
        let first = records.len() as u32;
        for edge in caster.edges.clone() {
            // Triangles that run one way are paired with those that run the other, so that along a solid's edges no pair
            // asks for more than one wall.
            let [along, against]: [Vec<_>; 2] = [1, -1]
                .map(|sign| casters.uses_of(edge).iter().filter(|u| u.sign() == sign).map(|u| u.code()).collect());
            let paired = along.len().min(against.len());
            let [low, high] = casters.edges[edge];
            records.extend((0..paired).map(|i| [low, high, along[i], against[i]]));
            let rest: Vec<u32> = along[paired..].iter().chain(&against[paired..]).copied().collect();
            records.extend(rest.chunks(2).map(|two| [low, high, two[0], two.get(1).copied().unwrap_or(NO_TRIANGLE)]));
        }
        of_caster.push(first..records.len() as u32);
    }
    Ok(FoundBuffers {
        walls: storage(gpu, "edges of casters", bytemuck::cast_slice(&records))?,
        triangles: storage(gpu, "triangles of casters", bytemuck::cast_slice(&casters.triangles))?,
        of_caster,
    })
}

fn storage(gpu: &Gpu, label: &'static str, contents: &[u8]) -> Result<wgpu::Buffer, GpuError> {
    let limit = gpu.device.limits().max_storage_buffer_binding_size;
    GpuError::check_limit(format!("the buffer of {label}, in bytes,"), contents.len() as u64, limit)?;
    let usage = wgpu::BufferUsages::STORAGE;
    Ok(gpu.device.create_buffer_init(&BufferInitDescriptor { label: Some(label), contents, usage }))
}

/// What a light makes of the casters, kept while it stands still.
pub struct Extruded {
    /// The light.
    pub light: Light,
    /// What the light makes of the triangles.
    pub faces: Faces,
    /// Which shaders draw it.
    pub kind: (VolumeLight, VolumeCorners),
    /// Casters in as many runs as the stencil's bits ask for; mostly one.
    pub runs: Vec<Run>,
    /// How long it took to find which triangles face the light, and the silhouettes.
    pub find_seconds: f64,
    /// Of this, how long it took to make sure that the stencil can count them.
    pub overlap_seconds: f64,
    buffers: (usize, u64),
}

/// Volumes whose prisms can be counted together.
pub struct Run {
    /// Where each caster's parts lie.
    pub parts: Vec<Parts>,
    /// Corners, where they are listed.
    pub indices: Option<wgpu::Buffer>,
    /// Bindings.
    pub group: wgpu::BindGroup,
    /// Slots of these.
    pub slots: usize,
}

impl Extruded {
    /// Finds what a light makes of the casters.
    pub fn new(
        gpu: &Gpu,
        casters: &Casters,
        buffers: &CasterBuffers,
        light: Light,
        mode: Mode,
        savings: Savings,
    ) -> Result<Self, GpuError> {
        let started = Instant::now();
        let faces = light.faces(casters, savings.solids);
        let counting = Instant::now();
        let runs = match overlap::runs(casters, &faces.of_triangle, &light, MOST_COUNTED) {
            one if one.len() == 1 => one,
            _ => overlap::runs(casters, &faces.of_triangle, &light, MOST_COUNTED_BY_RUN),
        };
        let overlap_seconds = counting.elapsed().as_secs_f64();
        let corners = if buffers.found.is_some() { VolumeCorners::Found } else { VolumeCorners::Indexed };
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
            faces: Faces::default(),
        };
        for run in &runs {
            let in_run = |(i, &face): (usize, &i8)| if run.contains(&i) { face } else { 0 };
            let of_run: Cow<[i8]> = match runs.len() {
                1 => Cow::Borrowed(&faces.of_triangle),
                _ => faces.of_triangle.iter().enumerate().map(in_run).collect(),
            };
            let run = match &buffers.found {
                Some(found) => made.find(gpu, casters, buffers, found, reaches.as_ref(), &of_run, extrusion)?,
                None => {
                    let sharing = if mode == Mode::Triangles { Sharing::Prisms } else { Sharing::Silhouettes };
                    made.list(gpu, casters, buffers, reaches.as_ref(), &of_run, (extrusion, sharing))?
                }
            };
            made.runs.push(run);
        }
        made.faces = faces;
        made.find_seconds = started.elapsed().as_secs_f64();
        Ok(made)
    }

    /// Silhouettes found here.
    fn list(
        &mut self,
        gpu: &Gpu,
        casters: &Casters,
        buffers: &CasterBuffers,
        reaches: Option<&wgpu::Buffer>,
        faces: &[i8],
        (extrusion, sharing): (Extrusion, Sharing),
    ) -> Result<Run, GpuError> {
        let volumes = volumes(casters, faces, extrusion, sharing);
        let contents: &[u8] = bytemuck::cast_slice(&volumes.indices);
        let limit = gpu.device.limits().max_buffer_size;
        GpuError::check_limit("the buffer of shadow volumes, in bytes,", contents.len() as u64, limit)?;
        let descriptor = BufferInitDescriptor { label: Some("volumes"), contents, usage: wgpu::BufferUsages::INDEX };
        let indices = (!contents.is_empty()).then(|| gpu.device.create_buffer_init(&descriptor));
        self.buffers.0 += usize::from(indices.is_some());
        self.buffers.1 += contents.len() as u64;
        let (group, slots) = group(gpu, &buffers.layout(gpu, self.kind.0), &[(0, Some(&buffers.points)), (1, reaches)]);
        Ok(Run { parts: volumes.parts, indices, group, slots })
    }

    /// Silhouettes to be found by the vertex shader, from how each triangle counts.
    #[expect(clippy::too_many_arguments, reason = "what is bound, one by one")]
    fn find(
        &mut self,
        gpu: &Gpu,
        casters: &Casters,
        buffers: &CasterBuffers,
        found: &FoundBuffers,
        reaches: Option<&wgpu::Buffer>,
        faces: &[i8],
        extrusion: Extrusion,
    ) -> Result<Run, GpuError> {
        let word = |of: &[i8]| of.iter().enumerate().fold(0, |word, (i, face)| word | ((face + 1) as u32) << (2 * i));
        let packed: Vec<u32> = faces.chunks(16).map(word).collect();
        let packed = storage(gpu, "faces", bytemuck::cast_slice(&packed))?;
        self.buffers.0 += 1;
        self.buffers.1 += packed.size();
        let corners = 3 * extrusion.wall_triangles();
        let parts = casters.all.iter().zip(&found.of_caster).map(|(caster, walls)| {
            let caps = 3 * caster.triangles.start as u32..3 * caster.triangles.end as u32;
            let dark_caps = if extrusion == Extrusion::Spread { caps.clone() } else { 0..0 };
            Parts { walls: corners * walls.start..corners * walls.end, caps, dark_caps }
        });
        let bound = [
            (0, Some(&buffers.points)),
            (1, reaches),
            (2, Some(&found.walls)),
            (3, Some(&found.triangles)),
            (4, Some(&packed)),
        ];
        let (group, slots) = group(gpu, &buffers.layout(gpu, self.kind.0), &bound);
        Ok(Run { parts: parts.collect(), indices: None, group, slots })
    }

    /// Number of buffers, and their bytes.
    pub fn size(&self) -> (usize, u64) {
        self.buffers
    }

    /// Whether a caster's edges may ask for two walls where they are found by the vertex shader.
    fn may_double(&self, caster: usize, savings: Savings) -> bool {
        !(savings.solids && self.faces.is_solid[caster])
    }
}

/// For each point, how many times as far from the lamp its caster's volume must end, so that the flat end of each prism lies
/// beyond the range: as many times as its nearest place goes into it. None where a lamp all but touches a caster, whose
/// volume would end nowhere that `f32` could tell.
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

/// Buffers, bound, and how many they are.
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

/// What is drawn at once.
#[derive(Debug, Clone)]
pub struct DrawCall {
    /// Of which the vertex shader needs to know, where it finds silhouettes.
    pub part: Part,
    /// Corners.
    pub corners: Range<u32>,
    /// How often.
    pub instances: u32,
}

/// What a plan makes of the volumes: for each run, what is counted before the surface and what behind it.
pub struct Draws {
    /// For each run, before and behind.
    pub runs: Vec<[Vec<DrawCall>; 2]>,
}

impl Draws {
    /// Follows a plan.
    pub fn new(extruded: &Extruded, plan: &FramePlan, savings: Savings) -> Self {
        let of_run = |run| [true, false].map(|is_z_pass| draws(extruded, run, plan, is_z_pass, savings));
        let runs = match plan.draws_anything() {
            true => extruded.runs.iter().map(of_run).collect(),
            false => Vec::new(),
        };
        Self { runs }
    }

    /// All of them, and whether each is counted before the surface.
    pub fn all(&self) -> impl Iterator<Item = (&DrawCall, bool)> {
        self.runs.iter().flat_map(|[before, behind]| {
            before.iter().map(|draw| (draw, true)).chain(behind.iter().map(|draw| (draw, false)))
        })
    }

    /// Number of triangles.
    pub fn triangles(&self) -> usize {
        self.all().map(|(draw, _)| draw.corners.len() * draw.instances as usize).sum::<usize>() / 3
    }
}

fn draws(extruded: &Extruded, run: &Run, plan: &FramePlan, is_z_pass: bool, savings: Savings) -> Vec<DrawCall> {
    let draw = |part, instances| move |corners| DrawCall { part, corners, instances };
    if extruded.kind.1 == VolumeCorners::Indexed {
        return plan
            .ranges(&run.parts, is_z_pass, &Part::ALL, |_| true)
            .into_iter()
            .map(draw(Part::Walls, 1))
            .collect();
    }
    let walls = |doubles: bool| {
        let is_wanted = |caster| extruded.may_double(caster, savings) == doubles;
        let ranges = plan.ranges(&run.parts, is_z_pass, &[Part::Walls], is_wanted);
        ranges.into_iter().map(draw(Part::Walls, 1 + u32::from(doubles)))
    };
    let caps = [Part::Caps, Part::DarkCaps]
        .into_iter()
        .flat_map(|part| plan.ranges(&run.parts, is_z_pass, &[part], |_| true).into_iter().map(draw(part, 1)));
    walls(false).chain(walls(true)).chain(caps).collect()
}
