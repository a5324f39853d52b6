//! Minutes lost, texel by texel, written beside a page's maps if asked for.
//!
//! The picture shows the sum of both losses with the colour map [`heat`] and a square root: most texels lose seconds or
//! nothing and a few lose an hour, and the root makes both visible. Its brightest colour stands for a round number of
//! minutes, so that pages and bakes of one scene mostly have the same scale. The numbers are written as well.

use crate::heat::heat;
use crate::maps::EncodeLoss;

/// The value of a texel that is not covered.
const UNCOVERED: [f32; 2] = [f32::NAN; 2];

/// What storing a page lost, in minutes. Texels outside charts, including gutters, are not covered.
#[derive(Debug, Clone)]
pub struct LossMap {
    /// In texels.
    pub width: u32,
    /// In texels.
    pub height: u32,
    /// By too few layers, and by rounding.
    minutes: Vec<[f32; 2]>,
}

impl LossMap {
    /// A page without a covered texel.
    pub fn new(width: u32, height: u32) -> Self {
        Self { width, height, minutes: vec![UNCOVERED; width as usize * height as usize] }
    }

    /// Adds the loss of a texel for a light whose path takes this many minutes.
    pub fn add(&mut self, texel: usize, loss: &EncodeLoss, duration_min: f64) {
        // Rounded to f32, as the statistics in the manifest are, so that both hold the same numbers.
        let minutes = |t: f64| (f64::from(t as f32) * duration_min) as f32;
        let [layers, bits] = self.minutes[texel].map(|before| if before.is_nan() { 0.0 } else { before });
        self.minutes[texel] = [layers + minutes(loss.cap.total_t()), bits + minutes(loss.quantised_t)];
    }

    /// Minutes lost by too few layers, in row order; 0 where there is no surface.
    pub fn by_layers_min(&self) -> Vec<f32> {
        self.minutes.iter().map(|texel| texel[0].max(0.0)).collect()
    }

    /// Minutes lost by rounding, in row order; 0 where there is no surface.
    pub fn by_bits_min(&self) -> Vec<f32> {
        self.minutes.iter().map(|texel| texel[1].max(0.0)).collect()
    }

    /// What the brightest colour stands for: the worst texel's minutes, rounded up to 1, 2 or 5 times a power of ten.
    pub fn scale_max_min(&self) -> f64 {
        rounded_up(self.minutes.iter().map(|[layers, bits]| layers + bits).fold(0.0, f32::max).into())
    }

    /// The picture: opaque colours, transparent black where there is no surface.
    pub fn picture(&self) -> Vec<[u8; 4]> {
        let max_min = self.scale_max_min() as f32;
        let color = |[layers, bits]: &[f32; 2]| {
            let [r, g, b] = heat(((layers + bits) / max_min).sqrt());
            if layers.is_nan() { [0; 4] } else { [r, g, b, 255] }
        };
        self.minutes.iter().map(color).collect()
    }
}

/// The least of 1, 2 and 5 times a power of ten that is no less than `value`; 1 for what is not positive.
fn rounded_up(value: f64) -> f64 {
    if value <= 0.0 {
        return 1.0;
    }
    let decade = value.log10().floor() as i32;
    let steps = [1.0, 2.0, 5.0, 10.0]
        .map(|digit| if decade < 0 { digit / 10f64.powi(-decade) } else { digit * 10f64.powi(decade) });
    steps.into_iter().find(|step| *step >= value).unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::maps::{Bits, PageEncoder};
    use crate::visibility::Intervals;

    #[test]
    fn scales_end_at_round_numbers() {
        for (value, expected) in
            [(0.0, 1.0), (0.7, 1.0), (1.0, 1.0), (1.01, 2.0), (4.9, 5.0), (60.0, 100.0), (0.013, 0.02), (0.004, 0.005)]
        {
            assert_eq!(rounded_up(value), expected, "{value}");
        }
    }

    /// Five intervals of 80 minutes on a path of 800, 20 minutes between the last two: with one layer of four, the gap
    /// of 20 is stored as lit.
    #[test]
    fn a_texel_shows_the_minutes_that_one_layer_loses() {
        let lit = [[0.0, 80.0], [160.0, 240.0], [320.0, 400.0], [480.0, 560.0], [580.0, 660.0]];
        let lit = Intervals::from_unsorted(lit.iter().map(|ends| ends.map(|minute| minute / 800.0)).collect());
        let mut map = LossMap::new(3, 1);
        let mut encoder = PageEncoder::new(3, Bits::Sixteen, 1);
        map.add(0, &encoder.set(0, &lit), 800.0);
        map.add(1, &encoder.set(1, &Intervals::always()), 800.0);
        assert!((map.by_layers_min()[0] - 20.0).abs() < 1e-5);
        // Eight edges move by half a code at most, of 800/65535 minutes each.
        let rounding = map.by_bits_min()[0];
        assert!(rounding > 0.0 && rounding <= 8.0 * 0.5 * 800.0 / 65_535.0, "{rounding}");
        assert_eq!((map.by_layers_min()[1..].to_vec(), map.by_bits_min()[1..].to_vec()), (vec![0.0; 2], vec![0.0; 2]));
        // 20 minutes and a little: the scale ends at 50.
        assert_eq!(map.scale_max_min(), 50.0);
        let [r, g, b] = heat(((20.0 + rounding) / 50.0).sqrt());
        assert_eq!(map.picture(), [[r, g, b, 255], [16, 14, 22, 255], [0; 4]]);
    }
}
