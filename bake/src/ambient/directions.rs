//! Directions over a hemisphere, cosine-weighted, in an order that keeps what follows one another close together.
//!
//! Theory: a sequence in the unit square, carried onto the disc by Shirley and Chiu's map ("A low distortion map
//! between disk and square", *Journal of Graphics Tools* 2(3), 1997) and up onto the hemisphere, has a density that
//! falls with the cosine (Malley's method). The sequence is Sobol's first two dimensions, Owen-scrambled with one of a
//! number of seeds (Burley, "Practical hash-based Owen scrambling", *Journal of Computer Graphics Techniques* 9(4),
//! 2020): any aligned block of 2^m of its points has one in every elementary box of area 2^-m, so that the error of a
//! mean falls faster than that of independent points.
//!
//! Practice: by the same property, a block has exactly one point in each cell of the square. Sorted by cell, the rays
//! of neighbouring texels have nearly the same direction and visit the same part of the hierarchy.

use glam::{DVec3, Vec2, Vec3};
use rayon::prelude::*;
use std::f32::consts::{FRAC_PI_2, FRAC_PI_4};

/// Most rays that are sorted together.
pub(super) const BLOCK: u32 = 256;
/// Most sequences. All texels of a packet have different ones; which other texels share one is random, so that errors
/// look like noise.
const MOST_SEQUENCES: u32 = 64;
/// Most directions of all sequences together: with many rays there are fewer sequences.
const MOST_DIRECTIONS: u32 = 1 << 20;
/// Fewest sequences: more than a packet has texels.
const LEAST_SEQUENCES: u32 = 32;

/// Directions of several sequences, computed once.
pub(super) struct DirectionSets {
    sequences: Vec<Vec<DirectionSample>>,
}

/// A direction about a normal, and a number in [0, 1) that selects one of a texel's points.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct DirectionSample {
    /// Unit vector; z is along the normal.
    pub local: Vec3,
    pub pick: f32,
}

impl DirectionSets {
    /// `rays` of each sequence, in blocks of the given lengths, which add up to it. Each is a power of two up to
    /// [`BLOCK`] and starts at a multiple of itself; its directions are in the order of [`cell`].
    pub fn new(seed: u32, rays: u32, blocks: &[u32]) -> Self {
        let count = (MOST_DIRECTIONS / rays).clamp(LEAST_SEQUENCES, MOST_SEQUENCES);
        let sequence = |index: u32| {
            let mut directions = vec![DirectionSample::default(); rays as usize];
            let mut first = 0;
            for &length in blocks {
                sample_block(
                    seed.wrapping_mul(MOST_SEQUENCES) + index,
                    first,
                    length,
                    &mut directions[first as usize..][..length as usize],
                );
                first += length;
            }
            directions
        };
        Self { sequences: (0..count).into_par_iter().map(sequence).collect() }
    }

    /// The sequence of a texel. Consecutive seeds have different sequences.
    #[inline]
    pub fn of(&self, seed: u32) -> &[DirectionSample] {
        &self.sequences[seed as usize % self.sequences.len()]
    }
}

/// Rays `first..first + count` of a sequence, one a cell of the square, in the order of [`cell`].
pub(super) fn sample_block(seed: u32, first: u32, count: u32, directions: &mut [DirectionSample]) {
    for index in first..first + count {
        let [x, y, pick, _] = sobol_burley::sample_4d(index, 0, seed);
        let disc = on_disc(Vec2::new(x, y));
        let up = (1.0 - disc.length_squared()).max(0.0).sqrt();
        directions[cell([x, y], count) as usize] = DirectionSample { local: disc.extend(up), pick };
    }
}

/// In which of `count` cells, a power of two, a point lies: 2^a columns by 2^b rows, in boustrophedon order, so that
/// cells that follow one another touch.
fn cell([x, y]: [f32; 2], count: u32) -> u32 {
    let bits = count.ilog2();
    let (columns, rows) = (1u32 << bits.div_ceil(2), 1u32 << (bits / 2));
    let (column, row) = ((x * columns as f32) as u32, (y * rows as f32) as u32);
    row * columns + if row % 2 == 0 { column } else { columns - 1 - column }
}

