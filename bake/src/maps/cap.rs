//! More intervals than slots: the list of at most `cap` intervals that is wrong for the shortest time.
//!
//! Walk the path's alternating segments, gap, lit, gap, lit, ..., and decide for each whether it is stored as lit.
//! Storing a gap as lit costs its length, storing a lit segment as dark costs its length, and starting an interval uses
//! a slot. A table over (slots used, lit or not) finds the least cost exactly, in segments times slots.

use crate::visibility::Intervals;

/// Path time that is stored wrongly because a texel had more intervals than slots.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct CapLoss {
    /// Path time that is dark and stored as lit.
    pub lit_in_error_t: f64,
    /// Path time that is lit and stored as dark.
    pub dark_in_error_t: f64,
}

impl CapLoss {
    /// Path time that is stored wrongly.
    pub fn total_t(&self) -> f64 {
        self.lit_in_error_t + self.dark_in_error_t
    }
}

/// The list of at most `cap` intervals that differs from `intervals` for the least time. Its ends are ends of the
/// original's intervals. If the list fits it is unchanged, without loss.
pub fn fit_to_cap(intervals: &Intervals, cap: usize) -> (Intervals, CapLoss) {
    let lit = intervals.as_slice();
    if lit.len() <= cap {
        return (intervals.clone(), CapLoss::default());
    }
    let fitted = if cap == 0 { Vec::new() } else { choose(lit, cap) };
    let fitted = Intervals::from_unsorted(fitted);
    let kept_t = intervals.intersection(&fitted).lit_length();
    let loss =
        CapLoss { lit_in_error_t: fitted.lit_length() - kept_t, dark_in_error_t: intervals.lit_length() - kept_t };
    (fitted, loss)
}

/// How a lit segment is stored.
#[derive(Clone, Copy, PartialEq)]
enum Step {
    /// The segment is stored as dark.
    Skip,
    /// An interval starts with this segment.
    Open,
    /// The interval of the previous segment continues through the gap between.
    Extend,
}

/// Dynamic programme over lit segments. `cost[used][on]`: least cost so far, with `used` slots, where the stored list
/// is lit (`on`) at the end of the segment or not.
fn choose(lit: &[[f64; 2]], cap: usize) -> Vec<[f64; 2]> {
    let mut cost = vec![[f64::INFINITY; 2]; cap + 1];
    cost[0][0] = 0.0;
    let mut steps: Vec<Vec<[(Step, usize); 2]>> = Vec::with_capacity(lit.len());
    for (i, &[start, end]) in lit.iter().enumerate() {
        let gap = if i == 0 { f64::INFINITY } else { start - lit[i - 1][1] };
        let mut next = vec![[f64::INFINITY; 2]; cap + 1];
        let mut step = vec![[(Step::Skip, 0); 2]; cap + 1];
        for used in 0..=cap {
            let (from, least) = if cost[used][0] <= cost[used][1] { (0, cost[used][0]) } else { (1, cost[used][1]) };
            next[used][0] = least + (end - start);
            step[used][0] = (Step::Skip, from);
            let extend = cost[used][1] + gap;
            let (open_from, open) = match used.checked_sub(1).map(|u| cost[u]) {
                Some([off, on]) if on < off => (1, on),
                Some([off, _]) => (0, off),
                None => (0, f64::INFINITY),
            };
            (next[used][1], step[used][1]) =
                if extend <= open { (extend, (Step::Extend, 1)) } else { (open, (Step::Open, open_from)) };
        }
        cost = next;
        steps.push(step);
    }
    trace_back(lit, &cost, &steps)
}

fn trace_back(lit: &[[f64; 2]], cost: &[[f64; 2]], steps: &[Vec<[(Step, usize); 2]>]) -> Vec<[f64; 2]> {
    let states = (0..cost.len()).flat_map(|used| [(used, 0), (used, 1)]);
    let (mut used, mut on) = states.min_by(|a, b| cost[a.0][a.1].total_cmp(&cost[b.0][b.1])).unwrap_or((0, 0));
    let mut chosen = Vec::new();
    let mut end = 0.0;
    for i in (0..lit.len()).rev() {
        let (step, from) = steps[i][used][on];
        if on == 1 && (i + 1 == lit.len() || end == 0.0) {
            end = lit[i][1];
        }
        if step == Step::Open {
            chosen.push([lit[i][0], end]);
            end = 0.0;
            used -= 1;
        }
        on = from;
    }
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::pseudo_random;

    /// Every way to store `lit` with at most `cap` intervals whose ends are ends of its own: the least error.
    fn least_error_by_trying_all(lit: &[[f64; 2]], cap: usize) -> f64 {
        let segment_count = 2 * lit.len() - 1;
        let length = |s: usize| {
            if s.is_multiple_of(2) { lit[s / 2][1] - lit[s / 2][0] } else { lit[s / 2 + 1][0] - lit[s / 2][1] }
        };
        (0u32..1 << segment_count)
            .filter(|mask| (mask & !(mask << 1)).count_ones() as usize <= cap)
            .map(|mask| (0..segment_count).filter(|&s| (mask >> s & 1 == 1) != (s % 2 == 0)).map(length).sum())
            .fold(f64::INFINITY, f64::min)
    }

    /// B14.
    #[test]
    fn the_loss_at_the_cap_is_the_smallest_possible() {
        let mut state = 1;
        for case in 0..400 {
            let count = 2 + case % 6;
            let mut ends: Vec<f64> = (0..2 * count).map(|_| pseudo_random(&mut state)).collect();
            ends.sort_by(f64::total_cmp);
            let intervals = Intervals::from_unsorted(ends.chunks(2).map(|c| [c[0], c[1]]).collect());
            for cap in 1..count {
                let (fitted, loss) = fit_to_cap(&intervals, cap);
                assert!(fitted.as_slice().len() <= cap);
                let least = least_error_by_trying_all(intervals.as_slice(), cap);
                assert!((loss.total_t() - least).abs() < 1e-12, "case {case}, cap {cap}: {loss:?} against {least}");
            }
        }
    }

    #[test]
    fn what_fits_is_left_alone() {
        let intervals = Intervals::from_unsorted(vec![[0.1, 0.2], [0.3, 0.4]]);
        assert_eq!(fit_to_cap(&intervals, 2), (intervals, CapLoss::default()));
    }

    #[test]
    fn a_cap_of_zero_loses_all_the_light() {
        let intervals = Intervals::from_unsorted(vec![[0.25, 0.5]]);
        let (fitted, loss) = fit_to_cap(&intervals, 0);
        assert_eq!(fitted, Intervals::never());
        assert_eq!(loss.dark_in_error_t, 0.25);
    }
}
