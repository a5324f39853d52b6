//! Maps of 16 bits converted to 8 bits: the same times, rounded again.
//!
//! A code of 16 bits is 257 codes of 8. An edge that lies within a 514th of a code of the middle between two may be
//! rounded to the other one than it would have been at first; all others are as if they had been baked with 8 bits.

use super::{Bits, LayerMaps, PageMaps};

/// Codes of 16 bits in one of 8.
const CODES: u16 = 257;

impl PageMaps {
    /// The page with codes of 8 bits, if its own have 16; else itself. Ambient light stays as it is.
    pub fn with_eight_bits(mut self, bits: Bits) -> Self {
        if bits == Bits::Sixteen {
            self.lanes.iter_mut().flat_map(|lane| &mut lane.layers).for_each(requantise);
            self.lamp.iter_mut().flatten().for_each(requantise);
            // Their times have 16 bits.
            self.tracks = None;
        }
        self
    }
}

/// An unused slot stays one: its rise is the largest code, its fall 0.
fn requantise(layer: &mut LayerMaps) {
    let codes = layer.rise.iter_mut().chain(&mut layer.fall).flatten();
    // Computed within 16 bits: adding half a step to the largest code would overflow.
    codes.for_each(|code| *code = *code / CODES + u16::from(*code % CODES > CODES / 2));
}

#[cfg(test)]
mod tests {
    use super::super::{Lane, LaneMaps, PageEncoder};
    use super::*;
    use crate::visibility::Intervals;

    /// A page of one texel a list.
    fn page(bits: Bits, lists: &[Vec<[f64; 2]>]) -> PageMaps {
        let mut encoder = PageEncoder::new(lists.len(), bits, 4);
        for (texel, list) in lists.iter().enumerate() {
            encoder.set(texel, &Intervals::from_unsorted(list.clone()));
        }
        let lanes = vec![LaneMaps { lane: Lane::CENTRE, layers: encoder.finish() }];
        PageMaps { width: lists.len() as u32, height: 1, lanes, lamp: None, ambient: None, walls: None, tracks: None }
    }

    #[test]
    fn converted_maps_are_those_of_a_bake_with_8_bits() {
        // Edges at steps that no code has.
        let list = |i: usize| {
            let start = 0.6 * (i as f64 * 0.618_034).fract();
            vec![[start, start + 0.1], [start + 0.2, start + 0.2 + 0.15 * (i as f64 * 0.754_878).fract() + 0.01]]
        };
        let lists: Vec<_> = (0..4000).map(list).collect();
        let [from_sixteen, eight] = [
            page(Bits::Sixteen, &lists).with_eight_bits(Bits::Sixteen),
            page(Bits::Eight, &lists).with_eight_bits(Bits::Eight),
        ];
        let pairs = from_sixteen.lanes[0].layers[0].rise.iter().zip(&eight.lanes[0].layers[0].rise);
        let falls = from_sixteen.lanes[0].layers[0].fall.iter().zip(&eight.lanes[0].layers[0].fall);
        let steps: Vec<u16> = pairs.chain(falls).flat_map(|(a, b)| [0, 1, 2, 3].map(|c| a[c].abs_diff(b[c]))).collect();
        let moved = steps.iter().filter(|&&step| step > 0).count();
        assert!(steps.iter().all(|&step| step <= 1) && moved < steps.len() / 200, "{moved} of {}", steps.len());
    }

    #[test]
    fn unused_slots_and_whole_days_stay_so() {
        let maps = page(Bits::Sixteen, &[vec![], vec![[0.0, 1.0]]]).with_eight_bits(Bits::Sixteen);
        let layer = &maps.lanes[0].layers[0];
        assert_eq!((layer.rise[0], layer.fall[0]), ([255; 4], [0; 4]));
        assert_eq!((layer.rise[1][0], layer.fall[1][0]), (0, 255));
    }
}
