//! Frames of a baked stage.

use super::baked_plan::{ProgramKey, plan, programs};
use super::census::Census;
use super::device::{Gpu, GpuError};
use super::program::{Program, Source, State, depth_state};
use super::readback;
use super::scene::{SceneOnGpu, depth_key};
use super::stopwatch::{FrameTimes, Phase, Stopwatch};
use super::target::{DEPTH_FORMAT, LIT_FORMAT, Target, VISIBILITY_FORMAT};
use crate::light::Moment;
use crate::plan::DrawPlan;
use crate::stage::Stage;
use crate::{Filter, View};
use glam::Vec3;
use std::collections::BTreeMap;

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

impl Output {
    /// Format of what it is drawn into.
    pub fn format(self) -> wgpu::TextureFormat {
        if self == Self::Lit { LIT_FORMAT } else { VISIBILITY_FORMAT }
    }

    /// What is there before surfaces are. Pixels that show none read 1 in visibility pictures; in lit ones they show the sky.
    pub fn background(self) -> wgpu::Color {
        if self == Self::Lit { wgpu::Color::BLACK } else { wgpu::Color::WHITE }
    }

    /// Numbers a pixel.
    pub fn channels(self) -> u32 {
        if self == Self::Lit { 4 } else { 1 }
    }
}

/// A stage on the GPU.
pub struct Renderer<'g> {
    gpu: &'g Gpu,
    filter: Filter,
    scene: SceneOnGpu,
    /// Built when an output is first asked for. The depth programs serve all outputs.
    programs: BTreeMap<ProgramKey, Program>,
    targets: BTreeMap<Output, Target>,
    stopwatch: Option<Stopwatch>,
    times: Option<FrameTimes>,
}

impl<'g> Renderer<'g> {
    /// Uploads a stage.
    pub fn new(gpu: &'g Gpu, stage: &Stage, filter: Filter) -> Result<Self, GpuError> {
        let scene = gpu.checked("uploading the set", || SceneOnGpu::new(gpu, stage))??;
        Ok(Self {
            gpu,
            filter,
            scene,
            programs: BTreeMap::new(),
            targets: BTreeMap::new(),
            stopwatch: None,
            times: None,
        })
    }

    /// The same, with passes timed where the GPU can.
    pub fn timed(self) -> Self {
        Self { stopwatch: Stopwatch::new(self.gpu), ..self }
    }

    /// Seconds that the last frame's passes took, if they were timed.
    pub fn times(&self) -> Option<FrameTimes> {
        self.times
    }

