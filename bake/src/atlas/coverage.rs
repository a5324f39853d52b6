//! Which texels a triangle touches, and which a filter reads at its points.
//!
//! Theory: conservative rasterisation. A texel is touched if its square and the triangle overlap by more than
//! [`EPSILON_TEXELS`]. Within one row of texels the triangle's part is convex, so it touches one run of texels.
//!
//! Practice: chart borders often lie exactly between two texels and must not touch the texels beyond: hence the
//! epsilon. A triangle thinner than the epsilon still touches one row, and in each row one texel, at its middle. So
//! every point of a triangle lies in a touched texel, or within two epsilons of one.
//!
//! A filter of two by two texels reads those whose centres are less than a texel away along both axes. What counts by
//! less than [`LEAST_WEIGHT`] is left out.

use glam::DVec2;
use std::ops::Range;

/// Overlap that is ignored, in texels. Larger than the rounding of `f32` coordinates on a page of 8192 texels.
pub(super) const EPSILON_TEXELS: f64 = 1.0 / 512.0;

/// Weight below which a texel counts as not read: more than that of what lies beside charts that are drawn together
/// ([`super::chart_box`]).
const LEAST_WEIGHT: f64 = 1.0 / 256.0;

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
    let (low, high) = extent(corners, f64::from(row) - EPSILON_TEXELS, f64::from(row) + 1.0 + EPSILON_TEXELS);
    if low <= high { cells(low, high, width) } else { 0..0 }
}

/// Texel rows that a filter reads at the triangle's points.
pub(super) fn read_rows(corners: &TexelTriangle, height: u32) -> Range<u32> {
    let low = corners.iter().fold(f64::INFINITY, |low, c| low.min(c.y));
    let high = corners.iter().fold(f64::NEG_INFINITY, |high, c| high.max(c.y));
    near(low, high, height)
}

/// Texel columns that a filter reads at the triangle's points, within one of its [`read_rows`].
pub(super) fn read_columns(corners: &TexelTriangle, row: u32, width: u32) -> Range<u32> {
    let (centre, reach) = (f64::from(row) + 0.5, 1.0 - LEAST_WEIGHT);
    let (low, high) = extent(corners, centre - reach, centre + reach);
    if low <= high { near(low, high, width) } else { 0..0 }
}

/// Texels whose centres are near [low, high].
fn near(low: f64, high: f64, count: u32) -> Range<u32> {
    let reach = 1.0 - LEAST_WEIGHT;
    let [first, end] = [(low - reach - 0.5).floor() + 1.0, (high + reach - 0.5).ceil()];
    let count = f64::from(count);
    first.clamp(0.0, count) as u32..end.clamp(0.0, count) as u32
}

/// Least and greatest x of the triangle's part between two heights; the least is greater where there is none.
fn extent(corners: &TexelTriangle, bottom: f64, top: f64) -> (f64, f64) {
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
    (low, high)
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

    /// By brute force: points of a triangle, and what a filter weighs there.
    #[test]
    fn what_a_filter_reads_is_what_it_weighs() {
        let triangles = [
            [DVec2::new(2.5, 3.5), DVec2::new(7.5, 3.5), DVec2::new(2.5, 9.5)],
            [DVec2::new(2.2, 3.1), DVec2::new(7.9, 4.4), DVec2::new(3.3, 9.9)],
            [DVec2::new(4.5, 4.501), DVec2::new(4.501, 4.5), DVec2::new(4.5, 4.5)],
        ];
        for corners in triangles {
            let mut expected = std::collections::BTreeSet::new();
            for (u, v) in (0..=200).flat_map(|u| (0..=200 - u).map(move |v| (f64::from(u), f64::from(v)))) {
                let p = corners[0] + (corners[1] - corners[0]) * (u / 200.0) + (corners[2] - corners[0]) * (v / 200.0);
                let low = (p - 0.5).floor();
                for corner in [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE] {
                    let away = (p - 0.5 - low - corner).abs();
                    // Not those at the limit, which sampling may miss.
                    if away.max_element() < 1.0 - 1.5 * LEAST_WEIGHT {
                        expected.insert(((low + corner).y as u32, (low + corner).x as u32));
                    }
                }
            }
            let rows = read_rows(&corners, 16);
            let read: Vec<(u32, u32)> = rows.flat_map(|y| read_columns(&corners, y, 16).map(move |x| (y, x))).collect();
            assert_eq!(read, expected.into_iter().collect::<Vec<_>>());
        }
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
