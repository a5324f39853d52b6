//! The stage through a camera.

use crate::camera::View;
use crate::stage::Stage;
use rayon::prelude::*;
use std::sync::OnceLock;
use sunbake::trace::Hit;

/// A view of a stage. What its pixels show is found once, when first asked for, and serves every moment of the day.
pub struct Shot<'a> {
    /// What is seen.
    pub stage: &'a Stage,
    /// Through what.
    pub view: View,
    hits: OnceLock<Vec<Option<Hit>>>,
}

impl<'a> Shot<'a> {
    /// A view of a stage.
    pub fn new(stage: &'a Stage, view: View) -> Self {
        Self { stage, view, hits: OnceLock::new() }
    }

    /// The surface at each pixel's centre, in row order.
    pub fn hits(&self) -> &[Option<Hit>] {
        self.hits.get_or_init(|| {
            // Built by one thread, before many ask for it.
            self.stage.tracer();
            let eye_m = self.view.eye_m.as_dvec3();
            let width = self.view.size[0] as usize;
            (0..self.view.pixel_count())
                .into_par_iter()
                .with_min_len(64)
                .map(|i| {
                    let ray = self.view.ray((i % width) as u32, (i / width) as u32);
                    self.stage.primary_hit(eye_m, ray.as_dvec3())
                })
                .collect()
        })
    }

    /// The ray of a pixel, by its place in row order.
    pub fn ray(&self, pixel: usize) -> glam::Vec3 {
        let width = self.view.size[0] as usize;
        self.view.ray((pixel % width) as u32, (pixel / width) as u32)
    }
}
