//! Bias: what keeps a surface from shading itself, in metres and texels.
//!
//! A texel of a map stores one depth for a small square across the light, and receivers anywhere in that square are
//! compared with it. Four corrections make up for the difference; each is optional:
//!
//! * **Constant**: receivers are moved along the light, by metres or by a share of a texel.
//! * **Slope**: by as much as the receiver's plane rises from a texel's middle to its rim. Right for planes at any
//!   slant, but unbounded as the slant grows: light leaks through casters that are nearer than that.
//! * **Normal offset** (Holbert, "Saying goodbye to shadow acne", GDC 2011): receivers are moved along their normals,
//!   by the distance of the texel's farthest corner from their plane: the same gap across the light, and never more
//!   than a texel.
//! * **Receiver plane** (Isidoro, "Shadow mapping: GPU-based tips and techniques", GDC 2006): each texel is compared
//!   with the receiver's plane at that texel, so that wide filters need no more bias than narrow ones. In a concave
//!   corner that faces the light a plane continues behind the other wall, and the filter darkens both near the corner.
//!   Where the sun grazes, a plane leaves its surface within a texel: there receivers are offset along their normals
//!   instead.
//!
//! A small bias for rounding and for the raster's own grid is always added: a 128th of a texel, a 256th of a pixel, and
//! some steps of `f32`.

use std::collections::BTreeSet;
use std::fmt;
use std::str::FromStr;

/// Corrections for a texel's size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bias {
    /// Metres along the light. 0 is none.
    pub constant_m: f64,
    /// Texels along the light. 0 is none.
    pub constant_texels: f64,
    /// A factor for the rise of the receiver's plane over a filter's reach. 0 is none, 1 is right for planes.
    pub slope: f64,
    /// A factor for the distance of the corner of the filter's reach from the receiver's plane. 0 is none, 1 is right
    /// for planes.
    pub normal: f64,
    /// Whether texels are compared with the receiver's plane where they lie.
    pub has_plane: bool,
}

impl Bias {
    /// Only the bias for rounding.
    pub const NONE: Self = Self { constant_m: 0.0, constant_texels: 0.0, slope: 0.0, normal: 0.0, has_plane: false };
    /// Needs no tuning where the shader filters.
    pub const RECOMMENDED: Self = Self { constant_texels: 0.5, has_plane: true, ..Self::NONE };
    /// Needs no tuning where a sampler compares several texels with one depth.
    pub const SAMPLED: Self = Self { constant_texels: 0.5, normal: 1.0, ..Self::NONE };
    /// The classic bias: one number.
    pub const CONSTANT: Self = Self { constant_texels: 2.0, ..Self::NONE };
}

/// Why a bias cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{part}` is not a bias: give none alone, or each at most once constant:METRES (to 1000000), texels:N, slope[:N], \
     normal[:N] and plane, N from 0 to 100, with commas between them"
)]
pub struct BiasError {
    part: String,
}

impl FromStr for Bias {
    type Err = BiasError;

    fn from_str(text: &str) -> Result<Self, BiasError> {
        if text == "none" {
            return Ok(Self::NONE);
        }
        let (mut bias, mut named) = (Self::NONE, BTreeSet::new());
        for part in text.split(',') {
            let wrong = || BiasError { part: part.to_owned() };
            let (name, value) = part.split_once(':').map_or((part, None), |(name, value)| (name, Some(value)));
            let number = |most: f64, otherwise: Option<f64>| match value {
                None => otherwise.ok_or_else(wrong),
                Some(value) => value.parse().ok().filter(|n: &f64| (0.0..=most).contains(n)).ok_or_else(wrong),
            };
            if !named.insert(name) {
                return Err(wrong());
            }
            match name {
                "constant" => bias.constant_m = number(1e6, None)?,
                "texels" => bias.constant_texels = number(100.0, None)?,
                "slope" => bias.slope = number(100.0, Some(1.0))?,
                "normal" => bias.normal = number(100.0, Some(1.0))?,
                "plane" if value.is_none() => bias.has_plane = true,
                _ => return Err(wrong()),
            }
        }
        Ok(bias)
    }
}

impl fmt::Display for Bias {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let numbers = [
            ("constant", self.constant_m),
            ("texels", self.constant_texels),
            ("slope", self.slope),
            ("normal", self.normal),
        ];
        let mut parts: Vec<String> =
            numbers.iter().filter(|(_, n)| *n != 0.0).map(|(name, n)| format!("{name}:{n}")).collect();
        parts.extend(self.has_plane.then(|| "plane".to_owned()));
        f.write_str(&if parts.is_empty() { "none".to_owned() } else { parts.join(",") })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_again() {
        for bias in [
            Bias::NONE,
            Bias::RECOMMENDED,
            Bias::SAMPLED,
            Bias::CONSTANT,
            Bias { constant_m: 0.02, slope: 1.5, ..Bias::NONE },
        ] {
            assert_eq!(bias.to_string().parse(), Ok(bias));
        }
        assert_eq!("slope,plane".parse(), Ok(Bias { slope: 1.0, has_plane: true, ..Bias::NONE }));
    }

    #[test]
    fn what_is_no_bias_is_refused() {
        for bad in [
            "",
            "constant",
            "constant:-1",
            "slope:x",
            "plane:1",
            "none,plane",
            "normal:1e9",
            "normal:NaN",
            "plane,plane",
        ] {
            assert!(bad.parse::<Bias>().is_err(), "{bad}");
        }
    }
}
