//! Errors of interval lists and of soft visibility through the day, as path time or as visibility.

use super::report::ErrorSummary;
use crate::maps::Lane;
use crate::statistics::{self, percentile};
use crate::sun::SunPath;
use crate::visibility::Intervals;

/// Path time during which exactly one of two lists is lit.
pub(super) fn symmetric_difference_t(a: &Intervals, b: &Intervals) -> f64 {
    (a.lit_length() + b.lit_length() - 2.0 * overlap_t(a.as_slice(), b.as_slice())).max(0.0)
}

/// Path time during which both lists are lit: one walk along both.
fn overlap_t(mut a: &[[f64; 2]], mut b: &[[f64; 2]]) -> f64 {
    let mut common = 0.0;
    while let (Some(first), Some(second)) = (a.first(), b.first()) {
        common += (first[1].min(second[1]) - first[0].max(second[0])).max(0.0);
        if first[1] < second[1] {
            a = &a[1..];
        } else {
            b = &b[1..];
        }
    }
    common
}

/// Share of a lane that is lit at `t`: the twin of [`crate::maps::soft_visibility`], on times that were never stored.
pub(super) fn soft(lit: &Intervals, t: f64, width_t: f64) -> f64 {
    if width_t <= 0.0 {
        return f64::from(u8::from(lit.contains(t)));
    }
    let window = [t - 0.5 * width_t, t + 0.5 * width_t];
    let within = lit.as_slice().iter().map(|[start, end]| (end.min(window[1]) - start.max(window[0])).max(0.0));
    (within.sum::<f64>() / width_t).min(1.0)
}

/// Moments of the day at which soft visibility is compared. The sun takes two minutes for its own width; a summer day's
/// moments are less than one apart.
pub(super) const MOMENTS: usize = 1024;

/// The moments of a point as path times. Each point has its own `start` in [0, 1), so that no error falls between the
/// moments of all points.
pub(super) fn moments(start: f64) -> impl Iterator<Item = f64> {
    (0..MOMENTS).map(move |k| (k as f64 + start) / MOMENTS as f64)
}

/// Visible share of the disc at each moment, from the lit intervals of each lane.
pub(super) fn disc_visibility(answers: &[Intervals], lanes: &[Lane], path: &SunPath, start: f64) -> Vec<f32> {
    let chords: Vec<f64> = lanes.iter().map(|lane| lane.chord(path.angular_radius_rad)).collect();
    let at = |t: f64| {
        let width_t = path.width_t(t);
        let of_lanes = answers.iter().zip(lanes).zip(&chords);
        of_lanes.map(|((lit, lane), chord)| lane.weight * soft(lit, t, width_t * chord)).sum::<f64>() as f32
    };
    moments(start).map(at).collect()
}

/// Path time by which one visibility differs from the other: the mean difference over the moments.
pub(super) fn mean_difference_t(a: &[f32], b: &[f32]) -> f64 {
    statistics::mean(a.iter().zip(b).map(|(a, b)| f64::from((a - b).abs())))
}

/// Mean, root mean square, 99th percentile and largest of errors; none for an empty list.
pub(super) fn summary(mut errors: Vec<f64>) -> Option<ErrorSummary> {
    let mean = statistics::mean(errors.iter().copied());
    let rms = statistics::mean(errors.iter().map(|error| error * error)).sqrt();
    let p99 = percentile(&mut errors, 99, f64::total_cmp)?;
    let worst = errors.into_iter().max_by(f64::total_cmp)?;
    Some(ErrorSummary { mean, rms, p99, worst })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::pseudo_random;

    fn list(raw: &[[f64; 2]]) -> Intervals {
        Intervals::from_unsorted(raw.to_vec())
    }

    #[test]
    fn differences_of_lists_are_those_one_can_reckon() {
        let cases = [
            (list(&[[0.1, 0.3]]), list(&[[0.1, 0.3]]), 0.0),
            (list(&[[0.1, 0.3]]), list(&[[0.2, 0.5]]), 0.3),
            (list(&[[0.1, 0.2], [0.4, 0.6]]), list(&[[0.1, 0.6]]), 0.2),
            (list(&[]), list(&[[0.25, 0.5]]), 0.25),
            (Intervals::always(), Intervals::never(), 1.0),
            (list(&[[0.0, 0.1], [0.2, 0.3], [0.9, 1.0]]), list(&[[0.05, 0.25], [0.95, 1.0]]), 0.05 + 0.1 + 0.05 + 0.05),
        ];
        for (a, b, expected) in cases {
            for (a, b) in [(&a, &b), (&b, &a)] {
                assert!((symmetric_difference_t(a, b) - expected).abs() < 1e-12, "{a:?} {b:?}: {expected}");
            }
        }
    }

    #[test]
    fn one_walk_finds_what_intersecting_does() {
        let mut state = 9;
        let mut random = || {
            let count = (8.0 * pseudo_random(&mut state)) as usize;
            let pairs = (0..count).map(|_| [pseudo_random(&mut state), pseudo_random(&mut state)]).collect();
            Intervals::from_unsorted(pairs)
        };
        for _ in 0..500 {
            let (a, b) = (random(), random());
            assert!((overlap_t(a.as_slice(), b.as_slice()) - a.intersection(&b).lit_length()).abs() < 1e-12);
        }
    }

    #[test]
    fn soft_light_of_an_edge_is_a_ramp_as_wide_as_the_sun() {
        let lit = list(&[[0.5, 1.0]]);
        let seen = [0.4, 0.475, 0.5, 0.525, 0.6].map(|t| soft(&lit, t, 0.1));
        for (seen, expected) in seen.iter().zip([0.0, 0.25, 0.5, 0.75, 1.0]) {
            assert!((seen - expected).abs() < 1e-12, "{seen} {expected}");
        }
        assert_eq!([soft(&lit, 0.49, 0.0), soft(&lit, 0.51, 0.0)], [0.0, 1.0]);
    }

    #[test]
    fn the_summary_is_that_of_the_list() {
        let found = summary((1..=200).rev().map(f64::from).collect()).unwrap();
        assert_eq!((found.mean, found.p99, found.worst), (100.5, 198.0, 200.0));
        assert!((found.rms - (200.0f64 * 201.0 * 401.0 / 6.0 / 200.0).sqrt()).abs() < 1e-9);
        assert_eq!(summary(Vec::new()), None);
    }
}
