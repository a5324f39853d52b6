//! A stage's surfaces on the GPU: what every technique that draws there shares.

use super::Output;
use super::batch::{Batch, BatchKey, BatchRequest, TextureSet, batches};
use super::blended::{BlendedDraws, BlendedTriangles};
use super::buffers::{FrameBindings, upload_streams};
use super::page_textures::PageTextures;
use super::program::Program;
use super::textures::SurfaceTextures;
use crate::gpu::device::{Gpu, GpuError};
use crate::gpu::plan::{PageNeeds, SceneNeeds};
use crate::plan::Census;
use crate::stage::Stage;
use glam::Vec3;
use std::collections::BTreeMap;
use sunbake_shaders::{PageVariant, Stream, SurfaceVariant};

/// Surfaces, their maps and their textures: built once per stage.
pub struct SceneOnGpu {
    /// What the stage calls for.
    pub needs: SceneNeeds,
    /// Draws of visible surfaces.
    pub batches: Vec<Batch>,
    /// Casters that are not drawn; only with a ground.
    pub hidden: Vec<Batch>,
    /// What lit pictures blend.
    pub blended: BlendedTriangles,
    /// Vertex buffers, one for each stream in use.
    pub streams: BTreeMap<Stream, wgpu::Buffer>,
    /// Textures of each atlas page.
    pub pages: Vec<PageTextures>,
    /// Textures that some surface is drawn with.
    pub textures: SurfaceTextures,
    /// The frame's own buffers.
    pub frame: FrameBindings,
}

impl SceneOnGpu {
    /// Uploads a stage.
    pub fn new(gpu: &Gpu, stage: &Stage) -> Result<Self, GpuError> {
        Self::with(gpu, stage, BatchRequest::default())
    }

    /// Uploads a stage with what a technique wants of its batches.
    pub fn with(gpu: &Gpu, stage: &Stage, request: BatchRequest) -> Result<Self, GpuError> {
        let (batches, vertices) = batches(stage, request);
        let needs = SceneNeeds::of(stage, batches.iter().map(|batch| batch.key), request);
        let page = |(maps, page): (_, &PageNeeds)| PageTextures::new(gpu, maps, stage.bits, &page.variant);
        let pages = stage.pages.iter().zip(&needs.pages).map(page).collect::<Result<_, _>>()?;
        let (hidden, batches): (Vec<_>, Vec<_>) = batches.into_iter().partition(|batch| batch.key.is_hidden);
        Ok(Self {
            streams: upload_streams(gpu, &vertices)?,
            blended: BlendedTriangles::new(&batches, &vertices.positions),
            batches,
            hidden,
            pages,
            textures: SurfaceTextures::new(gpu, stage, &needs.texture_sets())?,
            frame: FrameBindings::new(gpu, stage, &needs),
            needs,
        })
    }

    /// What pictures of an output blend, in the order in which an eye sees it. None where they blend nothing.
    pub fn blended_draws(
        &self,
        gpu: &Gpu,
        output: Output,
        eye_m: Vec3,
        format: wgpu::TextureFormat,
    ) -> Result<Option<BlendedDraws>, GpuError> {
        if output != Output::Lit || self.blended.batches.is_empty() {
            return Ok(None);
        }
        gpu.check_blendable(format, "blend surfaces in pictures of 32 bits")?;
        Ok(self.blended.draws(gpu, eye_m))
    }

    /// How a batch's page is read.
    pub fn variant(&self, key: &BatchKey) -> &PageVariant {
        self.needs.variant(key)
    }

    /// The key of a batch's program: pages that programs read alike share one.
    pub fn surface_key(&self, key: &BatchKey, output: Output) -> BatchKey {
        self.needs.surface_key(key, output)
    }

    /// What pictures of an output show as solid.
    pub fn solid(&self, output: Output) -> impl Iterator<Item = &Batch> {
        self.batches.iter().filter(move |batch| batch.key.is_solid_in(output))
    }

