//! Baked maps, evaluated on the CPU: the twin of [`super::BakedGpu`], used instead of it where there is no GPU.
//!
//! Each pixel takes one primary ray and one evaluation of the maps. Errors are those of the maps: the step of stored
//! times, the size of a texel, and, with few lanes, taking the sun's disc for lines along its path.

use super::{Technique, on_cpu};
use crate::gpu::{GpuError, Output};
use crate::image::Raster;
use crate::light::{LampMoment, Moment};
use crate::plan::DrawPlan;
use crate::playback::Page;
use crate::shot::Shot;
use crate::stage::Stage;
use rayon::prelude::*;
use sunbake::trace::Hit;
use sunbake_shaders::Filter;

/// Baked maps on the CPU.
pub struct BakedCpu<'a> {
    stage: &'a Stage,
    pages: Vec<Page<'a>>,
    filter: Filter,
}

impl<'a> BakedCpu<'a> {
    /// Prepares the maps of a stage.
    pub fn new(stage: &'a Stage, filter: Filter) -> Self {
        let radius_rad = stage.path.as_ref().map_or(0.0, |path| path.angular_radius_rad);
        let pages = stage.pages.iter().map(|maps| Page::new(maps, stage.bits, radius_rad)).collect();
        Self { stage, pages, filter }
    }

    fn lamp_visibility_at(&self, shot: &Shot, pixel: usize, hit: &Hit, lamp: &LampMoment) -> f32 {
        let triangle = hit.triangle as usize;
        let gate_normal = self.stage.gate_normal(triangle, hit.barycentric, shot.ray(pixel));
        let to_lamp_m = lamp.position_m - self.stage.geometry.point(triangle, hit.barycentric).as_vec3();
        let Some((page, page_uv)) = self.stage.page_uv(hit) else { return 0.0 };
        self.pages[page as usize].lamp_visibility(page_uv, gate_normal, to_lamp_m, self.filter, lamp)
    }

    fn sun_visibility_at(&self, shot: &Shot, pixel: usize, hit: &Hit, moment: &Moment) -> f32 {
        let Some((page, page_uv)) = self.stage.page_uv(hit) else { return 0.0 };
        let gate_normal = self.stage.gate_normal(hit.triangle as usize, hit.barycentric, shot.ray(pixel));
        self.pages[page as usize].sun_visibility(page_uv, gate_normal, self.filter, moment)
    }
}

impl Technique for BakedCpu<'_> {
    fn name(&self) -> String {
        "baked".into()
    }

    fn visibility(&mut self, shot: &Shot, moment: &Moment) -> Result<Raster<f32>, GpuError> {
        let hits = shot.hits().par_iter().enumerate().with_min_len(64);
        let seen = hits.map(|(pixel, hit)| hit.map_or(1.0, |hit| self.sun_visibility_at(shot, pixel, &hit, moment)));
        Ok(Raster { size: shot.view.size, pixels: seen.collect() })
    }

    fn lamp_visibility(&mut self, shot: &Shot, moment: &Moment) -> Result<Raster<f32>, GpuError> {
        let seen = |(pixel, hit): (usize, &Option<Hit>)| match (hit, &moment.lamp) {
            (None, _) => 1.0,
            (Some(_), None) => 0.0,
            (Some(hit), Some(lamp)) => self.lamp_visibility_at(shot, pixel, hit, lamp),
        };
        let pixels = shot.hits().par_iter().enumerate().with_min_len(64).map(seen).collect();
        Ok(Raster { size: shot.view.size, pixels })
    }

    fn bytes(&self) -> u64 {
        self.stage.gpu_bytes()
    }

    fn draw_plan(&self, _shot: &Shot, _output: Output) -> DrawPlan {
        on_cpu::baked(self.stage)
    }
}
