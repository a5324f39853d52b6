//! Records the passes of a frame.

use super::plan::{MapNeeds, SunShading};
use super::programs::{MapProgram, SunReads};
use super::textures::{CasterMask, DepthMaps};
use super::{MapRenderer, MapReport, SunNow};
use crate::View;
use crate::gpu::device::GpuError;
use crate::gpu::frame::{Batch, BatchKey, FrameTarget, Output, PictureTarget, readback};
use crate::light::Moment;
use std::time::Instant;

impl MapRenderer<'_> {
    /// Draws a picture into the caller's texture view: records its passes into the caller's encoder, and submits
    /// nothing. Depths and maps are kept in textures of the renderer's own. Pipelines are built for the format when
    /// it is first drawn into.
    ///
    /// Several pictures may be recorded into one encoder. Submit it: the next picture takes maps that were recorded
    /// as drawn.
    pub fn draw_into(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        target: PictureTarget<'_>,
        output: Output,
        view: &View,
        moment: &Moment,
    ) -> Result<(), GpuError> {
        // Maps of a frame that failed may not have been drawn.
        self.record(encoder, target, output, view, moment).inspect_err(|_| self.forget())
    }

    fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        target: PictureTarget<'_>,
        output: Output,
        view: &View,
        moment: &Moment,
    ) -> Result<(), GpuError> {
        let gpu = self.gpu;
        (self.report, self.last) = (MapReport::default(), None);
        let started = Instant::now();
        let now = self.sun_now(view, moment, output);
        self.report.fit_seconds = started.elapsed().as_secs_f64();
        self.report.without = match &now {
            SunNow::Down => Some("the sun is down, or not asked for"),
            SunNow::Open => Some("nothing in view can be in shadow"),
            SunNow::Shaded(_) => None,
        };
        let needs = self.needs_of(view.size, output, &now);
        let depth = self.targets.depth(gpu, output, view.size)?;
        let blended = self.scene.blended_draws(gpu, output, view.eye_m, target.format)?;
        gpu.checked("building pipelines", || self.prepare(view.size, &needs, target.format))??;
        self.scene.frame.write(gpu, encoder, view, moment);
        self.clock.start();
        if let SunNow::Shaded(maps) = &now {
            let height_m = self.shadow_scene.ground.casts_from_m as f32;
            self.bindings.write(gpu, encoder, maps, view.eye_m, height_m);
            self.shadow_passes(encoder, maps);
        }
        let into = FrameTarget { output, picture: target, depth, clock: &self.clock };
        let program = |key: &MapProgram| self.programs.get(key, target.format);
        into.depth_pass(encoder, &self.scene, |key| program(&MapProgram::Depth(*key)));
        let surface = |key: &BatchKey| needs.surface_program_key(&self.scene.needs, key);
        let bind_maps = |pass: &mut wgpu::RenderPass<'_>, key: &BatchKey| {
            if let MapProgram::Surface(_, SunReads::Maps | SunReads::Mask | SunReads::Flat, _) = surface(key) {
                pass.set_bind_group(3, self.read_group.as_ref().map(|(group, _)| group), &[]);
            }
        };
        let draw = |pass: &mut wgpu::RenderPass<'_>, batch: &Batch| {
            bind_maps(pass, &batch.key);
            let program = program(&surface(&batch.key));
            match output {
                Output::Visibility => self.scene.draw_without_page(pass, batch, program, output),
                Output::Lit | Output::LampVisibility => self.scene.draw_surface(pass, batch, program, output),
            }
        };
        let sky = (output == Output::Lit).then(|| program(&MapProgram::Sky));
        into.surface_pass(encoder, &self.scene, draw, sky, |pass| {
            if let Some(blended) = &blended {
                blended.draw(pass, &self.scene, |key| program(&surface(key)), bind_maps);
            }
        });
        self.report.passes = self.clock.passes();
        self.last = Some(needs.drawn(self.report.drawn));
        Ok(())
    }

    /// Draws into a picture of its own, and reads it back.
    pub(super) fn draw(&mut self, view: &View, moment: &Moment, output: Output) -> Result<Vec<f32>, GpuError> {
        let gpu = self.gpu;
        let picture = self.targets.picture(gpu, output, view.size)?;
        gpu.checked("drawing", || {
            let mut encoder = gpu.encoder();
            self.record(&mut encoder, picture.target(), output, view, moment)?;
            let floats = readback::read(gpu, &picture, output.channels(), encoder)?;
            self.report.times = self.clock.read(gpu)?;
            Ok(floats)
        })
        .flatten()
        // Maps of a frame that failed may not have been drawn.
        .inspect_err(|_| {
            self.last = None;
            self.forget();
        })
    }

    /// Makes whatever a frame needs and is not there yet.
    fn prepare(&mut self, size: [u32; 2], needs: &MapNeeds, format: wgpu::TextureFormat) -> Result<(), GpuError> {
        if let SunShading::Shaded { maps, .. } = needs.shading {
            self.prepare_shadows(size, maps)?;
        }
        let mut programs = std::mem::take(&mut self.programs);
        programs.prepare(needs.programs(&self.scene.needs), format, |key| self.program(key, format));
        self.programs = programs;
        Ok(())
    }

    /// Makes the maps and masks that a frame needs and that are not there yet.
    fn prepare_shadows(&mut self, size: [u32; 2], count: usize) -> Result<(), GpuError> {
        let (gpu, size_texels) = (self.gpu, self.settings.size_texels);
        if self.reads.has_depths && self.maps.as_ref().is_none_or(|maps| maps.layers.len() < count) {
            self.maps = Some(DepthMaps::new(gpu, size_texels, count as u32)?);
            (self.read_group, self.drawn) = (None, Vec::new());
        }
        if self.reads.has_mask && self.mask.is_none() {
            self.mask = Some([(); 2].map(|()| CasterMask::new(gpu, [size_texels; 2])));
        }
        if self.reads.has_flat_mask && self.flat.as_ref().is_none_or(|flat| flat.size != size) {
            (self.flat, self.read_group) = (Some(CasterMask::new(gpu, size)), None);
        }
        if self.read_group.is_none() {
            let mask = self.mask.as_ref().map(|[mask, _]| mask);
            self.read_group = Some(self.bindings.read(gpu, self.maps.as_ref(), mask, self.flat.as_ref()));
        }
        Ok(())
    }
}
