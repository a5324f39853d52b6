//! Mean and percentile of a list, defined once for every report.

use std::cmp::Ordering;

/// The arithmetic mean; 0 for an empty list.
pub fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len().max(1);
    values.sum::<f64>() / count as f64
}

/// The smallest value that `percent` in a hundred do not exceed (nearest rank); none for an empty list. Reorders the
/// list.
pub fn percentile<T: Copy>(values: &mut [T], percent: usize, order: impl FnMut(&T, &T) -> Ordering) -> Option<T> {
    let rank = (values.len() * percent).div_ceil(100).clamp(1, values.len().max(1));
    let is_empty = values.is_empty();
    (!is_empty).then(|| *values.select_nth_unstable_by(rank - 1, order).1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_are_values_of_the_list() {
        let mut values: Vec<f64> = (1..=200).rev().map(f64::from).collect();
        let at = |values: &mut [f64], percent| percentile(values, percent, f64::total_cmp);
        assert_eq!([0, 50, 99, 100].map(|percent| at(&mut values, percent)), [1.0, 100.0, 198.0, 200.0].map(Some));
        assert_eq!(at(&mut [7.0], 99), Some(7.0));
        assert_eq!(at(&mut [], 99), None);
    }

    #[test]
    fn the_mean_of_nothing_is_zero() {
        assert_eq!(mean([1.0, 2.0, 6.0].into_iter()), 3.0);
        assert_eq!(mean([].into_iter()), 0.0);
    }
}
