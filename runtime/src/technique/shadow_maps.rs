//! Live shadow maps: depths as the sun sees them, which each pixel's surface is compared with.
//!
//! Passes: one for each map, unless those of the last frame serve; depths; and one that lights. Targets: the maps, a
//! picture and its depths. Wrong by about a texel at every edge, and where a caster is thinner than one. How far, and
//! what each variant does about it, is in [`crate::shadow_maps::Variant`] and measured in
//! `docs/measurements/shadow_maps.md`.

use super::{FrameCost, Technique};
use crate::gpu::{Gpu, GpuError, MapRenderer, MapReport, Output};
use crate::image::Raster;
use crate::light::Moment;
use crate::plan::{Census, DrawPlan};
use crate::shadow_maps::{MapSettings, Variant};
use crate::shot::Shot;
use crate::stage::Stage;
use glam::Vec3;

/// Shadow maps on the GPU.
pub struct ShadowMaps<'g> {
    renderer: MapRenderer<'g>,
    settings: MapSettings,
}

impl<'g> ShadowMaps<'g> {
    /// Uploads a stage.
    pub fn new(gpu: &'g Gpu, stage: &Stage, settings: MapSettings) -> Result<Self, GpuError> {
        Ok(Self { renderer: MapRenderer::new(gpu, stage, settings)?, settings })
    }

    /// Settings as they were given to [`ShadowMaps::new`].
    pub fn settings(&self) -> &MapSettings {
        &self.settings
    }

    /// What the last frame was made of.
    pub fn report(&self) -> &MapReport {
        self.renderer.report()
    }

    /// The renderer that draws the maps.
    pub fn renderer(&self) -> &MapRenderer<'g> {
        &self.renderer
    }
}

impl Technique for ShadowMaps<'_> {
    fn name(&self) -> String {
        self.settings.variant.to_string()
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
        let census = self.renderer.census();
        census.shadow_bytes + census.map_bytes
    }

    fn cost(&self) -> FrameCost {
        let report = self.renderer.report();
        FrameCost { cpu_seconds: report.fit_seconds, passes: report.times }
    }

    fn draw_plan(&self, shot: &Shot, output: Output) -> DrawPlan {
        self.renderer.plan_of(shot.stage, output, shot.view.pixel_count() as u64)
    }

    fn census(&self) -> Option<Census> {
        Some(self.renderer.census())
    }

    fn details(&self) -> serde_json::Value {
        serde_json::json!({
            "size_texels": self.settings.size_texels,
            "bias": self.settings.bias.to_string(),
            "sampler_filters": self.renderer.filters(),
            "sampler_reads_halfway": self.renderer.halfway(),
            "ground_height_m": self.renderer.ground_height_m(),
            "frame": self.renderer.report(),
        })
    }

    fn notes(&self) -> Vec<String> {
        let (settings, report) = (&self.settings, self.renderer.report());
        let mut lines = Vec::new();
        let lacks_ground = settings.variant == Variant::Planar && self.renderer.ground_height_m().is_none();
        if let Some(without) = report.without.filter(|_| !lacks_ground) {
            return vec![format!("{without}: nothing is drawn for shadows")];
        }
        if settings.variant == Variant::Planar {
            lines.push(match self.renderer.ground_height_m() {
                Some(height_m) => format!(
                    "the ground is the lowest large level plane, {height_m:.3} m above the scene's middle: casters \
                     are projected flat onto it, and nothing else is in shadow"
                ),
                None => "no surface is level: there is no ground, and nothing is in shadow".to_owned(),
            });
            return lines;
        }
        let texels: Vec<String> = report.texels_m.iter().map(|m| format!("{:.1} mm", m * 1e3)).collect();
        lines.push(format!(
            "{} of {} texels squared ({} drawn, {} kept), texels of {} in their middles; bias {}",
            if report.maps == 1 { "one map".to_owned() } else { format!("{} maps", report.maps) },
            settings.size_texels,
            report.drawn,
            report.maps - report.drawn,
            texels.join(", "),
            settings.bias
        ));
        if let Some(filters) = self.renderer.filters() {
            lines.push(if filters {
                "the comparison sampler filters two by two texels".to_owned()
            } else {
                "the comparison sampler does not filter".to_owned()
            });
        }
        if settings.variant == Variant::Ground {
            lines.push(match self.renderer.ground_height_m() {
                Some(height_m) => format!(
                    "the ground is the lowest large level plane, {height_m:.3} m above the scene's middle: it reads a \
                     blurred mask of casters, all else compares depths"
                ),
                None => "no surface is level: there is no ground, and all compare depths".to_owned(),
            });
        }
        lines
    }
}
