//! A stage on the GPU, and its frames.

use super::batch::{Batch, BatchKey, batches};
use super::buffers::{FrameBindings, upload_streams};
use super::census::Census;
use super::device::{Gpu, GpuError};
use super::maps::PageTextures;
use super::program::{Layouts, Program, Purpose};
use super::readback;
use super::target::{LIT_FORMAT, Target, VISIBILITY_FORMAT};
use super::textures::BaseTextures;
use crate::light::Moment;
use crate::playback::page_variant;
use crate::stage::Stage;
use crate::{Filter, View};
use glam::Vec3;
use std::collections::BTreeMap;
use sunbake_shaders::Stream;

/// What a frame shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Output {
    /// The picture, in linear light.
    Lit,
    /// How much of the sun is seen.
    Visibility,
    /// How much of the lamp is seen.
    LampVisibility,
}

/// A stage on the GPU.
pub struct Renderer<'g> {
    gpu: &'g Gpu,
    filter: Filter,
    batches: Vec<Batch>,
    streams: BTreeMap<Stream, wgpu::Buffer>,
    pages: Vec<PageTextures>,
    textures: BaseTextures,
    frame: FrameBindings,
    /// Built when an output is first asked for. The depth programs serve both outputs.
    programs: BTreeMap<(Purpose, ProgramKey), Program>,
    targets: BTreeMap<Output, Target>,
}

/// A batch's program does not depend on which image it draws with; on its page it does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum ProgramKey {
    Surface(BatchKey),
    Sky,
}

impl<'g> Renderer<'g> {
    /// Uploads a stage.
    pub fn new(gpu: &'g Gpu, stage: &Stage, filter: Filter) -> Result<Self, GpuError> {
        gpu.checked("uploading the set", || Self::build(gpu, stage, filter))?
    }

    fn build(gpu: &'g Gpu, stage: &Stage, filter: Filter) -> Result<Self, GpuError> {
        let (batches, vertices) = batches(stage);
        let radius_rad = stage.path.as_ref().map_or(0.0, |path| path.angular_radius_rad);
        let page = |maps| PageTextures::new(gpu, maps, stage.bits, page_variant(maps, stage.bits, radius_rad));
        let pages = stage.pages.iter().map(page).collect::<Result<_, _>>()?;
        let keys = batches.iter().filter_map(|batch| batch.key.texture).collect();
        Ok(Self {
            gpu,
            filter,
            streams: upload_streams(gpu, &vertices)?,
            batches,
            pages,
            textures: BaseTextures::new(gpu, stage, &keys)?,
            frame: FrameBindings::new(gpu, stage),
            programs: BTreeMap::new(),
            targets: BTreeMap::new(),
        })
    }

    /// The picture at a moment, in linear light.
    pub fn lit(&mut self, view: &View, moment: &Moment) -> Result<Vec<Vec3>, GpuError> {
        let floats = self.draw(view, moment, Output::Lit)?;
        Ok(floats.chunks_exact(4).map(|c| Vec3::new(c[0], c[1], c[2])).collect())
    }

    /// How much of the sun each pixel's surface sees at a moment.
    pub fn visibility(&mut self, view: &View, moment: &Moment) -> Result<Vec<f32>, GpuError> {
        self.draw(view, moment, Output::Visibility)
    }

    /// How much of the lamp each pixel's surface sees at a moment.
    pub fn lamp_visibility(&mut self, view: &View, moment: &Moment) -> Result<Vec<f32>, GpuError> {
        self.draw(view, moment, Output::LampVisibility)
    }

    fn draw(&mut self, view: &View, moment: &Moment, output: Output) -> Result<Vec<f32>, GpuError> {
        let gpu = self.gpu;
        gpu.checked("building pipelines", || self.prepare(view.size, output))??;
        gpu.checked("drawing", || {
            self.frame.write(gpu, view, moment);
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            self.depth_pass(&mut encoder, output);
            self.surface_pass(&mut encoder, output);
            let channels = if output == Output::Lit { 4 } else { 1 };
            readback::read(gpu, &self.targets[&output], channels, encoder)
        })?
    }

    /// Makes whatever an output needs and is not there yet.
    fn prepare(&mut self, size: [u32; 2], output: Output) -> Result<(), GpuError> {
        let (purpose, format) = match output {
            Output::Lit => (Purpose::Lit, LIT_FORMAT),
            Output::Visibility => (Purpose::Visibility, VISIBILITY_FORMAT),
            Output::LampVisibility => (Purpose::LampVisibility, VISIBILITY_FORMAT),
        };
        if self.targets.get(&output).is_none_or(|target| target.size != size) {
            self.targets.insert(output, Target::new(self.gpu, size, format)?);
        }
        let mut missing: Vec<(Purpose, ProgramKey)> = Vec::new();
        for batch in &self.batches {
            missing.push((Purpose::Depth, depth_key(&batch.key)));
            missing.push((purpose, self.surface_key(&batch.key)));
        }
        if output == Output::Lit {
            missing.push((Purpose::Sky, ProgramKey::Sky));
        }
        for key in missing {
            if !self.programs.contains_key(&key) {
                let program = self.program(key.0, &key.1);
                self.programs.insert(key, program);
            }
        }
        Ok(())
    }

