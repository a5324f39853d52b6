//! Buffers that are filled once per stage: vertex streams and materials. And uniforms, written for each frame.

use super::batch::{Vertices, wrap_code};
use crate::View;
use crate::gpu::device::{Gpu, GpuError};
use crate::gpu::plan::SceneNeeds;
use crate::light::Moment;
use crate::stage::Stage;
use std::collections::BTreeMap;
use sunbake::scene::looks::Look;
use sunbake::scene::{Alpha, Material};
use sunbake_shaders::{FrameUniform, LampUniform, MaterialUniform, SkyUniform, Stream};
use wgpu::util::{BufferInitDescriptor, DeviceExt};

/// Uploads the streams that have vertices.
pub fn upload_streams(gpu: &Gpu, vertices: &Vertices) -> Result<BTreeMap<Stream, wgpu::Buffer>, GpuError> {
    let all: [(Stream, &[u8]); 8] = [
        (Stream::Position, bytemuck::cast_slice(&vertices.positions)),
        (Stream::Surface, bytemuck::cast_slice(&vertices.surfaces)),
        (Stream::Texture, bytemuck::cast_slice(&vertices.textures)),
        (Stream::Color, bytemuck::cast_slice(&vertices.colors)),
        (Stream::MetallicRoughness, bytemuck::cast_slice(&vertices.metallic_roughness)),
        (Stream::Normal, bytemuck::cast_slice(&vertices.normals)),
        (Stream::Emissive, bytemuck::cast_slice(&vertices.emissive)),
        (Stream::Lift, bytemuck::cast_slice(&vertices.lifts)),
    ];
    let limit = gpu.device.limits().max_buffer_size;
    let mut streams = BTreeMap::new();
    for (stream, contents) in all.into_iter().filter(|(_, contents)| !contents.is_empty()) {
        GpuError::check_limit("a vertex buffer, in bytes,", contents.len() as u64, limit)?;
        let descriptor = BufferInitDescriptor { label: Some("vertices"), contents, usage: wgpu::BufferUsages::VERTEX };
        streams.insert(stream, gpu.device.create_buffer_init(&descriptor));
    }
    Ok(streams)
}

/// The frame's uniform buffers and the materials, with their layout and bindings.
pub struct FrameBindings {
    pub layout: wgpu::BindGroupLayout,
    pub group: wgpu::BindGroup,
    /// The lamp; none in a set without one.
    pub lamp: Option<wgpu::Buffer>,
    /// The sky in spherical harmonics; none where no page reads it.
    pub sky: Option<wgpu::Buffer>,
    /// Entries of the group.
    pub binding_count: usize,
    frame: wgpu::Buffer,
}

impl FrameBindings {
    /// Uploads the materials.
    pub fn new(gpu: &Gpu, stage: &Stage, needs: &SceneNeeds) -> Self {
        let materials = stage.scene.materials.iter().enumerate();
        let materials: Vec<MaterialUniform> = materials.map(|(i, m)| material_uniform(m, stage.look(i))).collect();
        let materials = gpu.device.create_buffer_init(&BufferInitDescriptor {
            label: Some("materials"),
            contents: bytemuck::cast_slice(&materials),
            usage: wgpu::BufferUsages::STORAGE,
        });
        let frame = uniform_buffer(gpu, "frame", size_of::<FrameUniform>());
        let lamp = needs.has_lamp.then(|| uniform_buffer(gpu, "lamp", size_of::<LampUniform>()));
        let sky = needs.has_sky().then(|| uniform_buffer(gpu, "sky", size_of::<SkyUniform>()));
        let storage = wgpu::BufferBindingType::Storage { read_only: true };
        let uniform = wgpu::BufferBindingType::Uniform;
        let mut bindings = vec![(0, &frame, uniform), (1, &materials, storage)];
        bindings.extend(lamp.iter().map(|lamp| (2, lamp, uniform)));
        bindings.extend(sky.iter().map(|sky| (3, sky, uniform)));
        let ((layout, group), binding_count) = (bound(gpu, &bindings), bindings.len());
        Self { layout, group, lamp, sky, binding_count, frame }
    }

    /// Writes the uniforms of a frame, in the encoder's order: passes recorded earlier still see the ones before. A
    /// lamp that is not shown gives no light.
    pub fn write(&self, gpu: &Gpu, encoder: &mut wgpu::CommandEncoder, view: &View, moment: &Moment) {
        write_in_order(gpu, encoder, &self.frame, bytemuck::bytes_of(&moment.uniform(view)));
        if let Some(buffer) = &self.lamp {
            let lamp = moment.lamp.map_or(bytemuck::Zeroable::zeroed(), |lamp| lamp.uniform());
            write_in_order(gpu, encoder, buffer, bytemuck::bytes_of::<LampUniform>(&lamp));
        }
        if let Some(buffer) = &self.sky {
            let sky = SkyUniform { coefficients: moment.sky_harmonics().map(|c| c.extend(0.0).to_array()) };
            write_in_order(gpu, encoder, buffer, bytemuck::bytes_of(&sky));
        }
    }
}

/// Fills a buffer by a copy in the encoder. `Queue::write_buffer` would run before all commands of the encoder, so
/// that a frame of several lights, or two pictures in one encoder, would see only what was written last.
pub fn write_in_order(gpu: &Gpu, encoder: &mut wgpu::CommandEncoder, buffer: &wgpu::Buffer, contents: &[u8]) {
    let usage = wgpu::BufferUsages::COPY_SRC;
    let staged = gpu.device.create_buffer_init(&BufferInitDescriptor { label: Some("staged"), contents, usage });
    encoder.copy_buffer_to_buffer(&staged, 0, buffer, 0, contents.len() as u64);
}

fn uniform_buffer(gpu: &Gpu, label: &str, size: usize) -> wgpu::Buffer {
    gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: size as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

/// Buffers at their bindings.
fn bound(
    gpu: &Gpu,
    bindings: &[(u32, &wgpu::Buffer, wgpu::BufferBindingType)],
) -> (wgpu::BindGroupLayout, wgpu::BindGroup) {
    let layout_entry = |&(binding, _, ty): &(u32, &wgpu::Buffer, wgpu::BufferBindingType)| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
        ty: wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None },
        count: None,
    };
    let entries: Vec<_> = bindings.iter().map(layout_entry).collect();
    let layout = gpu
        .device
        .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("frame"), entries: &entries });
    let entries: Vec<_> = bindings
        .iter()
        .map(|(binding, buffer, _)| wgpu::BindGroupEntry { binding: *binding, resource: buffer.as_entire_binding() })
        .collect();
    let descriptor = wgpu::BindGroupDescriptor { label: Some("frame"), layout: &layout, entries: &entries };
    let group = gpu.device.create_bind_group(&descriptor);
    (layout, group)
}

fn material_uniform(material: &Material, look: &Look) -> MaterialUniform {
    let cutoff = match material.alpha {
        Alpha::Mask { cutoff } => cutoff,
        Alpha::Opaque | Alpha::Invisible => 0.0,
    };
    let wrap = material.base_color_texture.map_or([0; 2], |texture| texture.wrap.map(wrap_code));
    MaterialUniform {
        base_color: material.base_color.to_array(),
        emissive: material.emissive.to_array(),
        is_unlit: f32::from(u8::from(material.is_unlit)),
        cutoff,
        wrap_u: wrap[0],
        wrap_v: wrap[1],
        metallic: look.metallic,
        roughness: look.roughness,
        normal_scale: look.normal_scale,
        transmission: look.transmission,
        pad: 0.0,
    }
}
