//! What storing lost, texel by texel, summarised for the manifest's `error`.

use crate::disk::manifest::{ErrorEntry, LossEntry};
use crate::maps::EncodeLoss;
use crate::statistics::percentile;

/// Losses of every covered texel so far.
#[derive(Debug, Default)]
pub struct LossStatistics {
    quantised_t: Distribution,
    merged_t: Distribution,
    merged_texels: u64,
}

#[derive(Debug, Default)]
struct Distribution {
    values: Vec<f32>,
    sum: f64,
    worst: f32,
    worst_at: Option<[u32; 3]>,
}

impl LossStatistics {
    /// Counts a texel, at `[page, x, y]`.
    pub fn add(&mut self, loss: EncodeLoss, at: [u32; 3]) {
        self.quantised_t.add(loss.quantised_t, at);
        self.merged_t.add(loss.cap.total_t(), at);
        self.merged_texels += u64::from(loss.cap.total_t() > 0.0);
    }

    /// The manifest's entry, for a path of this many minutes.
    pub fn finish(self, duration_min: f64) -> ErrorEntry {
        ErrorEntry {
            quantisation_min: self.quantised_t.finish(duration_min),
            merge_min: self.merged_t.finish(duration_min),
            merged_texels: self.merged_texels,
        }
    }
}

impl Distribution {
    fn add(&mut self, value: f64, at: [u32; 3]) {
        let rounded = value as f32;
        self.values.push(rounded);
        self.sum += value;
        if rounded > self.worst {
            (self.worst, self.worst_at) = (rounded, Some(at));
        }
    }

    fn finish(mut self, scale: f64) -> LossEntry {
        let Some(p99) = percentile(&mut self.values, 99, f32::total_cmp) else { return LossEntry::default() };
        LossEntry {
            mean: self.sum / self.values.len() as f64 * scale,
            p99: f64::from(p99) * scale,
            worst: f64::from(self.worst) * scale,
            worst_at: self.worst_at,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_percentile_and_worst_are_those_of_the_list() {
        let mut statistics = LossStatistics::default();
        for i in 1..=200u32 {
            statistics.add(EncodeLoss { quantised_t: f64::from(i) / 1000.0, ..EncodeLoss::default() }, [0, i, 7]);
        }
        let entry = statistics.finish(1000.0).quantisation_min;
        assert!((entry.mean - 100.5).abs() < 1e-9);
        assert!((entry.p99 - 198.0).abs() < 1e-4);
        assert!((entry.worst - 200.0).abs() < 1e-4);
        assert_eq!(entry.worst_at, Some([0, 200, 7]));
    }

    #[test]
    fn nothing_baked_lost_nothing() {
        assert_eq!(LossStatistics::default().finish(600.0), ErrorEntry::default());
    }
}