    fn program(&self, purpose: Purpose, key: &ProgramKey) -> Program {
        let frame = &self.frame.layout;
        let ProgramKey::Surface(key) = key else {
            return Program::sky(self.gpu, Layouts { frame, page: None, texture: None });
        };
        let texture = self.textures.layout.as_ref().filter(|_| key.surface.is_textured);
        let page = &self.pages[key.page as usize];
        let layouts = Layouts { frame, page: page.layout.as_ref(), texture };
        match purpose {
            Purpose::Depth => Program::depth(self.gpu, key, layouts),
            _ => Program::surface(self.gpu, purpose, key, &page.variant, self.filter, layouts),
        }
    }

    /// The key of a batch's program: pages that programs read alike share one.
    fn surface_key(&self, key: &BatchKey) -> ProgramKey {
        let variant = &self.pages[key.page as usize].variant;
        let page = self.pages.iter().position(|p| p.variant == *variant).unwrap_or(0) as u32;
        ProgramKey::Surface(BatchKey { page, texture: None, ..*key })
    }

    fn depth_pass(&self, encoder: &mut wgpu::CommandEncoder, output: Output) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("depth"),
            depth_stencil_attachment: Some(self.depth_attachment(output, wgpu::LoadOp::Clear(0.0))),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.frame.group, &[]);
        for batch in &self.batches {
            self.draw_batch(&mut pass, batch, Purpose::Depth, depth_key(&batch.key));
        }
    }

    fn surface_pass(&self, encoder: &mut wgpu::CommandEncoder, output: Output) {
        // Pixels that show no surface read 1 in visibility pictures; in lit ones they show the sky.
        let background = if output == Output::Lit { wgpu::Color::BLACK } else { wgpu::Color::WHITE };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("surfaces"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.targets[&output].view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(background), store: wgpu::StoreOp::Store },
            })],
            depth_stencil_attachment: Some(self.depth_attachment(output, wgpu::LoadOp::Load)),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.frame.group, &[]);
        let purpose = match output {
            Output::Lit => Purpose::Lit,
            Output::Visibility => Purpose::Visibility,
            Output::LampVisibility => Purpose::LampVisibility,
        };
        for batch in &self.batches {
            self.draw_batch(&mut pass, batch, purpose, self.surface_key(&batch.key));
        }
        if let Some(sky) = self.programs.get(&(Purpose::Sky, ProgramKey::Sky)).filter(|_| output == Output::Lit) {
            pass.set_pipeline(&sky.pipeline);
            pass.draw(0..3, 0..1);
        }
    }

    fn depth_attachment(&self, output: Output, load: wgpu::LoadOp<f32>) -> wgpu::RenderPassDepthStencilAttachment<'_> {
        wgpu::RenderPassDepthStencilAttachment {
            view: &self.targets[&output].depth,
            depth_ops: Some(wgpu::Operations { load, store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        }
    }

    fn draw_batch(&self, pass: &mut wgpu::RenderPass<'_>, batch: &Batch, purpose: Purpose, key: ProgramKey) {
        let program = &self.programs[&(purpose, key)];
        pass.set_pipeline(&program.pipeline);
        if purpose != Purpose::Depth {
            pass.set_bind_group(1, self.pages[batch.key.page as usize].bind_group.as_ref(), &[]);
        }
        if let Some(texture) = batch.key.texture.filter(|_| purpose != Purpose::Depth || batch.key.surface.is_cut) {
            pass.set_bind_group(2, &self.textures.bind_groups[&texture], &[]);
        }
        for (slot, stream) in program.streams.iter().enumerate() {
            let first = match stream {
                Stream::Position | Stream::Surface => batch.first,
                Stream::Texture => batch.first_texture,
                Stream::Color => batch.first_color,
            };
            pass.set_vertex_buffer(slot as u32, self.streams[stream].slice(first * stream.stride()..));
        }
        pass.draw(0..batch.vertex_count, 0..1);
    }

    /// What has been built so far.
    pub fn census(&self) -> Census {
        let surfaces = || {
            self.programs.keys().filter_map(|(_, key)| match key {
                ProgramKey::Surface(key) => Some(key),
                ProgramKey::Sky => None,
            })
        };
        let page_groups = self.pages.iter().filter(|page| page.bind_group.is_some()).count();
        Census {
            passes: 2,
            pipelines: self.programs.len(),
            alpha_test_pipelines: surfaces().filter(|key| key.surface.is_cut).count(),
            two_sided_pipelines: surfaces().filter(|key| key.is_two_sided).count(),
            time_textures: self.pages.iter().map(|page| page.time_textures).sum(),
            lamp_bindings: usize::from(self.frame.lamp.is_some()),
            ambient_textures: self.pages.iter().map(|page| page.ambient_textures).sum(),
            sky_bindings: usize::from(self.frame.sky.is_some()),
            base_color_textures: self.textures.texture_count,
            vertex_buffers: self.streams.len(),
            bind_groups: 1 + page_groups + self.textures.bind_groups.len(),
            targets: 2 * self.targets.len(),
            draws: self.batches.len(),
            map_bytes: self.pages.iter().map(|page| page.bytes).sum(),
        }
    }
}

/// The key of a batch's depth program, which knows of pages and textures only what holes need.
fn depth_key(key: &BatchKey) -> ProgramKey {
    let surface = if key.surface.is_cut { key.surface } else { Default::default() };
    ProgramKey::Surface(BatchKey { surface, page: 0, texture: None, ..*key })
}
