//! Render pipelines.

use super::batch::BatchKey;
use super::blended::blended_state;
use super::scene::SceneOnGpu;
use crate::gpu::device::Gpu;
use sunbake_shaders::{Attribute, Format, Stream, SurfaceVariant};

/// A pipeline with the vertex streams that it reads, in the order of their locations in the pipeline.
pub struct Program {
    /// Compiled for one format of the picture.
    pub pipeline: wgpu::RenderPipeline,
    /// What to set as vertex buffers 0, 1, and so on.
    pub streams: Vec<Stream>,
}

/// A shader and its entry points.
pub struct ShaderStages<'a> {
    /// WGSL.
    pub text: &'a str,
    /// Entry point of the vertex stage.
    pub vertex: &'a str,
    /// Entry point of the fragment stage; none where only depth and stencil are written.
    pub fragment: Option<&'a str>,
    /// Attributes of each vertex.
    pub attributes: &'a [Attribute],
}

/// The fixed-function state of a pipeline.
pub struct PipelineState {
    /// The picture drawn into, if any.
    pub target: Option<wgpu::ColorTargetState>,
    /// Depth and stencil, if any.
    pub depth_stencil: Option<wgpu::DepthStencilState>,
    /// Whether both sides are drawn; else only counter-clockwise faces.
    pub is_two_sided: bool,
    /// Whether depths outside of [0, 1] are clamped; else they are cut off.
    pub clamps_depth: bool,
}

impl PipelineState {
    /// Depth and stencil as given, without clamping.
    pub fn new(
        target: Option<wgpu::ColorTargetState>,
        depth_stencil: wgpu::DepthStencilState,
        is_two_sided: bool,
    ) -> Self {
        Self { target, depth_stencil: Some(depth_stencil), is_two_sided, clamps_depth: false }
    }
}

impl Program {
    /// A program. Absent groups at the end are left out of its layout.
    pub fn new(
        gpu: &Gpu,
        source: &ShaderStages<'_>,
        groups: &[Option<&wgpu::BindGroupLayout>],
        state: PipelineState,
    ) -> Self {
        let label = source.fragment.or(Some(source.vertex));
        let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label,
            source: wgpu::ShaderSource::Wgsl(source.text.into()),
        });
        let (streams, gpu_attributes) = by_stream(source.attributes);
        let buffers: Vec<_> = streams
            .iter()
            .zip(&gpu_attributes)
            .map(|(stream, attributes)| {
                Some(wgpu::VertexBufferLayout {
                    array_stride: stream.stride(),
                    step_mode: wgpu::VertexStepMode::Vertex,
                    attributes,
                })
            })
            .collect();
        let used = groups.iter().rposition(Option::is_some).map_or(0, |last| last + 1);
        let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label,
            bind_group_layouts: &groups[..used],
            immediate_size: 0,
        });
        let targets: Vec<_> = state.target.into_iter().map(Some).collect();
        let pipeline = gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label,
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some(source.vertex),
                compilation_options: Default::default(),
                buffers: &buffers,
            },
            primitive: wgpu::PrimitiveState {
                cull_mode: (!state.is_two_sided).then_some(wgpu::Face::Back),
                unclipped_depth: state.clamps_depth,
                ..Default::default()
            },
            depth_stencil: state.depth_stencil,
            multisample: Default::default(),
            fragment: source.fragment.map(|entry| wgpu::FragmentState {
                module: &module,
                entry_point: Some(entry),
                compilation_options: Default::default(),
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        });
        Self { pipeline, streams }
    }

    /// The program that draws depths. A surface without an alpha mask needs no fragment stage.
    pub fn depth(
        gpu: &Gpu,
        key: &BatchKey,
        frame: &wgpu::BindGroupLayout,
        texture: Option<&wgpu::BindGroupLayout>,
        format: wgpu::TextureFormat,
    ) -> Self {
        let has_alpha_mask = key.surface.has_alpha_mask;
        let attributes = match has_alpha_mask {
            true => sunbake_shaders::attributes(key.surface),
            false => sunbake_shaders::attributes(SurfaceVariant::default())[..1].to_vec(),
        };
        let source = ShaderStages {
            text: &sunbake_shaders::depth_shader(key.surface),
            vertex: if has_alpha_mask { "surface_vertex" } else { "depth_vertex" },
            fragment: has_alpha_mask.then_some("depth_fragment"),
            attributes: &attributes,
        };
        let depth_stencil = depth_state(format, true, wgpu::CompareFunction::Greater);
        let state = PipelineState::new(None, depth_stencil, key.is_two_sided);
        Self::new(gpu, &source, &[Some(frame), None, texture.filter(|_| has_alpha_mask)], state)
    }
}

