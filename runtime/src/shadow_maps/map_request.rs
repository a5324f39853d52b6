//! What the perspective maps of a view must hold, and how well given maps serve it.

use super::extents::{Extents, Near};
use super::polyhedron::Polyhedron;
use super::projection::MapProjection;
use crate::camera::View;
use glam::{DVec3, DVec4};

/// Texel size in pixels below which smaller texels gain nothing.
const FINE_PX: f64 = 0.5;

/// What the maps of a view must hold, and how large they are.
pub struct MapRequest<'a> {
    /// The camera's view that the maps serve.
    pub view: &'a View,
    /// How far casters and receivers reach.
    pub extents: &'a Extents,
    /// The bounding box of drawn triangles.
    pub receiver_box_m: [DVec3; 2],
    /// Points sampled on drawn triangles.
    pub samples_m: &'a [DVec3],
    /// Edge of a map.
    pub size_texels: u32,
    /// Texels kept around what each map must hold.
    pub margin_texels: f64,
    /// Where the maps' depths begin.
    pub near: Near,
}

impl MapRequest<'_> {
    /// The part of the receivers' box that is in view.
    pub fn region(&self) -> Polyhedron {
        let rows = self.view.clip_from_eye().as_dmat4().transpose();
        let eye_m = self.view.eye_m.as_dvec3();
        let about_eye = |row: DVec4| row.truncate().extend(row.w - row.truncate().dot(eye_m));
        let [x, y, w] = [rows.x_axis, rows.y_axis, rows.w_axis];
        let near = w - DVec4::W * f64::from(self.view.near_m());
        let planes = [w + x, w - x, w + y, w - y, near];
        planes.iter().fold(Polyhedron::of_box(self.receiver_box_m), |body, plane| body.clipped_by(about_eye(*plane)))
    }

    /// The sampled points that are in view.
    pub fn samples(&self) -> Vec<DVec3> {
        let eye_m = self.view.eye_m.as_dvec3();
        let [width, height] = self.view.size.map(f64::from);
        let is_in_view = |p: &&DVec3| {
            let [x, y] = {
                let ray = **p - eye_m;
                let depth_m = ray.dot(self.view.forward.as_dvec3());
                if depth_m <= 0.0 { [-1.0; 2] } else { self.view.pixel_of(ray / depth_m) }
            };
            (0.0..width).contains(&x) && (0.0..height).contains(&y)
        };
        self.samples_m.iter().filter(is_in_view).copied().collect()
    }

    /// The mean logarithm of the texels' size in pixels, over points in view. Smaller is better.
    pub fn mean_log_texel_px(&self, maps: &[MapProjection], samples_m: &[DVec3]) -> f64 {
        let eye_m = self.view.eye_m.as_dvec3();
        let of_sample = |p: &DVec3| {
            let pixel_m = p.distance(eye_m) * f64::from(self.view.pixel_angle_rad);
            match maps.iter().find(|map| map.holds(*p, 0.0)) {
                Some(map) => (map.texel_m(*p) / pixel_m).max(FINE_PX).ln(),
                // Never in shadow, so it needs no texel.
                None => FINE_PX.ln(),
            }
        };
        samples_m.iter().map(of_sample).sum::<f64>() / samples_m.len().max(1) as f64
    }
}
