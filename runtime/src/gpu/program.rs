//! Pipelines, one per variant that occurs.

use super::batch::BatchKey;
use super::device::Gpu;
use super::target::{DEPTH_FORMAT, LIT_FORMAT, VISIBILITY_FORMAT};
use sunbake_shaders::{Attribute, Filter, Format, PageVariant, Stream, SurfaceVariant};

/// What a pipeline is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Purpose {
    /// Depths of surfaces.
    Depth,
    /// Lit surfaces.
    Lit,
    /// Visibility of the sun alone.
    Visibility,
    /// Visibility of the lamp alone.
    LampVisibility,
    /// The background.
    Sky,
}

/// Layouts of the three groups of bindings; those that nothing uses are absent.
#[derive(Clone, Copy)]
pub struct Layouts<'a> {
    /// The frame and the materials.
    pub frame: &'a wgpu::BindGroupLayout,
    /// A page's maps.
    pub page: Option<&'a wgpu::BindGroupLayout>,
    /// A base colour texture.
    pub texture: Option<&'a wgpu::BindGroupLayout>,
}

/// A pipeline with the vertex streams that it reads, in the order of their slots.
pub struct Program {
    /// The pipeline.
    pub pipeline: wgpu::RenderPipeline,
    /// What to bind to slots 0, 1, and so on.
    pub streams: Vec<Stream>,
}

impl Program {
    /// The program that finds depths.
    pub fn depth(gpu: &Gpu, key: &BatchKey, layouts: Layouts) -> Self {
        let text = sunbake_shaders::depth_shader(key.surface);
        let attributes = match key.surface.is_cut {
            true => sunbake_shaders::attributes(key.surface),
            false => sunbake_shaders::attributes(SurfaceVariant::default())[..1].to_vec(),
        };
        let entries = match key.surface.is_cut {
            true => ("surface_vertex", Some("depth_fragment")),
            false => ("depth_vertex", None),
        };
        let layouts = Layouts { page: None, texture: layouts.texture.filter(|_| key.surface.is_cut), ..layouts };
        build(gpu, &text, entries, None, &attributes, Purpose::Depth, key.is_two_sided, layouts)
    }

    /// The program that draws surfaces.
    pub fn surface(
        gpu: &Gpu,
        purpose: Purpose,
        key: &BatchKey,
        page: &PageVariant,
        filter: Filter,
        layouts: Layouts,
    ) -> Self {
        let (text, entry, format) = match purpose {
            Purpose::Visibility => (
                sunbake_shaders::visibility_shader(key.surface, page, filter),
                "visibility_fragment",
                VISIBILITY_FORMAT,
            ),
            Purpose::LampVisibility => (
                sunbake_shaders::lamp_visibility_shader(key.surface, page, filter),
                "lamp_visibility_fragment",
                VISIBILITY_FORMAT,
            ),
            _ => (sunbake_shaders::lit_shader(key.surface, page, filter), "lit_fragment", LIT_FORMAT),
        };
        let attributes = sunbake_shaders::attributes(key.surface);
        let entries = ("surface_vertex", Some(entry));
        build(gpu, &text, entries, Some(format), &attributes, purpose, key.is_two_sided, layouts)
    }

    /// The program that draws the background.
    pub fn sky(gpu: &Gpu, layouts: Layouts) -> Self {
        let layouts = Layouts { page: None, texture: None, ..layouts };
        let entries = ("sky_vertex", Some("sky_fragment"));
        build(gpu, &sunbake_shaders::sky_shader(), entries, Some(LIT_FORMAT), &[], Purpose::Sky, true, layouts)
    }
}

#[expect(clippy::too_many_arguments, reason = "one call a kind of program; a struct would only name them twice")]
fn build(
    gpu: &Gpu,
    text: &str,
    (vertex, fragment): (&str, Option<&str>),
    format: Option<wgpu::TextureFormat>,
    attributes: &[Attribute],
    purpose: Purpose,
    is_two_sided: bool,
    layouts: Layouts,
) -> Program {
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(vertex),
        source: wgpu::ShaderSource::Wgsl(text.into()),
    });
    let (streams, gpu_attributes) = by_stream(attributes);
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
    let groups = bind_group_layouts(layouts);
    let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(vertex),
        bind_group_layouts: &groups,
        immediate_size: 0,
    });
    let targets: Vec<_> = format.map(|format| Some(format.into())).into_iter().collect();
    let pipeline = gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: fragment.or(Some(vertex)),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some(vertex),
            compilation_options: Default::default(),
            buffers: &buffers,
        },
        primitive: wgpu::PrimitiveState {
            cull_mode: (!is_two_sided).then_some(wgpu::Face::Back),
            ..Default::default()
        },
        depth_stencil: Some(depth_state(purpose)),
        multisample: Default::default(),
        fragment: fragment.map(|entry| wgpu::FragmentState {
            module: &module,
            entry_point: Some(entry),
            compilation_options: Default::default(),
            targets: &targets,
        }),
        multiview_mask: None,
        cache: None,
    });
    Program { pipeline, streams }
}

/// Group 0 is always there; later groups may be absent, and trailing absences are left out.
fn bind_group_layouts(layouts: Layouts<'_>) -> Vec<Option<&wgpu::BindGroupLayout>> {
    let mut groups = vec![Some(layouts.frame), layouts.page, layouts.texture];
    while groups.last().is_some_and(Option::is_none) {
        groups.pop();
    }
    groups
}

fn depth_state(purpose: Purpose) -> wgpu::DepthStencilState {
    let (writes, compare) = match purpose {
        Purpose::Depth => (true, wgpu::CompareFunction::Greater),
        _ => (false, wgpu::CompareFunction::Equal),
    };
    wgpu::DepthStencilState {
        format: DEPTH_FORMAT,
        depth_write_enabled: Some(writes),
        depth_compare: Some(compare),
        stencil: Default::default(),
        bias: Default::default(),
    }
}

/// The streams that attributes come from, in order, and each stream's attributes at their locations.
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