/// The vertex stage of surfaces, and a fragment stage.
pub fn surface_stages<'a>(text: &'a str, fragment: &'a str, attributes: &'a [Attribute]) -> ShaderStages<'a> {
    ShaderStages { text, vertex: "surface_vertex", fragment: Some(fragment), attributes }
}

/// State of pipelines that light a batch: where depths are equal, or blended where nothing lies in front.
pub fn lit_state(key: &BatchKey, format: wgpu::TextureFormat, depth_format: wgpu::TextureFormat) -> PipelineState {
    let state = if key.surface.look.is_blended { blended_state } else { surface_state };
    state(format, depth_format, key.is_two_sided)
}

/// State of pipelines that draw where depths are equal.
pub fn surface_state(
    format: wgpu::TextureFormat,
    depth_format: wgpu::TextureFormat,
    is_two_sided: bool,
) -> PipelineState {
    let depth = depth_state(depth_format, false, wgpu::CompareFunction::Equal);
    PipelineState::new(Some(format.into()), depth, is_two_sided)
}

/// The program that draws the sky.
pub fn sky_program(gpu: &Gpu, scene: &SceneOnGpu, state: PipelineState) -> Program {
    let text = sunbake_shaders::sky_shader();
    let source = ShaderStages { text: &text, vertex: "screen_vertex", fragment: Some("sky_fragment"), attributes: &[] };
    Program::new(gpu, &source, &[Some(&scene.frame.layout)], state)
}

/// Depth that is compared and, if asked for, written. The stencil is left alone.
pub fn depth_state(
    format: wgpu::TextureFormat,
    writes: bool,
    compare: wgpu::CompareFunction,
) -> wgpu::DepthStencilState {
    wgpu::DepthStencilState {
        format,
        depth_write_enabled: Some(writes),
        depth_compare: Some(compare),
        stencil: Default::default(),
        bias: Default::default(),
    }
}

/// The streams that attributes come from, in order, and the attributes of each.
fn by_stream(attributes: &[Attribute]) -> (Vec<Stream>, Vec<Vec<wgpu::VertexAttribute>>) {
    let mut streams: Vec<Stream> = attributes.iter().map(|a| a.stream).collect();
    streams.sort_unstable();
    streams.dedup();
    let of_stream = |stream: &Stream| {
        let all = attributes.iter().enumerate().filter(|(_, a)| a.stream == *stream);
        all.map(|(location, a)| wgpu::VertexAttribute {
            format: vertex_format(a.format),
            offset: a.offset,
            shader_location: location as u32,
        })
        .collect()
    };
    let attributes = streams.iter().map(of_stream).collect();
    (streams, attributes)
}

fn vertex_format(format: Format) -> wgpu::VertexFormat {
    match format {
        Format::Float => wgpu::VertexFormat::Float32,
        Format::Float2 => wgpu::VertexFormat::Float32x2,
        Format::Float3 => wgpu::VertexFormat::Float32x3,
        Format::Snorm16x4 => wgpu::VertexFormat::Snorm16x4,
        Format::Unorm16x4 => wgpu::VertexFormat::Unorm16x4,
        Format::Uint => wgpu::VertexFormat::Uint32,
    }
}
