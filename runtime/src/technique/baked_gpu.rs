//! Baked maps, evaluated on the GPU. The method of *GPU Gems* chapter 13.
//!
//! Passes: depths, then one that evaluates the maps where it lights. Targets: a picture and its depths. Cost: the
//! maps' bytes, and for each pixel four texels of two textures per layer. Wrong where [`super::BakedCpu`] is, and
//! equal to it but for rounding.

use super::{FrameCost, Technique};
use crate::gpu::{BakedRenderer, Gpu, GpuError, Output};
use crate::image::Raster;
use crate::light::Moment;
use crate::plan::{Census, DrawPlan};
use crate::shot::Shot;
use crate::stage::Stage;
use glam::Vec3;
use sunbake_shaders::Filter;

/// Baked maps on the GPU.
pub struct BakedGpu<'g> {
    renderer: BakedRenderer<'g>,
}

impl<'g> BakedGpu<'g> {
    /// Uploads a stage.
    pub fn new(gpu: &'g Gpu, stage: &Stage, filter: Filter) -> Result<Self, GpuError> {
        Ok(Self { renderer: BakedRenderer::new(gpu, stage, filter)? })
    }

    /// The same, with passes timed if the GPU can.
    pub fn timed(self) -> Self {
        Self { renderer: self.renderer.timed() }
    }
}

impl Technique for BakedGpu<'_> {
    fn name(&self) -> String {
        "baked".into()
    }

    fn visibility(&mut self, shot: &Shot, moment: &Moment) -> Result<Raster<f32>, GpuError> {
        Ok(Raster { size: shot.view.size, pixels: self.renderer.visibility(&shot.view, moment)? })
    }

    fn lamp_visibility(&mut self, shot: &Shot, moment: &Moment) -> Result<Raster<f32>, GpuError> {
        Ok(Raster { size: shot.view.size, pixels: self.renderer.lamp_visibility(&shot.view, moment)? })
    }

    fn color(&mut self, shot: &Shot, moment: &Moment) -> Result<Raster<Vec3>, GpuError> {
        Ok(Raster { size: shot.view.size, pixels: self.renderer.lit(&shot.view, moment)? })
    }

    fn bytes(&self) -> u64 {
        self.renderer.census().map_bytes
    }

    fn cost(&self) -> FrameCost {
        FrameCost { cpu_seconds: 0.0, passes: self.renderer.times() }
    }

    fn draw_plan(&self, _shot: &Shot, output: Output) -> DrawPlan {
        self.renderer.plan(output)
    }

    fn census(&self) -> Option<Census> {
        Some(self.renderer.census())
    }
}
