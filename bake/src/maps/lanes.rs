//! Lanes: the sun's disc as a few lines along its path. One line is the linear light of *GPU Gems* chapter 13. With it,
//! edges that run along the path stay hard, since the whole line crosses them at once.
//!
//! Theory: divide a disc of radius 1 into strips along the path. Up to the height y there lie
//!
//! * `1/2 + (y sqrt(1 - y^2) + asin y) / pi` of its area, and
//! * `(asin y - y sqrt(1 - y^2) (1 - 2 y^2)) / (4 pi)` of its second moment, the integral of y^2 over the area.
//!
//! Practice: strips of equal width. A lane's weight is its strip's area, and it lies at the strip's radius of gyration,
//! the root of its mean y^2. Then the chord at the lane's offset is the root mean square of the strip's chords,
//! weighted by area, so that no other number needs to be stored, and the outer lanes spread light as widely as their
//! strips do, along the path and across it. The middle lane lies on the path, and its window is the whole diameter.
//!
//! Over straight edges in all directions and at all places from rim to rim, what lanes see differs from the disc's free
//! share by, on average:
//!
//! | lanes | at the gyration | at the middles | at the centroids | strips of equal area, gyration | Gauss (Chebyshev) |
//! |---|---|---|---|---|---|
//! | 1 | 0.0722 | 0.0722 | 0.0722 | 0.0722 | 0.0722 |
//! | 3 | 0.0150 | 0.0156 | 0.0160 | 0.0157 | 0.0165 |
//! | 5 | 0.0069 | 0.0069 | 0.0072 | 0.0080 | 0.0078 |
//!
//! Across the path, where the chords matter, the gyration's largest difference is the least too: 0.015 with 3 lanes and
//! 0.008 with 5; the middles' are 0.021 and 0.012. Windows as wide as a strip's plain mean chord do worse than all of
//! these (0.0192 and 0.0086 on average). An edge exactly along the path has as many steps as lanes, each off by at most
//! half a weight: 0.21 with 3 lanes, 0.13 with 5.

use std::f64::consts::PI;

/// One lane across the sun's disc: how far its path lies from the centre's, and its share of the light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lane {
    /// Declination less the centre's, in radians.
    pub offset_rad: f64,
    /// Share of the disc's area; the weights of a page's lanes sum to 1.
    pub weight: f64,
}

impl Lane {
    /// The only lane of a sun that is treated as a line along its path, as in *GPU Gems* chapter 13.
    pub const CENTRE: Self = Self { offset_rad: 0.0, weight: 1.0 };

    /// Lanes across a disc, offsets ascending. Bytes grow with `count`, 1 to 5 as a rule; one lane is [`Lane::CENTRE`].
    ///
    /// Guarantees: offsets lie within the disc and are symmetric; weights sum to 1 exactly, in `f32` as in `f64`.
    pub fn across_disc(count: usize, angular_radius_rad: f64) -> Vec<Self> {
        // Written so that edges on either side of the middle are each other's negatives.
        let edge = |i: usize| (2.0 * i as f64 - count as f64) / count as f64;
        let lane = |i| {
            let [low, high] = [edge(i), edge(i + 1)];
            let share = area_below(high) - area_below(low);
            let gyration = ((second_moment_below(high) - second_moment_below(low)) / share).sqrt();
            let offset = if low == -high { 0.0 } else { gyration.copysign(low + high) };
            Self {
                offset_rad: offset * angular_radius_rad,
                weight: rounded(area_below(high)) - rounded(area_below(low)),
            }
        };
        (0..count).map(lane).collect()
    }

    /// The lane's chord across a disc, as a share of its diameter: its window in path time, as a share of the sun's
    /// width.
    pub fn chord(&self, angular_radius_rad: f64) -> f64 {
        let offset = if angular_radius_rad > 0.0 { self.offset_rad / angular_radius_rad } else { 0.0 };
        (1.0 - offset * offset).max(0.0).sqrt()
    }
}

/// Share of the unit disc's area below a height.
fn area_below(y: f64) -> f64 {
    0.5 + (y * (1.0 - y * y).sqrt() + y.asin()) / PI
}

/// Integral of y^2 over the unit disc below a height, as a share of the area, less that of the lower half.
fn second_moment_below(y: f64) -> f64 {
    (y.asin() - y * (1.0 - y * y).sqrt() * (1.0 - 2.0 * y * y)) / (4.0 * PI)
}

