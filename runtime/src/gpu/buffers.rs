//! Buffers that a stage fills once: vertex streams and materials; and the frame's own, written for each frame.

use super::batch::{Vertices, wrap_code};
use super::device::{Gpu, GpuError};
use crate::stage::Stage;
use std::collections::BTreeMap;
use sunbake::scene::{Alpha, Material};
use sunbake_shaders::{FrameUniform, MaterialUniform, Stream};
use wgpu::util::{BufferInitDescriptor, DeviceExt};

/// Uploads the streams that have vertices.
pub fn upload_streams(gpu: &Gpu, vertices: &Vertices) -> Result<BTreeMap<Stream, wgpu::Buffer>, GpuError> {
    let all: [(Stream, &[u8]); 4] = [
        (Stream::Position, bytemuck::cast_slice(&vertices.positions)),
        (Stream::Surface, bytemuck::cast_slice(&vertices.surfaces)),
        (Stream::Texture, bytemuck::cast_slice(&vertices.textures)),
        (Stream::Color, bytemuck::cast_slice(&vertices.colors)),
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

/// The frame's uniform buffer and the materials, with their layout and bindings.
pub fn frame_bindings(gpu: &Gpu, stage: &Stage) -> (wgpu::BindGroupLayout, wgpu::Buffer, wgpu::BindGroup) {
    let device = &gpu.device;
    let materials: Vec<MaterialUniform> = stage.scene.materials.iter().map(material_uniform).collect();
    let materials = device.create_buffer_init(&BufferInitDescriptor {
        label: Some("materials"),
        contents: bytemuck::cast_slice(&materials),
        usage: wgpu::BufferUsages::STORAGE,
    });
    let frame = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("frame"),
        size: size_of::<FrameUniform>() as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
        ty: wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None },
        count: None,
    };
    let storage = wgpu::BufferBindingType::Storage { read_only: true };
    let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("frame"),
        entries: &[entry(0, wgpu::BufferBindingType::Uniform), entry(1, storage)],
    });
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("frame"),
        layout: &layout,
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: frame.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 1, resource: materials.as_entire_binding() },
        ],
    });
    (layout, frame, group)
}

fn material_uniform(material: &Material) -> MaterialUniform {
    let cutoff = match material.alpha {
        Alpha::Cut { cutoff } => cutoff,
        Alpha::Opaque | Alpha::Air => 0.0,
    };
    let wrap = material.base_color_texture.map_or([0; 2], |texture| texture.wrap.map(wrap_code));
    MaterialUniform {
        base_color: material.base_color.to_array(),
        emissive: material.emissive.to_array(),
        is_unlit: f32::from(u8::from(material.is_unlit)),
        cutoff,
        wrap_u: wrap[0],
        wrap_v: wrap[1],
        pad: 0.0,
    }
}
