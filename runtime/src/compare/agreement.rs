//! How two images of the same thing differ.
//!
//! A difference is a picture of its own, so that it can be looked at as well as summed. Two renderers may agree on
//! every number and still disagree on which triangle covers a pixel's centre, or on which side of a shadow's edge it
//! lies. Pixels within one pixel of such an edge are therefore counted apart ([`edges`]).

use crate::image::Raster;
use crate::light::{codes_from_display, display_from_light};
use crate::shot::Shot;
use glam::Vec3;
use serde::Serialize;
use sunbake::statistics;

/// Step in visibility between neighbours that counts as a shadow's edge.
pub(super) const EDGE_STEP: f32 = 4.0 / 255.0;

/// How far two pictures agree, pixel by pixel.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Agreement {
    /// Number of pixels compared.
    pub pixels: usize,
    /// Pixels that differ by no more than the tolerance.
    pub within: usize,
    /// Pixels that differ by more, at edges.
    pub at_edges: usize,
    /// Pixels that differ by more, elsewhere.
    pub unexplained: usize,
    /// Mean difference over all pixels, in the unit of the pictures.
    pub mean: f64,
    /// Largest difference; NaN where either image holds a NaN.
    pub worst: f64,
}

impl Agreement {
    /// Compares a picture of differences with a tolerance. NaN is never within it.
    pub fn new(difference: &Raster<f32>, edges: &[bool], tolerance: f32) -> Self {
        let pixels = difference.pixels.len();
        let over = |&(d, _): &(&f32, &bool)| d.is_nan() || *d > tolerance;
        let pairs = || difference.pixels.iter().zip(edges);
        let at_edges = pairs().filter(over).filter(|(_, edge)| **edge).count();
        let unexplained = pairs().filter(over).count() - at_edges;
        let worst = difference.pixels.iter().map(|&d| f64::from(d));
        let worst = worst.fold(0.0, |a: f64, d| if d.is_nan() || a.is_nan() { f64::NAN } else { a.max(d) });
        let mean = mean(difference);
        Self { pixels, within: pixels - at_edges - unexplained, at_edges, unexplained, mean, worst }
    }

    /// Share of pixels within the tolerance.
    pub fn share_within(&self) -> f64 {
        if self.pixels == 0 { 1.0 } else { self.within as f64 / self.pixels as f64 }
    }
}

/// Mean over all pixels.
pub fn mean(difference: &Raster<f32>) -> f64 {
    statistics::mean(difference.pixels.iter().map(|&d| f64::from(d)))
}

/// Differences of visibility, pixel by pixel.
pub fn visibility_difference(a: &Raster<f32>, b: &Raster<f32>) -> Raster<f32> {
    let pixels = a.pixels.iter().zip(&b.pixels).map(|(a, b)| (a - b).abs());
    Raster { size: a.size, pixels: pixels.collect() }
}

/// Differences of lit pictures as a display shows them: the largest of three channels, 0 to 1 in steps of 1/255.
pub fn color_difference(a: &Raster<Vec3>, b: &Raster<Vec3>) -> Raster<f32> {
    let codes = |light: &Vec3| codes_from_display(display_from_light(*light));
    let pixel = |(a, b): (&Vec3, &Vec3)| {
        if !a.is_finite() || !b.is_finite() {
            return f32::NAN;
        }
        let (a, b) = (codes(a), codes(b));
        f32::from((0..3).map(|k| a[k].abs_diff(b[k])).max().unwrap_or(0)) / 255.0
    };
    Raster { size: a.size, pixels: a.pixels.iter().zip(&b.pixels).map(pixel).collect() }
}

/// Pixels within one pixel of an edge: of a triangle, or of a shadow in `visibility`.
pub fn edges(shot: &Shot, visibility: &Raster<f32>) -> Vec<bool> {
    let hits = shot.hits();
    let [width, height] = shot.view.size;
    let triangle = |i: usize| hits[i].map(|hit| hit.triangle);
    let is_edge = |i: usize| {
        let around: Vec<usize> = neighbours(i, width as usize, height as usize).collect();
        let (mut least, mut most) = (f32::INFINITY, f32::NEG_INFINITY);
        for &n in &around {
            (least, most) = (least.min(visibility.pixels[n]), most.max(visibility.pixels[n]));
        }
        most - least > EDGE_STEP || around.iter().any(|&n| triangle(n) != triangle(i))
    };
    (0..hits.len()).map(is_edge).collect()
}

/// A pixel and those around it.
pub(super) fn neighbours(i: usize, width: usize, height: usize) -> impl Iterator<Item = usize> {
    let (x, y) = (i % width, i / width);
    let rows = y.saturating_sub(1)..=(y + 1).min(height - 1);
    rows.flat_map(move |row| (x.saturating_sub(1)..=(x + 1).min(width - 1)).map(move |column| row * width + column))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_corrupted_pixel_is_caught() {
        let a = Raster::filled([8, 8], 0.25);
        let no_edges = [false; 64];
        assert_eq!(Agreement::new(&visibility_difference(&a, &a), &no_edges, 0.0).within, 64);
        for corruption in [0.5, f32::NAN] {
            let mut b = a.clone();
            b.pixels[19] = corruption;
            let found = Agreement::new(&visibility_difference(&a, &b), &no_edges, 1.0 / 255.0);
            assert_eq!((found.within, found.unexplained), (63, 1));
            assert!(found.worst.is_nan() || (found.worst - 0.25).abs() < 1e-6);
        }
    }

    #[test]
    fn one_corrupted_color_is_caught() {
        let a = Raster::filled([4, 4], Vec3::splat(0.2));
        let mut b = a.clone();
        b.pixels[5].y += 0.1;
        let found = Agreement::new(&color_difference(&a, &b), &[false; 16], 1.0 / 255.0);
        assert_eq!(found.unexplained, 1);
        b.pixels[5].y = f32::NAN;
        let found = Agreement::new(&color_difference(&a, &b), &[false; 16], 1.0 / 255.0);
        assert!(found.unexplained == 1 && found.worst.is_nan());
    }
}
