//! Encoding intervals, with the losses.

use super::{Bits, CapLoss, LayerMaps, fit_to_cap};
use crate::visibility::Intervals;

/// What storing a texel's intervals lost, in path time.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct EncodeLoss {
    /// By having fewer slots than intervals.
    pub cap: CapLoss,
    /// By rounding edges to codes: the sum of how far each edge moved.
    pub quantised_t: f64,
}

impl EncodeLoss {
    /// Adds the loss of a lane of this weight.
    pub fn add_lane(&mut self, lane: &Self, weight: f64) {
        self.cap.lit_in_error_t += weight * lane.cap.lit_in_error_t;
        self.cap.dark_in_error_t += weight * lane.cap.dark_in_error_t;
        self.quantised_t += weight * lane.quantised_t;
    }
}

/// Collects the codes of a page, texel by texel, adding layers as texels need them.
#[derive(Debug, Clone)]
pub struct PageEncoder {
    texel_count: usize,
    bits: Bits,
    layer_cap: usize,
    layers: Vec<LayerMaps>,
}

impl PageEncoder {
    /// An empty page that may grow to `layer_cap` layers of four intervals.
    pub fn new(texel_count: usize, bits: Bits, layer_cap: usize) -> Self {
        Self { texel_count, bits, layer_cap, layers: Vec::new() }
    }

    /// Stores one texel's intervals.
    pub fn set(&mut self, texel: usize, intervals: &Intervals) -> EncodeLoss {
        let (fitted, cap) = fit_to_cap(intervals, 4 * self.layer_cap);
        let mut loss = EncodeLoss { cap, quantised_t: 0.0 };
        let mut slot = 0;
        for &[start, end] in fitted.as_slice() {
            let (rise, fall) = (self.bits.encode(start), self.bits.encode(end));
            if rise >= fall {
                loss.quantised_t += end - start;
                continue;
            }
            loss.quantised_t += (self.bits.decode(rise) - start).abs() + (self.bits.decode(fall) - end).abs();
            self.put(texel, slot, rise, fall);
            slot += 1;
        }
        loss
    }

    fn put(&mut self, texel: usize, slot: usize, rise: u16, fall: u16) {
        let layer = slot / 4;
        if layer == self.layers.len() {
            self.layers.push(LayerMaps::unlit(self.texel_count, self.bits));
        }
        self.layers[layer].rise[texel][slot % 4] = rise;
        self.layers[layer].fall[texel][slot % 4] = fall;
    }

    /// Gives `texel` the codes of `source`: a gutter.
    pub fn copy(&mut self, texel: usize, source: usize) {
        for layer in &mut self.layers {
            layer.rise[texel] = layer.rise[source];
            layer.fall[texel] = layer.fall[source];
        }
    }

    /// The layers, as many as were needed.
    pub fn finish(self) -> Vec<LayerMaps> {
        self.layers
    }
}

#[cfg(test)]
mod tests {
    use super::super::stored_intervals;
    use super::*;

    fn through(bits: Bits, raw: &[[f64; 2]]) -> (Vec<[f64; 2]>, EncodeLoss) {
        let mut page = PageEncoder::new(1, bits, 4);
        let loss = page.set(0, &Intervals::from_unsorted(raw.to_vec()));
        (stored_intervals(&page.finish(), 0, bits), loss)
    }

    /// B15.
    #[test]
    fn a_texel_lit_all_day_and_one_never_lit_survive() {
        for bits in [Bits::Eight, Bits::Sixteen] {
            assert_eq!(through(bits, &[[0.0, 1.0]]), (vec![[0.0, 1.0]], EncodeLoss::default()));
            assert_eq!(through(bits, &[]), (vec![], EncodeLoss::default()));
        }
    }

    #[test]
    fn edges_move_by_half_a_code_at_most() {
        for bits in [Bits::Eight, Bits::Sixteen] {
            let half_step = 0.5 / f64::from(bits.max_code());
            for i in 0..1000 {
                let start = f64::from(i) / 2000.0;
                let (stored, _) = through(bits, &[[start, start + 0.4]]);
                assert!((stored[0][0] - start).abs() <= half_step * (1.0 + 1e-9));
                assert!((stored[0][1] - start - 0.4).abs() <= half_step * (1.0 + 1e-9));
            }
        }
    }

    /// B15.
    #[test]
    fn light_shorter_than_a_code_is_lost_and_accounted_for() {
        let (stored, loss) = through(Bits::Eight, &[[0.5001, 0.5002]]);
        assert!(stored.is_empty());
        assert!((loss.quantised_t - 0.0001).abs() < 1e-12);
    }

    /// B15.
    #[test]
    fn a_shadow_shorter_than_a_code_leaves_the_light_whole() {
        let mut page = PageEncoder::new(1, Bits::Eight, 1);
        let loss = page.set(0, &Intervals::from_unsorted(vec![[0.0, 0.5], [0.5001, 1.0]]));
        let layers = page.finish();
        for t in [0.2f32, 0.5, 0.50005, 0.8] {
            let seen = super::super::soft_visibility(&layers, 0, Bits::Eight, t, 0.01);
            assert!((seen - 1.0).abs() < 1e-5, "{seen} at {t}");
        }
        assert!(loss.quantised_t > 0.0 && loss.quantised_t < 1.0 / 255.0);
    }

    #[test]
    fn layers_grow_with_the_busiest_texel_only() {
        let mut page = PageEncoder::new(2, Bits::Sixteen, 4);
        page.set(0, &Intervals::always());
        assert_eq!(page.layers.len(), 1);
        let fence: Vec<_> = (0..9).map(|i| [f64::from(i) / 10.0, f64::from(i) / 10.0 + 0.05]).collect();
        page.set(1, &Intervals::from_unsorted(fence));
        let layers = page.finish();
        assert_eq!(layers.len(), 3);
        assert_eq!(stored_intervals(&layers, 0, Bits::Sixteen), vec![[0.0, 1.0]]);
        assert_eq!(stored_intervals(&layers, 1, Bits::Sixteen).len(), 9);
    }
}
