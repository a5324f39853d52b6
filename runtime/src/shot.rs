//! The stage through a camera.

use crate::camera::View;
use crate::stage::Stage;
use rayon::prelude::*;
use std::sync::OnceLock;
use sunbake::trace::Hit;

/// A stage seen through a view. The surface at each pixel is found on first use, and serves every time of day.
pub struct Shot<'a> {
    /// The stage that is looked at.
    pub stage: &'a Stage,
    /// Camera and picture size.
    pub view: View,
    hits: OnceLock<Vec<Option<Hit>>>,
}

impl<'a> Shot<'a> {
    /// Nothing is traced yet.
    pub fn new(stage: &'a Stage, view: View) -> Self {
        Self { stage, view, hits: OnceLock::new() }
    }

    /// The surface at each pixel's centre, in row order.
    pub fn hits(&self) -> &[Option<Hit>] {
        self.hits.get_or_init(|| {
            // The tracer is built before the parallel loop uses it.
            self.stage.eye_tracer();
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

    /// What lit pictures show at each pixel, where some surfaces are blended: solid surfaces, and then blended ones, to
    /// be drawn in this order. None where none is blended: then all of it is in [`Shot::hits`].
    pub fn layers(&self) -> Option<(Self, Vec<Self>)> {
        self.stage.blended_tracer()?;
        self.stage.eye_tracer();
        let eye_m = self.view.eye_m.as_dvec3();
        let of_pixel = |pixel: usize| {
            let ray = self.ray(pixel).as_dvec3();
            let solid = self.stage.solid_hit(eye_m, ray);
            (solid, self.stage.blended_hits(eye_m, ray, solid.map_or(f64::INFINITY, |hit| hit.distance_m)))
        };
        let pixels = (0..self.view.pixel_count()).into_par_iter().with_min_len(64).map(of_pixel);
        let (solid, blended): (Vec<_>, Vec<_>) = pixels.unzip();
        let of_hits = |hits| Self { stage: self.stage, view: self.view, hits: OnceLock::from(hits) };
        let most = blended.iter().map(Vec::len).max().unwrap_or(0);
        let layer = |k: usize| of_hits(blended.iter().map(|hits| hits.iter().rev().nth(k).copied()).collect());
        Some((of_hits(solid), (0..most).map(layer).collect()))
    }

    /// The ray through the centre of a pixel, given by its index in row order.
    pub fn ray(&self, pixel: usize) -> glam::Vec3 {
        let width = self.view.size[0] as usize;
        self.view.ray((pixel % width) as u32, (pixel / width) as u32)
    }
}
