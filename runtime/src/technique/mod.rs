//! Techniques: ways to find the visibility of the sun, or of a lamp, at each pixel.
//!
//! All give the same kind of image: visibility from 0 to 1, where pixels without a surface read 1. So all are compared
//! alike. Each file says what its technique costs and where it is wrong.

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

/// Times of a frame.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct FrameCost {
    /// Seconds on the CPU to find what its passes draw: silhouettes, or where maps lie.
    pub cpu_seconds: f64,
    /// Seconds of its passes by the adapter's clock, where they were timed.
    pub passes: Option<FrameTimes>,
}

/// A way to find the visibility of a light.
pub trait Technique {
    /// Its name, as on the command line.
    fn name(&self) -> String;

    /// Visibility of the sun from the surface at each pixel's centre, 0 to 1.
    fn visibility(&mut self, shot: &Shot, moment: &Moment) -> Result<Raster<f32>, GpuError>;

    /// Visibility of the lamp from the surface at each pixel's centre, 0 to 1; 0 where the moment has no lamp.
    fn lamp_visibility(&mut self, shot: &Shot, moment: &Moment) -> Result<Raster<f32>, GpuError>;

    /// The picture, in linear light.
    fn color(&mut self, shot: &Shot, moment: &Moment) -> Result<Raster<Vec3>, GpuError> {
        shade::blended_picture(shot, moment, |shot| {
            let visibility = self.visibility(shot, moment)?;
            let of_lamp = moment.lamp.map(|_| self.lamp_visibility(shot, moment)).transpose()?;
            Ok((visibility, of_lamp))
        })
    }

    /// Bytes of memory kept from frame to frame, beyond the scene itself.
    fn bytes(&self) -> u64;

    /// Times of the last frame, where it was drawn in passes.
    fn cost(&self) -> FrameCost {
        FrameCost::default()
    }

    /// The picture with the geometry of its shadows made visible (shadow volumes). None for techniques without such
    /// geometry.
    fn debug_picture(&mut self, _shot: &Shot, _moment: &Moment) -> Result<Option<Raster<Vec3>>, GpuError> {
        Ok(None)
    }

    /// What was decided for the last frame and why, as sentences. Empty where there is nothing to decide.
    fn notes(&self) -> Vec<String> {
        Vec::new()
    }

    /// The same for programs. Null where there is nothing to decide.
    fn details(&self) -> serde_json::Value {
        serde_json::Value::Null
    }

    /// Which effects a shot's pictures of one kind need. Where that depends on the view and the light, it is an upper
    /// bound before the first such picture, and afterwards what the last one needed.
    fn draw_plan(&self, shot: &Shot, output: Output) -> DrawPlan;

    /// What was built on the GPU. None where the CPU draws.
    fn census(&self) -> Option<Census> {
        None
    }
}