    /// Layouts of the bindings of a program that shades a batch.
    pub fn groups(&self, key: &BatchKey) -> [Option<&wgpu::BindGroupLayout>; 3] {
        [Some(&self.frame.layout), self.pages[key.page as usize].layout.as_ref(), self.textures.layout(key)]
    }

    /// The program that finds a batch's depths.
    pub fn depth_program(&self, gpu: &Gpu, key: &BatchKey, format: wgpu::TextureFormat) -> Program {
        let texture = self.textures.layout(key);
        Program::depth(gpu, key, &self.frame.layout, texture, format)
    }

    /// Counts of what is shared by all renderers.
    pub fn census(&self) -> Census {
        let page_groups = self.pages.iter().filter(|page| page.bind_group.is_some()).count();
        let page_bindings: usize = self.pages.iter().map(|page| page.binding_count).sum();
        let (texture_groups, texture_bindings) = self.textures.group_counts();
        Census {
            time_textures: self.pages.iter().map(|page| page.time_textures).sum(),
            lamp_bindings: usize::from(self.frame.lamp.is_some()),
            ambient_textures: self.pages.iter().map(|page| page.ambient_textures).sum(),
            wall_textures: self.pages.iter().map(|page| page.wall_textures).sum(),
            sky_bindings: usize::from(self.frame.sky.is_some()),
            base_color_textures: self.textures.base_count,
            look_textures: self.textures.look_count,
            vertex_buffers: self.streams.len(),
            bind_groups: 1 + page_groups + texture_groups,
            bindings: self.frame.binding_count + page_bindings + texture_bindings,
            draws: self.batches.len(),
            map_bytes: self.pages.iter().map(|page| page.bytes).sum(),
            ..Census::default()
        }
    }

    /// Draws depths.
    pub fn draw_depth(&self, pass: &mut wgpu::RenderPass<'_>, batch: &Batch, program: &Program) {
        let textures = batch.key.textures.base_alone();
        self.bind(pass, batch, program, batch.key.surface.has_alpha_mask.then_some(textures));
        pass.draw(0..batch.vertex_count, 0..1);
    }

    /// Draws surfaces.
    pub fn draw_surface(&self, pass: &mut wgpu::RenderPass<'_>, batch: &Batch, program: &Program, output: Output) {
        self.bind_page(pass, batch);
        self.draw_without_page(pass, batch, program, output);
    }

    /// Draws surfaces with programs that read no maps.
    pub fn draw_without_page(&self, pass: &mut wgpu::RenderPass<'_>, batch: &Batch, program: &Program, output: Output) {
        self.bind(pass, batch, program, Some(batch.key.for_output(output).textures));
        pass.draw(0..batch.vertex_count, 0..1);
    }

    /// Binds the maps of a batch.
    pub(super) fn bind_page(&self, pass: &mut wgpu::RenderPass<'_>, batch: &Batch) {
        pass.set_bind_group(1, self.pages[batch.key.page as usize].bind_group.as_ref(), &[]);
    }

    /// Binds a program, textures and vertices.
    pub(super) fn bind(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        batch: &Batch,
        program: &Program,
        textures: Option<TextureSet>,
    ) {
        pass.set_pipeline(&program.pipeline);
        if let Some(group) = textures.and_then(|set| self.textures.group(&set)) {
            pass.set_bind_group(2, group, &[]);
        }
        for (index, stream) in program.streams.iter().enumerate() {
            let first = batch.first_in(*stream) * stream.stride();
            pass.set_vertex_buffer(index as u32, self.streams[stream].slice(first..));
        }
    }
}

/// The key of a batch's depth program. Only alpha masks tell surfaces apart there.
pub fn depth_key(key: &BatchKey) -> BatchKey {
    let key = key.without_look();
    let masked = SurfaceVariant { is_smooth: false, has_lift: false, ..key.surface };
    let surface = if key.surface.has_alpha_mask { masked } else { Default::default() };
    let (is_ground, is_hidden, is_passed, is_open) = (false, false, false, false);
    BatchKey { surface, page: 0, textures: TextureSet::default(), is_ground, is_hidden, is_passed, is_open, ..key }
}