    /// The picture at a moment, in linear light.
    pub fn lit(&mut self, view: &View, moment: &Moment) -> Result<Vec<Vec3>, GpuError> {
        Ok(readback::colors(&self.draw(view, moment, Output::Lit)?))
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
            self.scene.frame.write(gpu, view, moment);
            if let Some(stopwatch) = &mut self.stopwatch {
                stopwatch.start();
            }
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            self.depth_pass(&mut encoder, output);
            self.surface_pass(&mut encoder, output);
            let picture = readback::read(gpu, &self.targets[&output], output.channels(), encoder)?;
            self.times = self.stopwatch.as_ref().map(|stopwatch| stopwatch.read(gpu)).transpose()?;
            Ok(picture)
        })?
    }

    /// Makes whatever an output needs and is not there yet.
    fn prepare(&mut self, size: [u32; 2], output: Output) -> Result<(), GpuError> {
        if self.targets.get(&output).is_none_or(|target| target.size != size) {
            self.targets.insert(output, Target::new(self.gpu, size, output.format(), DEPTH_FORMAT)?);
        }
        for key in programs(&self.scene.needs, output) {
            if !self.programs.contains_key(&key) {
                let program = self.program(&key);
                self.programs.insert(key, program);
            }
        }
        Ok(())
    }

    fn program(&self, key: &ProgramKey) -> Program {
        let state = surface_state;
        match key {
            ProgramKey::Depth(key) => self.scene.depth_program(self.gpu, key, DEPTH_FORMAT),
            ProgramKey::Sky => sky_program(self.gpu, &self.scene, state(Output::Lit, true)),
            ProgramKey::Surface(output, key) => {
                let page = self.scene.variant(key);
                let (text, fragment) = match output {
                    Output::Lit => (sunbake_shaders::lit_shader(key.surface, page, self.filter), "lit_fragment"),
                    Output::Visibility => {
                        (sunbake_shaders::visibility_shader(key.surface, page, self.filter), "visibility_fragment")
                    }
                    Output::LampVisibility => (
                        sunbake_shaders::lamp_visibility_shader(key.surface, page, self.filter),
                        "lamp_visibility_fragment",
                    ),
                };
                let attributes = sunbake_shaders::attributes(key.surface);
                let source = surface_source(&text, fragment, &attributes);
                Program::new(self.gpu, &source, &self.scene.groups(key), state(*output, key.is_two_sided))
            }
        }
    }

    fn depth_pass(&mut self, encoder: &mut wgpu::CommandEncoder, output: Output) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("depth"),
            depth_stencil_attachment: Some(self.targets[&output].depth_attachment(wgpu::LoadOp::Clear(0.0))),
            timestamp_writes: self.stopwatch.as_mut().and_then(|stopwatch| stopwatch.time(Phase::Depth)),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.scene.frame.group, &[]);
        for batch in &self.scene.batches {
            self.scene.draw_depth(&mut pass, batch, &self.programs[&ProgramKey::Depth(depth_key(&batch.key))]);
        }
    }

    fn surface_pass(&mut self, encoder: &mut wgpu::CommandEncoder, output: Output) {
        let background = output.background();
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("surfaces"),
            color_attachments: &[Some(self.targets[&output].picture_attachment(wgpu::LoadOp::Clear(background)))],
            depth_stencil_attachment: Some(self.targets[&output].depth_attachment(wgpu::LoadOp::Load)),
            timestamp_writes: self.stopwatch.as_mut().and_then(|stopwatch| stopwatch.time(Phase::Light)),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.scene.frame.group, &[]);
        for batch in &self.scene.batches {
            let key = ProgramKey::Surface(output, self.scene.surface_key(&batch.key));
            self.scene.draw_surface(&mut pass, batch, &self.programs[&key]);
        }
        if let Some(sky) = self.programs.get(&ProgramKey::Sky).filter(|_| output == Output::Lit) {
            pass.set_pipeline(&sky.pipeline);
            pass.draw(0..3, 0..1);
        }
    }

    /// What has been built so far.
    pub fn census(&self) -> Census {
        let surfaces = self.programs.keys().filter_map(ProgramKey::batch);
        let scene = Census::of_scene(&self.scene).with_pipelines(self.programs.len(), surfaces);
        Census { passes: 2, targets: 2 * self.targets.len(), ..scene }
    }

    /// What pictures of a kind call for.
    pub fn plan(&self, output: Output) -> DrawPlan {
        plan(&self.scene.needs, output)
    }
}

/// How surfaces whose depths are known meet an output's picture.
pub(super) fn surface_state(output: Output, is_two_sided: bool) -> State {
    let depth = depth_state(DEPTH_FORMAT, false, wgpu::CompareFunction::Equal);
    State::new(Some(output.format().into()), depth, is_two_sided)
}

/// What shades surfaces.
pub(super) fn surface_source<'a>(
    text: &'a str,
    fragment: &'a str,
    attributes: &'a [sunbake_shaders::Attribute],
) -> Source<'a> {
    Source { text, vertex: "surface_vertex", fragment: Some(fragment), attributes }
}

/// The program that draws the background.
pub(super) fn sky_program(gpu: &Gpu, scene: &SceneOnGpu, state: State) -> Program {
    let text = sunbake_shaders::sky_shader();
    let source = Source { text: &text, vertex: "screen_vertex", fragment: Some("sky_fragment"), attributes: &[] };
    Program::new(gpu, &source, &[Some(&scene.frame.layout)], state)
}
