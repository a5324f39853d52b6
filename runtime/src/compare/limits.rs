//! Limits for errors and costs, written as `visibility=0.02` or `wrong=0.01`.

use super::report::{AboveLimit, LeftOut, LimitEntry, TechniqueEntry};
use std::str::FromStr;

/// What can be limited.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Limited {
    /// Mean error of visibility.
    Visibility,
    /// Root of the mean of its squares.
    Rms,
    /// The error that 99 in 100 pixels do not exceed.
    P99,
    /// The largest error.
    Worst,
    /// Share of pixels with an error above a half.
    Wrong,
    /// Mean error in penumbras.
    Penumbra,
    /// Mean error outside of penumbras.
    Outside,
    /// Mean visibility where the reference is dark.
    Leak,
    /// Mean shade where the reference is in full light.
    Shade,
    /// One less the structural similarity of lit pictures.
    Dissimilarity,
    /// Milliseconds a frame.
    FrameMs,
    /// MiB of memory kept from frame to frame.
    Mib,
}

impl Limited {
    const ALL: [(&'static str, Self); 12] = [
        ("visibility", Self::Visibility),
        ("rms", Self::Rms),
        ("p99", Self::P99),
        ("worst", Self::Worst),
        ("wrong", Self::Wrong),
        ("penumbra", Self::Penumbra),
        ("outside", Self::Outside),
        ("leak", Self::Leak),
        ("shade", Self::Shade),
        ("dissimilarity", Self::Dissimilarity),
        ("frame_ms", Self::FrameMs),
        ("mib", Self::Mib),
    ];

    /// A technique's value; None where no pixel was compared.
    fn of(self, technique: &TechniqueEntry) -> Option<f64> {
        let error = &technique.error;
        let is_cost = matches!(self, Self::FrameMs | Self::Mib);
        if error.pixels == 0 && !is_cost {
            return None;
        }
        Some(match self {
            Self::Visibility => error.mean,
            Self::Rms => error.rms,
            Self::P99 => error.p99,
            Self::Worst => error.worst,
            Self::Wrong => error.wrong_share,
            Self::Penumbra => return error.penumbra,
            Self::Outside => error.outside,
            Self::Leak => return error.false_light,
            Self::Shade => return error.false_shade,
            Self::Dissimilarity => 1.0 - error.ssim,
            Self::FrameMs => technique.times.frame_ms,
            Self::Mib => technique.memory_bytes as f64 / f64::from(1 << 20),
        })
    }
}

/// The most that is allowed of something.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// The number that the limit is on.
    pub what: Limited,
    /// The largest value allowed, in the unit of `what`.
    pub most: f64,
}

impl FromStr for Limit {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let known = || Limited::ALL.map(|(key, _)| key).join(", ");
        let (key, value) = text
            .split_once('=')
            .ok_or_else(|| format!("`{text}` is no limit: give KEY=NUMBER, where KEY is one of {}", known()))?;
        let found = Limited::ALL.into_iter().find(|(name, _)| *name == key.trim());
        let (_, what) = found.ok_or_else(|| format!("`{key}` cannot be limited: give one of {}", known()))?;
        let most: Option<f64> = value.trim().parse().ok().filter(|most: &f64| most.is_finite() && *most >= 0.0);
        let most = most.ok_or_else(|| format!("`{value}` is no limit for {key}: give a number from 0 up"))?;
        Ok(Self { what, most })
    }
}

impl Limit {
    /// Which techniques are above it, and of which that is unknown: those left out, and those without a compared pixel.
    /// A limit that no technique was checked against is not kept.
    pub fn check(&self, techniques: &[TechniqueEntry], left_out: &[LeftOut]) -> LimitEntry {
        let key = Limited::ALL.iter().find(|(_, what)| *what == self.what).map_or("", |(key, _)| key);
        let above = techniques.iter().filter_map(|technique| {
            let value = self.what.of(technique)?;
            (value > self.most).then(|| AboveLimit { name: technique.name.clone(), value })
        });
        let unknown = techniques.iter().filter(|technique| self.what.of(technique).is_none());
        let unchecked = unknown.map(|technique| &technique.name).chain(left_out.iter().map(|left| &left.name));
        LimitEntry {
            key: key.into(),
            limit: self.most,
            above: above.collect(),
            unchecked: unchecked.cloned().collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_read_and_what_is_none_is_refused() {
        assert_eq!("visibility=0.02".parse(), Ok(Limit { what: Limited::Visibility, most: 0.02 }));
        assert_eq!(" mib = 4".trim().parse(), Ok(Limit { what: Limited::Mib, most: 4.0 }));
        for bad in ["", "visibility", "visibility=", "visibility=-1", "visibility=NaN", "brightness=1", "=1"] {
            let message = bad.parse::<Limit>().unwrap_err();
            assert!(message.contains("give"), "{bad}: {message}");
        }
    }
}
