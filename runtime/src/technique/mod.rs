//! Ways to know how much of the sun, or of a lamp, a pixel's surface sees.
//!
//! All answer with the same image, visibility from 0 to 1 where pixels without a surface read 1, so all are compared
//! alike. What each costs and where it is wrong is said in its own file.

mod baked_cpu;
mod baked_gpu;
mod on_cpu;
mod shadow_maps;
mod truth;
mod volumes;

pub use baked_cpu::BakedCpu;
pub use baked_gpu::BakedGpu;
pub use shadow_maps::ShadowMaps;
pub use truth::{LightKind, Truth};
pub use volumes::Volumes;

use crate::gpu::{FrameTimes, GpuError, Output};
use crate::image::Raster;
use crate::light::Moment;
use crate::plan::{Census, DrawPlan};
use crate::shade;
use crate::shot::Shot;
use glam::Vec3;
use serde::Serialize;

/// What a frame took.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct FrameCost {
    /// Seconds on the CPU to find what its passes draw: silhouettes, or where maps lie.
    pub cpu_seconds: f64,
    /// Seconds of its passes by the adapter's clock, where they were timed.
    pub passes: Option<FrameTimes>,
}

/// A way to know how much of the sun is seen.
pub trait Technique {
    /// Its name, as on the command line.
    fn name(&self) -> String;

    /// How much of the sun the surface at each pixel's centre sees.
    fn visibility(&mut self, shot: &Shot, moment: &Moment) -> Result<Raster<f32>, GpuError>;

    /// How much of the lamp the surface at each pixel's centre sees; nothing where the moment has none.
    fn lamp_visibility(&mut self, shot: &Shot, moment: &Moment) -> Result<Raster<f32>, GpuError>;

    /// The picture, in linear light.
    fn color(&mut self, shot: &Shot, moment: &Moment) -> Result<Raster<Vec3>, GpuError> {
        let visibility = self.visibility(shot, moment)?;
        let of_lamp = moment.lamp.map(|_| self.lamp_visibility(shot, moment)).transpose()?;
        Ok(shade::lit_picture(shot, moment, &visibility, of_lamp.as_ref()))
    }

    /// Bytes it keeps from frame to frame, beyond the scene itself.
    fn bytes(&self) -> u64;

    /// What the last frame took, where it was drawn in passes.
    fn cost(&self) -> FrameCost {
        FrameCost::default()
    }

    /// The picture with what finds its shadows made visible; none where that is nothing one could see.
    fn shown(&mut self, _shot: &Shot, _moment: &Moment) -> Result<Option<Raster<Vec3>>, GpuError> {
        Ok(None)
    }

    /// What it decided for the last frame, and why, in words; nothing where there is nothing to decide.
    fn plan(&self) -> Vec<String> {
        Vec::new()
    }

    /// The same for machines; null where there is nothing to decide.
    fn details(&self) -> serde_json::Value {
        serde_json::Value::Null
    }

    /// Which effects a shot's pictures of a kind call for. Where that depends on the view and the light, it is the most that they may
    /// take before the first of the kind, and after that what the last one took.
    fn effects(&self, shot: &Shot, output: Output) -> DrawPlan;

    /// What was built on the GPU for it; none where the CPU draws.
    fn census(&self) -> Option<Census> {
        None
    }
}
