//! Ambient light as it is stored.
//!
//! Ambient visibility is a code of 16 bits: 0 is 0, 65535 is 1. Numbers between -1 and 1 (bent normals, sky
//! coefficients) have zero in the middle: a code q means `(q - 32768) / 32767`, so that zero itself is stored exactly.

use super::Bits;
use crate::ambient::{AmbientPage, AmbientPlanes};

/// Ambient light of a page.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AmbientMaps {
    /// Of fronts.
    pub front: AmbientSide,
    /// Of backs, where some texel of the page has two sides; single-sided texels hold their front's.
    pub back: Option<AmbientSide>,
}

/// Ambient light of one side of a page's surfaces: row order, one entry a texel.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct AmbientSide {
    /// Codes of ambient visibility.
    pub visibility: Vec<u16>,
    /// Bent normals, world space, if the set has them.
    pub bent: Option<Vec<[u16; 3]>>,
    /// Sky visibility in spherical harmonics ([`crate::ambient::harmonics`]), if the set has it.
    pub sky: Option<Vec<[u16; 9]>>,
}

impl AmbientMaps {
    /// The codes of a page's numbers.
    pub fn of(page: &AmbientPage) -> Self {
        Self { front: AmbientSide::of(&page.front), back: page.back.as_ref().map(AmbientSide::of) }
    }

    /// The same with ambient visibility as a texture of `bits` keeps it. Other numbers always have 16 bits.
    pub fn rounded_to(mut self, bits: Bits) -> Self {
        if bits == Bits::Eight {
            let sides = std::iter::once(&mut self.front).chain(&mut self.back);
            sides
                .flat_map(|side| &mut side.visibility)
                .for_each(|code| *code = u16::from(in_8_bits(*code)) * CODES_OF_8_BITS);
        }
        self
    }
}

impl AmbientSide {
    fn of(planes: &AmbientPlanes) -> Self {
        fn codes<const N: usize>(planes: &[Vec<f32>]) -> Option<Vec<[u16; N]>> {
            let count = planes.first()?.len();
            Some((0..count).map(|texel| std::array::from_fn(|k| encode_signed(planes[k][texel]))).collect())
        }
        Self {
            visibility: planes.visibility.iter().map(|&share| encode_share(share)).collect(),
            bent: codes(&planes.bent),
            sky: codes(&planes.sky),
        }
    }
}

/// Codes of 16 bits in one of 8.
const CODES_OF_8_BITS: u16 = 257;

/// The code of a number between 0 and 1.
pub fn encode_share(share: f32) -> u16 {
    (share.clamp(0.0, 1.0) * 65_535.0).round() as u16
}

/// The number between 0 and 1 that a code means.
pub fn decode_share(code: u16) -> f32 {
    f32::from(code) / 65_535.0
}

/// The code of a number between -1 and 1.
pub fn encode_signed(x: f32) -> u16 {
    ((x.clamp(-1.0, 1.0) * 32_767.0).round() as i32 + 32_768) as u16
}

/// The number between -1 and 1 that a code means.
pub fn decode_signed(code: u16) -> f32 {
    (f32::from(code) - 32_768.0) / 32_767.0
}

/// A code of 16 bits as the nearest of 8.
pub(crate) fn in_8_bits(code: u16) -> u8 {
    ((u32::from(code) * 255 + 32_767) / 65_535) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_survive_to_half_a_code() {
        for i in -1000..=1000 {
            let x = i as f32 / 1000.0;
            assert!((decode_signed(encode_signed(x)) - x).abs() <= 0.5 / 32_767.0 + 1e-7);
            assert!((decode_share(encode_share(x.abs())) - x.abs()).abs() <= 0.5 / 65_535.0 + 1e-7);
        }
        assert_eq!([-1.0, 0.0, 1.0].map(|x| decode_signed(encode_signed(x))), [-1.0, 0.0, 1.0]);
        assert_eq!([f32::NAN, 2.0].map(encode_share), [0, 65_535]);
    }

    #[test]
    fn codes_of_16_bits_round_to_the_nearest_of_8() {
        assert_eq!([0, 65_535, 257, 128, 129, 32_768].map(in_8_bits), [0, 255, 1, 0, 1, 128]);
    }

    #[test]
    fn rounding_to_8_bits_twice_is_rounding_once() {
        let all = AmbientSide { visibility: (0..=u16::MAX).collect(), ..AmbientSide::default() };
        let once = AmbientMaps { front: all, back: None }.rounded_to(Bits::Eight);
        assert!(
            (0..=u16::MAX).zip(&once.front.visibility).all(|(code, &rounded)| in_8_bits(code) == in_8_bits(rounded))
        );
        assert_eq!(once.clone().rounded_to(Bits::Eight), once);
    }
}