/// Three axes with a normal as the last.
#[derive(Debug, Clone, Copy)]
pub(super) struct NormalFrame {
    across: [DVec3; 2],
    normal: DVec3,
}

impl NormalFrame {
    pub fn new(normal: DVec3) -> Self {
        Self { across: normal.any_orthonormal_pair().into(), normal }
    }

    /// A direction about the normal.
    #[inline]
    pub fn direction(&self, sample: &DirectionSample) -> DVec3 {
        let local = sample.local.as_dvec3();
        self.across[0] * local.x + self.across[1] * local.y + self.normal * local.z
    }
}

/// The concentric map from the unit square to the unit disc.
#[inline]
fn on_disc(point: Vec2) -> Vec2 {
    let centred = point * 2.0 - 1.0;
    if centred == Vec2::ZERO {
        return Vec2::ZERO;
    }
    let (radius, angle) = match centred.x.abs() > centred.y.abs() {
        true => (centred.x, FRAC_PI_4 * (centred.y / centred.x)),
        false => (centred.y, FRAC_PI_2 - FRAC_PI_4 * (centred.x / centred.y)),
    };
    Vec2::from_angle(angle) * radius
}

/// A few directions over the hemisphere of a normal, always the same.
pub(crate) fn hemisphere_directions(normal: DVec3, count: u32) -> impl Iterator<Item = DVec3> {
    let mut samples = vec![DirectionSample::default(); count as usize];
    sample_block(FIXED_SEED, 0, count, &mut samples);
    let frame = NormalFrame::new(normal);
    samples.into_iter().map(move |sample| frame.direction(&sample))
}

/// Seed of directions that are the same for all points.
pub(super) const FIXED_SEED: u32 = 0x5eed;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_aligned_block_has_one_point_in_every_cell() {
        for (seed, first, count) in [(0, 0, 1), (1, 0, 2), (7, 64, 64), (9, 128, 128), (123_456, 768, 256)] {
            let mut directions = vec![DirectionSample { local: Vec3::NAN, pick: 0.0 }; count as usize];
            sample_block(seed, first, count, &mut directions);
            assert!(
                directions.iter().all(|sample| sample.local.is_finite()),
                "seed {seed}, {count} points from {first}"
            );
        }
    }

    #[test]
    fn cells_that_follow_one_another_touch() {
        for count in [64u32, 128] {
            let mut centres = vec![Vec2::NAN; count as usize];
            let (columns, rows) = if count == 64 { (8, 8) } else { (16, 8) };
            for y in 0..rows {
                for x in 0..columns {
                    let centre = [(x as f32 + 0.5) / columns as f32, (y as f32 + 0.5) / rows as f32];
                    centres[cell(centre, count) as usize] = Vec2::new(x as f32, y as f32);
                }
            }
            assert!(centres.windows(2).all(|w| w[0].distance(w[1]) == 1.0));
        }
    }

    #[test]
    fn directions_are_unit_and_as_dense_as_the_cosine() {
        let normal = DVec3::new(0.3, -0.5, 0.2).normalize();
        let frame = NormalFrame::new(normal);
        let mut directions = vec![DirectionSample::default(); 256];
        sample_block(5, 0, 256, &mut directions);
        let found: Vec<DVec3> = directions.iter().map(|sample| frame.direction(sample)).collect();
        assert!(found.iter().all(|d| (d.length() - 1.0).abs() < 1e-6 && d.dot(normal) >= 0.0));
        // Means over a cosine-weighted hemisphere: cos is 2/3, cos^2 is 1/2.
        let mean = |f: &dyn Fn(f64) -> f64| found.iter().map(|d| f(d.dot(normal))).sum::<f64>() / 256.0;
        assert!((mean(&|c| c) - 2.0 / 3.0).abs() < 2e-3 && (mean(&|c| c * c) - 0.5).abs() < 2e-3);
    }
}
