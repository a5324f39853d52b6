//! Draws a baked stage: a depth pass, then one that evaluates the maps where it lights.

mod plan;

pub use plan::baked_plan;

use super::device::{Gpu, GpuError};
use super::frame::{
    Batch, BatchKey, DEPTH_FORMAT, FrameTarget, FrameTimes, Output, OwnTargets, PassClock, PictureTarget, Program,
    ProgramTable, SceneOnGpu, lit_state, readback, sky_program, surface_stages, surface_state, with_pipelines,
};
use crate::light::Moment;
use crate::plan::{Census, DrawPlan};
use crate::stage::Stage;
use crate::{Filter, View};
use glam::Vec3;
use plan::{BakedProgram, plan, programs, request};

/// Draws a baked stage.
pub struct BakedRenderer<'g> {
    gpu: &'g Gpu,
    filter: Filter,
    scene: SceneOnGpu,
    programs: ProgramTable<BakedProgram>,
    targets: OwnTargets,
    clock: PassClock,
    times: Option<FrameTimes>,
}

impl<'g> BakedRenderer<'g> {
    /// Uploads a stage.
    pub fn new(gpu: &'g Gpu, stage: &Stage, filter: Filter) -> Result<Self, GpuError> {
        let scene = gpu.checked("uploading the set", || SceneOnGpu::with(gpu, stage, request(filter)))??;
        Ok(Self {
            gpu,
            filter,
            scene,
            programs: ProgramTable::default(),
            targets: OwnTargets::new(DEPTH_FORMAT),
            clock: PassClock::new(gpu, false),
            times: None,
        })
    }

    /// The same, with passes timed if the GPU can.
    pub fn timed(self) -> Self {
        Self { clock: PassClock::new(self.gpu, true), ..self }
    }

    /// Seconds that the passes of the last picture took that was read back, if they were timed.
    pub fn times(&self) -> Option<FrameTimes> {
        self.times
    }

    /// Draws a picture into the caller's texture view: records two passes into the caller's encoder, and submits
    /// nothing. Depths are kept in a texture of the renderer's own. Pipelines are built for the format when it is
    /// first drawn into.
    ///
    /// Several pictures may be recorded into one encoder.
    pub fn draw_into(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        target: PictureTarget<'_>,
        output: Output,
        view: &View,
        moment: &Moment,
    ) -> Result<(), GpuError> {
        let gpu = self.gpu;
        let depth = self.targets.depth(gpu, output, view.size)?;
        let blended = self.scene.blended_draws(gpu, output, view.eye_m, target.format)?;
        gpu.checked("building pipelines", || self.prepare(output, target.format))?;
        self.scene.frame.write(gpu, encoder, view, moment);
        self.clock.start();
        let into = FrameTarget { output, picture: target, depth, clock: &self.clock };
        let program = |key: &BakedProgram| self.programs.get(key, target.format);
        into.depth_pass(encoder, &self.scene, |key| program(&BakedProgram::Depth(*key)));
        let surface = |key: &BatchKey| program(&BakedProgram::Surface(output, self.scene.surface_key(key, output)));
        let draw = |pass: &mut wgpu::RenderPass<'_>, batch: &Batch| {
            self.scene.draw_surface(pass, batch, surface(&batch.key), output);
        };
        let sky = (output == Output::Lit).then(|| program(&BakedProgram::Sky));
        into.surface_pass(encoder, &self.scene, draw, sky, |pass| {
            if let Some(blended) = &blended {
                blended.draw(pass, &self.scene, surface, |_, _| {});
            }
        });
        Ok(())
    }

    /// The lit picture at a moment, in linear light and row order.
    pub fn lit(&mut self, view: &View, moment: &Moment) -> Result<Vec<Vec3>, GpuError> {
        Ok(readback::colors(&self.draw(view, moment, Output::Lit)?))
    }

    /// The share of the sun that each pixel's surface sees at a moment.
    pub fn visibility(&mut self, view: &View, moment: &Moment) -> Result<Vec<f32>, GpuError> {
        self.draw(view, moment, Output::Visibility)
    }

    /// The share of the lamp that each pixel's surface sees at a moment.
    pub fn lamp_visibility(&mut self, view: &View, moment: &Moment) -> Result<Vec<f32>, GpuError> {
        self.draw(view, moment, Output::LampVisibility)
    }

    /// Draws into a picture of its own, and reads it back.
    fn draw(&mut self, view: &View, moment: &Moment, output: Output) -> Result<Vec<f32>, GpuError> {
        let gpu = self.gpu;
        let picture = self.targets.picture(gpu, output, view.size)?;
        gpu.checked("drawing", || {
            let mut encoder = gpu.encoder();
            self.draw_into(&mut encoder, picture.target(), output, view, moment)?;
            let floats = readback::read(gpu, &picture, output.channels(), encoder)?;
            self.times = self.clock.read(gpu)?;
            Ok(floats)
        })?
    }

    /// Builds the pipelines that an output needs and that are not there yet.
    fn prepare(&mut self, output: Output, format: wgpu::TextureFormat) {
        let Self { gpu, filter, scene, programs: table, .. } = self;
        table.prepare(programs(&scene.needs, output), format, |key| match key {
            BakedProgram::Depth(key) => scene.depth_program(gpu, key, DEPTH_FORMAT),
            BakedProgram::Sky => sky_program(gpu, scene, surface_state(format, DEPTH_FORMAT, true)),
            BakedProgram::Surface(output, key) => surface_program(gpu, scene, *filter, *output, key, format),
        });
    }

    /// What has been built so far, and the passes of the last picture.
    pub fn census(&self) -> Census {
        let census = Census { passes: self.clock.passes(), targets: self.targets.count(), ..self.scene.census() };
        with_pipelines(census, self.programs.keys())
    }

    /// What pictures of a kind call for.
    pub fn plan(&self, output: Output) -> DrawPlan {
        plan(&self.scene.needs, output)
    }
}

fn surface_program(
    gpu: &Gpu,
    scene: &SceneOnGpu,
    filter: Filter,
    output: Output,
    key: &BatchKey,
    format: wgpu::TextureFormat,
) -> Program {
    let page = scene.variant(key);
    let (text, fragment) = match output {
        Output::Lit => (sunbake_shaders::lit_shader(key.surface, page, filter), "lit_fragment"),
        Output::Visibility => (sunbake_shaders::visibility_shader(key.surface, page, filter), "visibility_fragment"),
        Output::LampVisibility => {
            (sunbake_shaders::lamp_visibility_shader(key.surface, page, filter), "lamp_visibility_fragment")
        }
    };
    let attributes = sunbake_shaders::attributes(key.surface);
    let state = lit_state(key, format, DEPTH_FORMAT);
    Program::new(gpu, &surface_stages(&text, fragment, &attributes), &scene.groups(key), state)
}
