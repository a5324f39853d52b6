//! A stage's surfaces on the GPU: what every technique that draws there shares.

use super::batch::{Batch, BatchKey, BatchRequest, batches};
use super::buffers::{FrameBindings, upload_streams};
use super::page_textures::PageTextures;
use super::program::Program;
use super::textures::BaseTextures;
use crate::gpu::device::{Gpu, GpuError};
use crate::gpu::plan::{PageNeeds, SceneNeeds};
use crate::plan::Census;
use crate::stage::Stage;
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
    /// Vertex buffers, one for each stream in use.
    pub streams: BTreeMap<Stream, wgpu::Buffer>,
    /// Textures of each atlas page.
    pub pages: Vec<PageTextures>,
    /// Base colour textures that some surface is drawn with.
    pub textures: BaseTextures,
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
        let needs = SceneNeeds::of(stage, batches.iter().map(|batch| batch.key));
        let page = |(maps, page): (_, &PageNeeds)| PageTextures::new(gpu, maps, stage.bits, &page.variant);
        let pages = stage.pages.iter().zip(&needs.pages).map(page).collect::<Result<_, _>>()?;
        let (hidden, batches) = batches.into_iter().partition(|batch| batch.key.is_hidden);
        Ok(Self {
            streams: upload_streams(gpu, &vertices)?,
            batches,
            hidden,
            pages,
            textures: BaseTextures::new(gpu, stage, &needs.textures())?,
            frame: FrameBindings::new(gpu, stage, &needs),
            needs,
        })
    }

    /// How a batch's page is read.
    pub fn variant(&self, key: &BatchKey) -> &PageVariant {
        self.needs.variant(key)
    }

    /// The key of a batch's program: pages that programs read alike share one.
    pub fn surface_key(&self, key: &BatchKey) -> BatchKey {
        self.needs.surface_key(key)
    }

    /// Layouts of the bindings of a program that shades a batch.
    pub fn groups(&self, key: &BatchKey) -> [Option<&wgpu::BindGroupLayout>; 3] {
        let texture = self.textures.layout.as_ref().filter(|_| key.surface.is_textured);
        [Some(&self.frame.layout), self.pages[key.page as usize].layout.as_ref(), texture]
    }

    /// The program that finds a batch's depths.
    pub fn depth_program(&self, gpu: &Gpu, key: &BatchKey, format: wgpu::TextureFormat) -> Program {
        let texture = self.textures.layout.as_ref().filter(|_| key.surface.is_textured);
        Program::depth(gpu, key, &self.frame.layout, texture, format)
    }

    /// Counts of what is shared by all renderers.
    pub fn census(&self) -> Census {
        let page_groups = self.pages.iter().filter(|page| page.bind_group.is_some()).count();
        let page_bindings: usize = self.pages.iter().map(|page| page.binding_count).sum();
        let texture_groups = self.textures.bind_groups.len();
        Census {
            time_textures: self.pages.iter().map(|page| page.time_textures).sum(),
            lamp_bindings: usize::from(self.frame.lamp.is_some()),
            ambient_textures: self.pages.iter().map(|page| page.ambient_textures).sum(),
            wall_textures: self.pages.iter().map(|page| page.wall_textures).sum(),
            sky_bindings: usize::from(self.frame.sky.is_some()),
            base_color_textures: self.textures.texture_count,
            vertex_buffers: self.streams.len(),
            bind_groups: 1 + page_groups + texture_groups,
            bindings: self.frame.binding_count + page_bindings + BaseTextures::BINDINGS * texture_groups,
            draws: self.batches.len(),
            map_bytes: self.pages.iter().map(|page| page.bytes).sum(),
            ..Census::default()
        }
    }

    /// Draws depths.
    pub fn draw_depth(&self, pass: &mut wgpu::RenderPass<'_>, batch: &Batch, program: &Program) {
        self.draw_with(pass, batch, program, batch.key.surface.has_alpha_mask);
    }

    /// Draws surfaces.
    pub fn draw_surface(&self, pass: &mut wgpu::RenderPass<'_>, batch: &Batch, program: &Program) {
        pass.set_bind_group(1, self.pages[batch.key.page as usize].bind_group.as_ref(), &[]);
        self.draw_with(pass, batch, program, true);
    }

    /// Draws surfaces with programs that read no maps.
    pub fn draw_without_page(&self, pass: &mut wgpu::RenderPass<'_>, batch: &Batch, program: &Program) {
        self.draw_with(pass, batch, program, true);
    }

    fn draw_with(&self, pass: &mut wgpu::RenderPass<'_>, batch: &Batch, program: &Program, wants_texture: bool) {
        pass.set_pipeline(&program.pipeline);
        if let Some(texture) = batch.key.texture.filter(|_| wants_texture) {
            pass.set_bind_group(2, &self.textures.bind_groups[&texture], &[]);
        }
        for (index, stream) in program.streams.iter().enumerate() {
            let first = match stream {
                Stream::Position | Stream::Surface => batch.first,
                Stream::Texture => batch.first_texture,
                Stream::Color => batch.first_color,
                Stream::Lift => batch.first_lift,
            };
            pass.set_vertex_buffer(index as u32, self.streams[stream].slice(first * stream.stride()..));
        }
        pass.draw(0..batch.vertex_count, 0..1);
    }
}

/// The key of a batch's depth program. Only alpha masks tell surfaces apart there.
pub fn depth_key(key: &BatchKey) -> BatchKey {
    let masked = SurfaceVariant { is_smooth: false, has_lift: false, ..key.surface };
    let surface = if key.surface.has_alpha_mask { masked } else { Default::default() };
    BatchKey { surface, page: 0, texture: None, is_ground: false, is_hidden: false, ..*key }
}
