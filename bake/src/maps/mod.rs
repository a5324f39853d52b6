//! Maps: intervals as they are stored, four to an RGBA texel pair.
//!
//! A *layer* is a pair of RGBA textures, `rise` and `fall`; channel c of layer l holds interval 4 l + c of its texel. A
//! code q of b bits means `t = q / (2^b - 1)`. An unused slot has rise = max and fall = 0: its length is never
//! positive, so an evaluator needs no count and no branch.

mod ambient;
mod cap;
mod encode;
mod evaluate;
mod gpu_bytes;
mod lanes;
mod requantise;

pub(crate) use ambient::in_8_bits;
pub use ambient::{AmbientMaps, AmbientSide, decode_share, decode_signed, encode_share, encode_signed};
pub use cap::{CapLoss, fit_to_cap};
pub use encode::{EncodeLoss, PageEncoder};
pub(crate) use evaluate::{SHARP_REACH, edge_sample_of};
pub use evaluate::{edge_sample, hard_visibility, sharpened, soft_visibility};
pub use gpu_bytes::{AmbientTextures, GpuTexel};
pub use lanes::Lane;

use crate::tracks::PageTracks;

/// Bits of a stored time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Bits {
    /// Steps of 1/255 of the path: 3.4 minutes of a summer day.
    Eight,
    /// Steps of 1/65535 of the path: 0.8 seconds of a summer day.
    Sixteen,
}

impl Bits {
    /// The largest code, which stands for t = 1.
    pub fn max_code(self) -> u16 {
        match self {
            Self::Eight => 255,
            Self::Sixteen => 65_535,
        }
    }

    /// 8 or 16.
    pub fn count(self) -> u32 {
        match self {
            Self::Eight => 8,
            Self::Sixteen => 16,
        }
    }

    /// Bits from their number, if it is one that can be stored.
    pub fn from_count(count: u32) -> Option<Self> {
        match count {
            8 => Some(Self::Eight),
            16 => Some(Self::Sixteen),
            _ => None,
        }
    }

    /// The nearest code of a path time.
    pub fn encode(self, t: f64) -> u16 {
        (t.clamp(0.0, 1.0) * f64::from(self.max_code())).round() as u16
    }

    /// The path time that a code means.
    pub fn decode(self, code: u16) -> f64 {
        f64::from(code) / f64::from(self.max_code())
    }
}

/// Bits of the numbers in a set's textures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StoredBits {
    /// Of times.
    pub times: Bits,
    /// Of ambient visibility. Bent normals and sky coefficients always have 16.
    pub ambient: Bits,
}

/// A rise and fall pair of textures: row order, one RGBA texel an entry. Codes of either depth are held in 16 bits.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LayerMaps {
    /// Codes at which intervals start.
    pub rise: Vec<[u16; 4]>,
    /// Codes at which intervals end.
    pub fall: Vec<[u16; 4]>,
}

impl LayerMaps {
    /// A layer of which no slot is used.
    pub fn unlit(texel_count: usize, bits: Bits) -> Self {
        Self { rise: vec![[bits.max_code(); 4]; texel_count], fall: vec![[0; 4]; texel_count] }
    }
}

/// The layers of one lane on one page.
#[derive(Debug, Clone, PartialEq)]
pub struct LaneMaps {
    /// Which part of the disc.
    pub lane: Lane,
    /// As many as the page's busiest texel needs, up to the cap. Empty where no texel is ever lit.
    pub layers: Vec<LayerMaps>,
}

/// Everything stored for one atlas page.
#[derive(Debug, Clone, PartialEq)]
pub struct PageMaps {
    /// In texels.
    pub width: u32,
    /// In texels.
    pub height: u32,
    /// Empty where there is no sun in the set.
    pub lanes: Vec<LaneMaps>,
    /// When texels see the lamp, where the set has one: as many layers as the page's busiest texel needs, up to the
    /// cap.
    pub lamp: Option<Vec<LayerMaps>>,
    /// How much of the sky texels see, where the set has it.
    pub ambient: Option<AmbientMaps>,
    /// What stands on the ways from each texel to its right and its lower neighbour ([`crate::atlas::wall_code`]),
    /// where anything does.
    pub walls: Option<Vec<[u8; 2]>>,
    /// Shade of the sun occluder by occluder, along its centre, if it was asked for.
    pub tracks: Option<PageTracks>,
}

/// Lengths of the encoded intervals of a texel, for tests and for `sunbake texels`: what is stored, as times.
pub fn stored_intervals(layers: &[LayerMaps], texel: usize, bits: Bits) -> Vec<[f64; 2]> {
    let slots = layers.iter().flat_map(|layer| (0..4).map(move |c| (layer.rise[texel][c], layer.fall[texel][c])));
    slots.filter(|(rise, fall)| rise < fall).map(|(rise, fall)| [bits.decode(rise), bits.decode(fall)]).collect()
}
