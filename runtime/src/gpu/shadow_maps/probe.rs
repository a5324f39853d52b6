//! Whether a comparison sampler filters. WebGPU leaves that to each implementation.

use crate::gpu::device::{Gpu, GpuError};
use crate::gpu::frame::{DEPTH_FORMAT, PipelineState, Program, ShaderStages, depth_state, readback};

/// What a filtering comparison sampler reads halfway between a lit texel and a shaded one; 0 or 1 if it does not
/// filter.
pub fn halfway(gpu: &Gpu) -> Result<f32, GpuError> {
    gpu.checked("probing the comparison sampler", || {
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("probed"),
            size: wgpu::Extent3d { width: 2, height: 1, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: DEPTH_FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        let found = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("found"),
            size: 4,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let copied = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("found, read back"),
            size: 4,
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let mut encoder = gpu.encoder();
        draw_one_texel(gpu, &texture, &mut encoder);
        compare(gpu, &texture, &found, &mut encoder);
        encoder.copy_buffer_to_buffer(&found, 0, &copied, 0, 4);
        gpu.queue.submit([encoder.finish()]);
        let bytes = readback::map(gpu, &copied)?;
        Ok(bytemuck::pod_collect_to_vec::<u8, f32>(&bytes)[0])
    })?
}

fn draw_one_texel(gpu: &Gpu, texture: &wgpu::Texture, encoder: &mut wgpu::CommandEncoder) {
    let text = sunbake_shaders::shadow_probe_shader();
    let source = ShaderStages { text: &text, vertex: "probe_vertex", fragment: None, attributes: &[] };
    let state = PipelineState::new(None, depth_state(DEPTH_FORMAT, true, wgpu::CompareFunction::Always), true);
    let program = Program::new(gpu, &source, &[], state);
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("probe"),
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &texture.create_view(&wgpu::TextureViewDescriptor::default()),
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        }),
        ..Default::default()
    });
    pass.set_pipeline(&program.pipeline);
    pass.set_scissor_rect(1, 0, 1, 1);
    pass.draw(0..3, 0..1);
}

fn compare(gpu: &Gpu, texture: &wgpu::Texture, found: &wgpu::Buffer, encoder: &mut wgpu::CommandEncoder) {
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("probe"),
        source: wgpu::ShaderSource::Wgsl(sunbake_shaders::shadow_probe_shader().into()),
    });
    let pipeline = gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some("probe"),
        layout: None,
        module: &module,
        entry_point: Some("probe"),
        compilation_options: Default::default(),
        cache: None,
    });
    let view = texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    });
    let sampler = comparison_sampler(gpu, true);
    let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("probe"),
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&view) },
            wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::Sampler(&sampler) },
            wgpu::BindGroupEntry { binding: 2, resource: found.as_entire_binding() },
        ],
    });
    let mut pass = encoder.begin_compute_pass(&Default::default());
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.dispatch_workgroups(1, 1, 1);
}

/// A sampler that compares: what lies no deeper than the stored depth is lit.
pub fn comparison_sampler(gpu: &Gpu, is_filtering: bool) -> wgpu::Sampler {
    let filter = if is_filtering { wgpu::FilterMode::Linear } else { wgpu::FilterMode::Nearest };
    gpu.device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("shadow comparison"),
        mag_filter: filter,
        min_filter: filter,
        compare: Some(wgpu::CompareFunction::LessEqual),
        ..Default::default()
    })
}
