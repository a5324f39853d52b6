//! Live shadow volumes: for each moment, the surfaces that the centre of the sun or the lamp does not see.
//!
//! Passes: depths, ambient light, and for each light its volumes and then its light. Targets: a picture, and its
//! depths with a stencil. Kept: the casters' points, and the volumes of the last lights. Exact at each pixel's
//! centre, with hard edges. Wrong under alpha masks, whose whole triangles cast, and for shadows shallower than a
//! 64th of a pixel: rasterisation cannot resolve them, and a surface must not be shaded by what lies on it.

use super::{FrameCost, Technique};
use crate::gpu::{FrameReport, Gpu, GpuError, Output, VolumeRenderer, VolumeSettings};
use crate::image::Raster;
use crate::light::Moment;
use crate::plan::{Census, DrawPlan};
use crate::shot::Shot;
use crate::stage::Stage;
use crate::volumes::{CasterCounts, Mode};
use glam::Vec3;
use sunbake::words::counted;

/// Shadow volumes on the GPU.
pub struct Volumes<'g> {
    renderer: VolumeRenderer<'g>,
    settings: VolumeSettings,
}

impl<'g> Volumes<'g> {
    /// Uploads a stage and welds its casters.
    pub fn new(gpu: &'g Gpu, stage: &Stage, settings: VolumeSettings) -> Result<Self, GpuError> {
        Ok(Self { renderer: VolumeRenderer::new(gpu, stage, settings)?, settings })
    }

    /// What the last frame was made of.
    pub fn report(&self) -> &FrameReport {
        self.renderer.report()
    }

    /// Counts of the casters.
    pub fn caster_counts(&self) -> CasterCounts {
        self.renderer.caster_counts()
    }

    /// The renderer that draws the volumes.
    pub fn renderer(&mut self) -> &mut VolumeRenderer<'g> {
        &mut self.renderer
    }
}

impl Technique for Volumes<'_> {
    fn name(&self) -> String {
        self.settings.mode.to_string()
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

    fn debug_picture(&mut self, shot: &Shot, moment: &Moment) -> Result<Option<Raster<Vec3>>, GpuError> {
        Ok(Some(Raster { size: shot.view.size, pixels: self.renderer.debug_picture(&shot.view, moment)? }))
    }

    fn bytes(&self) -> u64 {
        let census = self.renderer.census();
        census.volume_bytes + census.map_bytes
    }

    fn cost(&self) -> FrameCost {
        let report = self.renderer.report();
        let cpu_seconds = report.lights.iter().map(|light| light.find_seconds + light.plan_seconds).sum();
        FrameCost { cpu_seconds, passes: report.times }
    }

    fn draw_plan(&self, shot: &Shot, output: Output) -> DrawPlan {
        self.renderer.plan_of(shot.stage, output)
    }

    fn census(&self) -> Option<Census> {
        Some(self.renderer.census())
    }

    fn details(&self) -> serde_json::Value {
        serde_json::json!({ "casters": self.renderer.caster_counts(), "frame": self.renderer.report() })
    }

    fn notes(&self) -> Vec<String> {
        let casters = self.renderer.caster_counts();
        let mut lines = vec![
            format!(
                "casters: {} in {}; {} solid bodies ({} of them inside out), {} open ones; {}, {} of three or more \
                 triangles",
                counted(casters.triangles as u64, "triangle"),
                counted(casters.casters as u64, "caster"),
                casters.solid_bodies + casters.inside_out_bodies,
                casters.inside_out_bodies,
                casters.open_bodies,
                counted(casters.open_edges as u64, "open edge"),
                counted(casters.nonmanifold_edges as u64, "edge")
            ),
            format!(
                "solid bodies extrude silhouettes of what faces the light, open ones of every triangle, and {} \
                 casters that share next to no edges a prism a triangle",
                casters.soups
            ),
        ];
        if casters.alpha_masked_triangles > 0 {
            lines.push(format!(
                "{} with an alpha mask: volumes do not see the mask, and the whole triangles cast",
                counted(casters.alpha_masked_triangles as u64, "triangle")
            ));
        }
        for light in &self.renderer.report().lights {
            let plan = &light.plan;
            lines.push(format!(
                "{}: of {}, {} cast nothing, {} miss the view and {} shade nothing in it; {} are counted in front of \
                 the surface, {} behind it ({} without caps); {} in {}",
                light.light,
                counted(plan.casters as u64, "caster"),
                plan.casting_nothing,
                plan.out_of_view,
                plan.shading_nothing,
                plan.z_pass,
                plan.z_fail,
                plan.without_caps,
                counted(light.triangles as u64, "triangle"),
                if light.runs == 1 {
                    "one run".into()
                } else {
                    format!("{} runs, since more than 255 may overlap", light.runs)
                }
            ));
            if plan.replaced > 0 && self.settings.mode == Mode::ZPass {
                lines.push(format!(
                    "{}: z-pass would be wrong for {} (the eye may be in a volume, or a cap shows): counted behind \
                     the surface instead",
                    light.light,
                    counted(plan.replaced as u64, "caster")
                ));
            }
        }
        lines
    }
}