/// A share that `f32` holds without rounding, as it does every sum of such.
fn rounded(share: f64) -> f64 {
    const STEPS: f64 = (1 << 24) as f64;
    (share * STEPS).round() / STEPS
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Share of the lanes' light that an edge leaves, whose normal is turned by `angle_rad` from across the path, `u`
    /// radii from the disc's centre.
    fn lit_share(lanes: &[Lane], angle_rad: f64, u: f64) -> f64 {
        let (sin, cos) = angle_rad.sin_cos();
        let lit = |lane: &Lane| {
            let (from_middle, half_length) = (u - lane.offset_rad * cos, lane.chord(1.0) * sin);
            lane.weight * ((from_middle + half_length) / (2.0 * half_length).max(1e-12)).clamp(0.0, 1.0)
        };
        lanes.iter().map(lit).sum()
    }

    /// Differences from the disc's free share, over edges from rim to rim: the mean over all directions, the largest
    /// along the path, and the largest across it.
    fn errors(lanes: &[Lane]) -> [f64; 3] {
        let places = || (-1000..=1000).map(|i| f64::from(i) / 1000.0);
        let off = |angle_deg: i32| {
            places().map(move |u| (lit_share(lanes, f64::from(angle_deg).to_radians(), u) - area_below(u)).abs())
        };
        let mean = (0..=90).map(|deg| off(deg).sum::<f64>() / 2001.0).sum::<f64>() / 91.0;
        let worst = |deg| off(deg).fold(0.0, f64::max);
        [mean, worst(0), worst(90)]
    }

    #[test]
    fn one_lane_is_linear_light() {
        assert_eq!(Lane::across_disc(1, 0.005), [Lane::CENTRE]);
        assert_eq!(Lane::CENTRE.chord(0.005), 1.0);
        assert_eq!(Lane::CENTRE.chord(0.0), 1.0);
    }

    #[test]
    fn weights_sum_to_one_exactly_and_offsets_are_symmetric() {
        for count in 1..=9 {
            let lanes = Lane::across_disc(count, 0.25);
            assert_eq!(lanes.iter().map(|l| l.weight).sum::<f64>(), 1.0);
            assert_eq!(lanes.iter().rev().map(|l| l.weight as f32).sum::<f32>(), 1.0);
            assert!(lanes.windows(2).all(|w| w[0].offset_rad < w[1].offset_rad));
            for (lane, mirrored) in lanes.iter().zip(lanes.iter().rev()) {
                assert!((lane.offset_rad + mirrored.offset_rad).abs() < 1e-15 && lane.offset_rad.abs() < 0.25);
                assert!((lane.weight - mirrored.weight).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn a_lane_has_its_strips_area_and_second_moment() {
        const STEPS: i32 = 200_000;
        for (count, i) in [(3, 0), (3, 1), (3, 2), (5, 1), (5, 4)] {
            let strip = [2.0 * i as f64 / count as f64 - 1.0, 2.0 * (i + 1) as f64 / count as f64 - 1.0];
            let width = (strip[1] - strip[0]) / f64::from(STEPS);
            let (mut area, mut moment) = (0.0, 0.0);
            for y in (0..STEPS).map(|step| strip[0] + (f64::from(step) + 0.5) * width) {
                let slice = 2.0 * (1.0 - y * y).sqrt() / PI * width;
                (area, moment) = (area + slice, moment + y * y * slice);
            }
            let lane = Lane::across_disc(count, 1.0)[i];
            assert!((lane.weight - area).abs() < 1e-7, "{lane:?}: {area}");
            let expected = if 2 * i + 1 == count { 0.0 } else { (moment / area).sqrt() };
            assert!((lane.offset_rad.abs() - expected).abs() < 1e-7, "{lane:?}: {expected}");
        }
    }

    #[test]
    fn lanes_near_the_disc_as_their_number_grows() {
        for (count, bounds) in [(1, [0.0725, 0.5, 0.058]), (3, [0.0151, 0.209, 0.0155]), (5, [0.0070, 0.1266, 0.0083])]
        {
            let found = errors(&Lane::across_disc(count, 1.0));
            assert!(found.iter().zip(bounds).all(|(found, bound)| *found <= bound), "{count}: {found:?}");
        }
    }

    #[test]
    fn the_gyration_beats_the_middles_and_the_centroids_of_the_strips() {
        for (count, middles, centroids) in
            [(3, vec![2.0 / 3.0], vec![0.6095]), (5, vec![0.8, 0.4], vec![0.7631, 0.3935])]
        {
            let lanes = Lane::across_disc(count, 1.0);
            let [mean, _, across] = errors(&lanes);
            for offsets in [middles, centroids] {
                let mut others = lanes.clone();
                for (i, offset) in offsets.into_iter().enumerate() {
                    others[i].offset_rad = -offset;
                    others[count - 1 - i].offset_rad = offset;
                }
                let [other_mean, _, other_across] = errors(&others);
                // With five lanes the middles are as good on average, to a fifth of a per cent.
                assert!(mean < 1.003 * other_mean, "{count}: {mean} against {other_mean}");
                assert!(across < other_across, "{count}: {across} against {other_across}");
            }
        }
    }
}
