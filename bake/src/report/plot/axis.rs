//! An axis: the mapping from values to pixels, and its tick labels.

use super::super::number::plain;

/// Pixels at the lower end of a logarithmic axis that are reserved for values of zero or less, where there are any.
const ZERO_BAND: f64 = 34.0;
/// Free space beyond the outermost values, as a share of the axis.
const ROOM: f64 = 0.07;
/// Approximate number of tick labels.
const TICKS: f64 = 6.0;

/// From values to pixels.
#[derive(Debug, Clone)]
pub(super) struct Scale {
    is_log: bool,
    /// The values at the ends, or their logarithms.
    ends: [f64; 2],
    /// The pixels of the ends.
    pixels: [f64; 2],
    /// The pixel of zero and less on a logarithmic axis, if there is any.
    pub zero_pixel: Option<f64>,
}

/// The position of a value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct AxisPosition {
    pub pixel: f64,
    /// Whether it is the band for zero and less.
    pub is_zero: bool,
}

impl Scale {
    /// An axis between two pixels that holds these values.
    pub fn new(values: impl Iterator<Item = f64>, is_log: bool, pixels: [f64; 2]) -> Self {
        let finite: Vec<f64> = values.filter(|value| value.is_finite()).collect();
        let has_zeros = is_log && finite.iter().any(|&value| value <= 0.0);
        let inwards = (pixels[1] - pixels[0]).signum();
        let start = if has_zeros { pixels[0] + ZERO_BAND * inwards } else { pixels[0] };
        let ends = if is_log { log_ends(&finite) } else { linear_ends(&finite) };
        let zero_pixel = has_zeros.then_some(pixels[0] + 0.5 * ZERO_BAND * inwards);
        Self { is_log, ends, pixels: [start, pixels[1]], zero_pixel }
    }

    /// The position of a value; none if it is not finite.
    pub fn place(&self, value: f64) -> Option<AxisPosition> {
        if !value.is_finite() {
            return None;
        }
        if self.is_log && value <= 0.0 {
            return self.zero_pixel.map(|pixel| AxisPosition { pixel, is_zero: true });
        }
        let at = if self.is_log { value.log10() } else { value };
        let share = (at - self.ends[0]) / (self.ends[1] - self.ends[0]);
        Some(AxisPosition { pixel: self.pixels[0] + share * (self.pixels[1] - self.pixels[0]), is_zero: false })
    }

    /// Tick labels with their pixels.
    pub fn ticks(&self) -> Vec<(f64, String)> {
        let values = if self.is_log { self.log_ticks() } else { linear_ticks(self.ends) };
        let tick = |value: &f64| Some((self.place(*value)?.pixel, tick_text(*value)));
        values.iter().filter_map(tick).chain(self.zero_pixel.map(|pixel| (pixel, "0".into()))).collect()
    }

    /// Powers of ten, with twos and fives between where they are few; where the axis is shorter than that, even steps.
    fn log_ticks(&self) -> Vec<f64> {
        let [low, high] = self.ends;
        let span = high - low;
        let mantissas: &[f64] = if span < 3.0 { &[1.0, 2.0, 5.0] } else { &[1.0] };
        let step = (span / (TICKS + 2.0)).ceil().max(1.0);
        let first = (low / step).floor() as i32;
        let powers = (first..=(high / step).ceil() as i32).map(|k| f64::from(k) * step);
        let values = powers.flat_map(|power| mantissas.iter().map(move |m| m * 10f64.powf(power)));
        let within: Vec<f64> = values.filter(|value| (low..=high).contains(&value.log10())).collect();
        if within.len() > 2 {
            return within;
        }
        linear_ticks(self.ends.map(|end| 10f64.powf(end))).into_iter().filter(|&value| value > 0.0).collect()
    }
}

/// Logarithms of the ends.
fn log_ends(values: &[f64]) -> [f64; 2] {
    let logs = || values.iter().filter(|&&value| value > 0.0).map(|value| value.log10());
    let (low, high) = (logs().fold(f64::INFINITY, f64::min), logs().fold(f64::NEG_INFINITY, f64::max));
    if low > high {
        return [-1.0, 1.0];
    }
    // At least a factor of two, so that noise does not look like a mountain range.
    let rect = (ROOM * (high - low)).max(0.15);
    [low - rect, high + rect]
}

/// The ends, zero among them.
fn linear_ends(values: &[f64]) -> [f64; 2] {
    let low = values.iter().copied().fold(0.0, f64::min);
    let high = values.iter().copied().fold(0.0, f64::max);
    if low == high {
        return [0.0, 1.0];
    }
    // Halves first: the whole may be too large for a number.
    let rect = 2.0 * ROOM * (0.5 * high - 0.5 * low);
    [if low < 0.0 { low - rect } else { 0.0 }, (high + rect).min(f64::MAX)]
}

/// Even steps of 1, 2 or 5 times a power of ten.
fn linear_ticks([low, high]: [f64; 2]) -> Vec<f64> {
    let rough = (high - low) / TICKS;
    let power = 10f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|m| m * power).into_iter().find(|&step| step >= rough).unwrap_or(rough);
    if !(step.is_normal() && step > 0.0) {
        return Vec::new();
    }
    let first = (low / step).ceil();
    (0..2 * TICKS as usize).map(|k| (first + k as f64) * step).filter(|value| *value <= high).collect()
}

/// The number with as few digits as possible.
fn tick_text(value: f64) -> String {
    let text = plain(value, 3);
    if text.contains('.') && !text.contains('e') {
        return text.trim_end_matches('0').trim_end_matches('.').to_owned();
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(values: &[f64], is_log: bool) -> Vec<String> {
        let scale = Scale::new(values.iter().copied(), is_log, [0.0, 500.0]);
        scale.ticks().into_iter().map(|(_, text)| text).collect()
    }

    #[test]
    fn ticks_are_plain_numbers_and_neither_few_nor_many() {
        assert_eq!(texts(&[0.0, 9.0], false), ["0", "2", "4", "6", "8"]);
        assert_eq!(texts(&[0.02, 3.0], true), ["0.02", "0.05", "0.1", "0.2", "0.5", "1", "2"]);
        assert_eq!(texts(&[1.0, 1e6], true), ["1", "10", "100", "1,000", "10,000", "100,000", "1,000,000"]);
        for values in [&[][..], &[3.3], &[1e-300, 1e300], &[2.0, 2.1], &[0.0]] {
            for is_log in [false, true] {
                let count = texts(values, is_log).len();
                assert!((2..=13).contains(&count), "{values:?}: {:?}", texts(values, is_log));
            }
        }
    }

    #[test]
    fn what_lies_on_a_logarithmic_axis_ascends_and_zero_has_a_band_below() {
        let scale = Scale::new([0.0, 1.0, 10.0].into_iter(), true, [400.0, 0.0]);
        let [zero, one, ten] = [0.0, 1.0, 10.0].map(|value| scale.place(value).unwrap());
        assert!(zero.is_zero && !one.is_zero && zero.pixel > one.pixel && one.pixel > ten.pixel && ten.pixel > 0.0);
        assert_eq!(scale.place(f64::NAN), None);
    }
}
