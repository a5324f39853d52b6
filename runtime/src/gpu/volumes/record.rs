//! Records the passes of a frame.

use super::draws::VolumeDraws;
use super::extruded::Extruded;
use super::lights::{FrameLight, light_index};
use super::passes::PassPlace;
use super::plan::surface_programs;
use super::programs::{FaceKey, VolumeProgram, face_key};
use super::report::{FindSeconds, FrameReport};
use super::{VolumeRenderer, VolumeSettings};
use crate::View;
use crate::gpu::device::GpuError;
use crate::gpu::frame::{Batch, DepthBuffer, FrameTarget, Output, PictureTarget, readback};
use crate::light::Moment;
use crate::volumes::{FramePlan, Light};
use std::time::Instant;
use sunbake_shaders::VolumeUse;

/// What the passes of a frame draw into.
pub struct VolumeTarget<'a> {
    pub output: Output,
    pub picture: PictureTarget<'a>,
    pub depth: DepthBuffer,
    /// Whether commands are submitted after each light: not in an encoder of the caller's.
    is_flushed: bool,
}

impl VolumeRenderer<'_> {
    /// Draws a picture into the caller's texture view: records its passes into the caller's encoder, and submits
    /// nothing. Depths, the stencil and volumes are kept in resources of the renderer's own. Pipelines are built for
    /// the format when it is first drawn into.
    ///
    /// Several pictures may be recorded into one encoder. Lights are added up in the target's format: 8 bits round
    /// each sum.
    pub fn draw_into(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        target: PictureTarget<'_>,
        output: Output,
        view: &View,
        moment: &Moment,
    ) -> Result<(), GpuError> {
        let depth = self.targets.depth(self.gpu, output, view.size)?;
        let into = VolumeTarget { output, picture: target, depth, is_flushed: false };
        self.record(encoder, &into, view, moment)
    }

    /// Draws into a picture of its own, and reads it back.
    pub(super) fn draw(&mut self, view: &View, moment: &Moment, output: Output) -> Result<Vec<f32>, GpuError> {
        let gpu = self.gpu;
        let picture = self.targets.picture(gpu, output, view.size)?;
        let depth = self.targets.depth(gpu, output, view.size)?;
        let into = VolumeTarget { output, picture: picture.target(), depth, is_flushed: true };
        gpu.checked("drawing", || {
            let mut encoder = gpu.encoder();
            self.record(&mut encoder, &into, view, moment)?;
            let floats = readback::read(gpu, &picture, output.channels(), encoder)?;
            self.report.times = self.clock.read(gpu)?;
            Ok(floats)
        })?
    }

    fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        into: &VolumeTarget<'_>,
        view: &View,
        moment: &Moment,
    ) -> Result<(), GpuError> {
        let (gpu, output, format) = (self.gpu, into.output, into.picture.format);
        self.check_adding(output, format)?;
        self.report = FrameReport::default();
        (self.last, self.last_output) = (Vec::new(), Some(output));
        let lights = self.lights(moment, output);
        let blended = self.scene.blended_draws(gpu, output, view.eye_m, format)?;
        gpu.checked("building pipelines", || {
            let kinds = lights.iter().map(|light| (light.hard, light.blend));
            self.build(surface_programs(&self.scene.needs, output, kinds).collect(), format);
        })?;
        self.scene.frame.write(gpu, encoder, view, moment);
        self.clock.start();
        self.surface_passes(encoder, into, lights.is_empty());
        for (i, light) in lights.iter().enumerate() {
            if into.is_flushed {
                // Volumes of earlier lights can be freed once they are drawn.
                let done = std::mem::replace(encoder, gpu.encoder());
                gpu.queue.submit([done.finish()]);
            }
            self.scene.frame.write(gpu, encoder, view, &light.moment);
            let place = PassPlace { is_first: i == 0, is_last: i + 1 == lights.len() };
            self.light(encoder, into, view, light, place)?;
        }
        if let Some(blended) = &blended {
            self.scene.frame.write(gpu, encoder, view, moment);
            self.blended_pass(encoder, into, blended);
        }
        self.report.passes = self.clock.passes();
        Ok(())
    }

    /// Several lights are added up, which 32-bit formats need a feature for.
    fn check_adding(&self, output: Output, format: wgpu::TextureFormat) -> Result<(), GpuError> {
        match output {
            Output::Lit => self.gpu.check_blendable(format, "add lights up in pictures of 32 bits"),
            Output::Visibility if self.settings.sun_samples > 1 => {
                self.gpu.check_blendable(format, "add suns up in pictures of 32 bits")
            }
            Output::Visibility | Output::LampVisibility => Ok(()),
        }
    }

    /// Depths and ambient light. A picture of visibility without lights is all background and darkness.
    fn surface_passes(&self, encoder: &mut wgpu::CommandEncoder, into: &VolumeTarget<'_>, is_unlit: bool) {
        let (output, picture, depth) = (into.output, into.picture, into.depth.clone());
        let frame = FrameTarget { output, picture, depth, clock: &self.clock };
        let program = |key: &VolumeProgram| self.programs.get(key, picture.format);
        frame.depth_pass(encoder, &self.scene, |key| program(&VolumeProgram::Depth(*key)));
        if output == Output::Lit {
            let sky = program(&VolumeProgram::Sky);
            let draw = |pass: &mut wgpu::RenderPass<'_>, batch: &Batch| {
                let key = VolumeProgram::Ambient(self.scene.surface_key(&batch.key, output));
                self.scene.draw_surface(pass, batch, program(&key), output);
            };
            frame.surface_pass(encoder, &self.scene, draw, Some(sky), |_| {});
        } else if is_unlit {
            self.light_pass(encoder, into, None, PassPlace { is_first: true, is_last: true });
        }
    }

    /// Counts a light's volumes, and adds the light.
    fn light(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        into: &VolumeTarget<'_>,
        view: &View,
        light: &FrameLight,
        place: PassPlace,
    ) -> Result<(), GpuError> {
        let find_seconds = self.extrude(&light.light)?;
        let started = Instant::now();
        let (plan, draws) = self.frame_plan(view, &light.light);
        let plan_seconds = started.elapsed().as_secs_f64();
        self.report_light(&light.light, &plan, &draws, find_seconds, plan_seconds);
        let light_index = light_index(&light.light);
        let is_shaded = draws.triangles() > 0;
        self.note_last(light, is_shaded);
        self.prepare_faces(light_index, &draws, VolumeUse::Stencil, into.picture.format);
        if is_shaded {
            self.volume_pass(encoder, &into.depth, light_index, &plan, &draws);
        }
        self.light_pass(encoder, into, Some((light, is_shaded)), place);
        Ok(())
    }

    /// Makes sure that the kept volumes are those of this light.
    pub(super) fn extrude(&mut self, light: &Light) -> Result<FindSeconds, GpuError> {
        let kept = &self.extruded[light_index(light)];
        if self.settings.optimizations.cache && kept.as_ref().is_some_and(|extruded| extruded.light == *light) {
            return Ok([0.0; 2]);
        }
        let VolumeSettings { mode, optimizations, .. } = self.settings;
        let extruded = Extruded::new(self.gpu, &self.casters, &self.buffers, *light, mode, optimizations)?;
        let seconds = [extruded.find_seconds, extruded.overlap_seconds];
        self.extruded[light_index(light)] = Some(extruded);
        Ok(seconds)
    }

    /// What to draw of a light's volumes.
    pub(super) fn frame_plan(&self, view: &View, light: &Light) -> (FramePlan, VolumeDraws) {
        let VolumeSettings { mode, optimizations, .. } = self.settings;
        let extruded = self.extruded[light_index(light)].as_ref().expect("a light is planned once it has extruded");
        let plan = FramePlan::new(&self.casters, &self.receivers, &extruded.facings, light, view, mode, optimizations);
        let draws = VolumeDraws::new(extruded, &plan, optimizations);
        (plan, draws)
    }

    /// Builds the pipelines over faces that a plan needs and that are not there yet.
    pub(super) fn prepare_faces(
        &mut self,
        light_index: usize,
        draws: &VolumeDraws,
        of: VolumeUse,
        format: wgpu::TextureFormat,
    ) {
        let Some(extruded) = &self.extruded[light_index] else { return };
        let drawn = draws.all().filter(|(draw, _)| draw.serves(of));
        let faces: Vec<FaceKey> = drawn.map(|(draw, is_z_pass)| face_key(extruded, draw, of, is_z_pass)).collect();
        if let Some(light) = self.last.iter_mut().rfind(|light| light.light_index == light_index) {
            light.faces.extend(faces.iter().copied());
        }
        let merge = (draws.runs.len() > 1 && of == VolumeUse::Stencil).then_some(VolumeProgram::MergeRun);
        self.build(faces.into_iter().map(VolumeProgram::Faces).chain(merge).collect(), format);
    }

    fn build(&mut self, wanted: Vec<VolumeProgram>, format: wgpu::TextureFormat) {
        let mut programs = std::mem::take(&mut self.programs);
        programs.prepare(wanted, format, |key| self.program(key, format));
        self.programs = programs;
    }
}
