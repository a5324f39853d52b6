//! Which texels a triangle touches.
//!
//! Theory: conservative rasterisation. A texel is touched if its square and the triangle overlap by more than
//! [`EPSILON_TEXELS`]. Within one row of texels the triangle's part is convex, so it touches one run of texels.
//!
//! Practice: chart borders often lie exactly between two texels and must not touch the texels beyond: hence the
//! epsilon. A triangle thinner than the epsilon still touches one row, and in each row one texel, at its middle. So
//! every point of a triangle lies in a touched texel, or within two epsilons of one.

use glam::DVec2;
use std::ops::Range;

/// Overlap that is ignored, in texels. Larger than the rounding of `f32` coordinates on a page of 8192 texels.
pub(super) const EPSILON_TEXELS: f64 = 1.0 / 512.0;

/// A triangle's corners in texels of its page.
pub(super) type TexelTriangle = [DVec2; 3];

/// Texel rows that the triangle touches; never empty if the page has rows.
pub(super) fn rows(corners: &TexelTriangle, height: u32) -> Range<u32> {
    let low = corners.iter().fold(f64::INFINITY, |low, c| low.min(c.y));
    let high = corners.iter().fold(f64::NEG_INFINITY, |high, c| high.max(c.y));
    cells(low, high, height)
}

/// Texel columns that the triangle touches within one of its [`rows`].
pub(super) fn columns(corners: &TexelTriangle, row: u32, width: u32) -> Range<u32> {
    let (bottom, top) = (f64::from(row) - EPSILON_TEXELS, f64::from(row) + 1.0 + EPSILON_TEXELS);
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    let mut add = |x: f64| (low, high) = (low.min(x), high.max(x));
    for k in 0..3 {
        let (a, b) = (corners[k], corners[(k + 1) % 3]);
        if (bottom..=top).contains(&a.y) {
            add(a.x);
        }
        for y in [bottom, top] {
            if (a.y < y) != (b.y < y) {
                add(a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)));
            }
        }
    }
    if low <= high { cells(low, high, width) } else { 0..0 }
}

/// Unit cells that [low, high] overlaps by more than the epsilon; if none, the cell of its middle.
fn cells(low: f64, high: f64, count: u32) -> Range<u32> {
    let last = f64::from(count) - 1.0;
    let (first, end) = ((low + EPSILON_TEXELS).floor(), (high - EPSILON_TEXELS).ceil());
    let (first, end) =
        if first < end { (first, end) } else { (((low + high) * 0.5).floor(), ((low + high) * 0.5).floor() + 1.0) };
    let first = first.clamp(0.0, last);
    first as u32..end.clamp(first + 1.0, last + 1.0) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn touched(corners: TexelTriangle) -> Vec<(u32, u32)> {
        rows(&corners, 16).flat_map(|y| columns(&corners, y, 16).map(move |x| (x, y))).collect()
    }

    #[test]
    fn borders_between_texels_touch_nothing_beyond() {
        let half = [DVec2::new(2.0, 3.0), DVec2::new(4.0, 3.0), DVec2::new(4.0, 5.0)];
        assert_eq!(touched(half), [(2, 3), (3, 3), (3, 4)]);
    }

    #[test]
    fn needles_and_points_touch_every_texel_they_run_through() {
        let upright = [DVec2::new(5.0, 1.5), DVec2::new(5.0005, 7.5), DVec2::new(5.0, 7.5)];
        assert_eq!(touched(upright), (1..8).map(|y| (5, y)).collect::<Vec<_>>());
        let lying = [DVec2::new(0.5, 6.0), DVec2::new(9.5, 6.0001), DVec2::new(9.5, 6.0)];
        assert_eq!(touched(lying), (0..10).map(|x| (x, 6)).collect::<Vec<_>>());
        assert_eq!(touched([DVec2::splat(16.0); 3]), [(15, 15)]);
        assert_eq!(touched([DVec2::ZERO; 3]), [(0, 0)]);
    }
}
