//! What of an arc is still lit: a list of gaps that occluders eat into.

use smallvec::SmallVec;

/// Gaps narrower than this, in diamond angle, are closed: they last under a hundredth of a millisecond of a day and come
/// of two occluders that meet without sharing an edge.
const LEAST_GAP: f64 = 1e-10;

/// Disjoint spans of diamond angle, ascending, none of them empty. Few, as a rule: they are held in place.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Gaps(SmallVec<[[f64; 2]; 4]>);

impl Gaps {
    /// What two lists of ascending, disjoint spans have in common.
    pub fn of_both(some: &[[f64; 2]], others: &[[f64; 2]]) -> Self {
        let mut both = Self::default();
        for a in some {
            for b in others {
                let span = [a[0].max(b[0]), a[1].min(b[1])];
                if span[0] < span[1] {
                    both.0.push(span);
                }
            }
        }
        both
    }

    /// From spans in any order.
    pub fn from_unsorted(spans: &mut [[f64; 2]]) -> Self {
        spans.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mut joined = Self::default();
        spans.iter().for_each(|&span| joined.append(span));
        joined
    }

    /// Adds a span that starts no earlier than any before it.
    fn append(&mut self, [start, end]: [f64; 2]) {
        match self.0.last_mut() {
            Some(last) if start <= last[1] => last[1] = last[1].max(end),
            _ => self.0.push([start, end]),
        }
    }

    pub fn as_slice(&self) -> &[[f64; 2]] {
        &self.0
    }

    #[inline]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Takes a span out; returns how much that closed.
    #[inline]
    pub fn close(&mut self, [start, end]: [f64; 2]) -> f64 {
        let mut closed = 0.0;
        let mut index = 0;
        while index < self.0.len() {
            let gap = self.0[index];
            if gap[0] >= end {
                break;
            }
            if gap[1] <= start {
                index += 1;
                continue;
            }
            closed += gap[1].min(end) - gap[0].max(start);
            let keeps = [start - gap[0] > LEAST_GAP, gap[1] - end > LEAST_GAP];
            match keeps {
                [false, false] => {
                    self.0.remove(index);
                    continue;
                }
                [true, false] => self.0[index][1] = start,
                [false, true] => self.0[index][0] = end,
                [true, true] => {
                    self.0[index][1] = start;
                    self.0.insert(index + 1, [end, gap[1]]);
                    index += 1;
                }
            }
            index += 1;
        }
        closed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn closed(spans: &[[f64; 2]]) -> Gaps {
        let mut gaps = Gaps::from_unsorted(&mut [[-1.0, 0.0], [0.5, 1.0]]);
        spans.iter().for_each(|span| {
            gaps.close(*span);
        });
        gaps
    }

    #[test]
    fn spans_trim_split_and_remove_gaps() {
        assert_eq!(closed(&[[-0.6, -0.4]]).as_slice(), [[-1.0, -0.6], [-0.4, 0.0], [0.5, 1.0]]);
        assert_eq!(closed(&[[-0.5, 0.7]]).as_slice(), [[-1.0, -0.5], [0.7, 1.0]]);
        assert_eq!(closed(&[[0.1, 0.4], [1.0, 2.0], [-3.0, -1.0]]).as_slice(), [[-1.0, 0.0], [0.5, 1.0]]);
        assert!(closed(&[[-2.0, 2.0]]).is_empty());
    }

    #[test]
    fn spans_that_touch_leave_nothing_between() {
        assert!(closed(&[[0.5, 0.6], [0.6, 0.75], [0.75, 1.0], [-1.0, 0.0]]).is_empty());
        assert!(closed(&[[0.5, 0.6], [0.6 + 1e-12, 1.0], [-1.0, 0.0]]).is_empty());
    }

    #[test]
    fn what_was_closed_is_what_is_missing() {
        let mut gaps = Gaps::from_unsorted(&mut [[0.0, 1.0]]);
        assert!((gaps.close([0.25, 0.5]) - 0.25).abs() < 1e-15);
        assert!((gaps.close([0.0, 0.75]) - 0.5).abs() < 1e-15);
        assert_eq!(gaps.close([0.0, 0.75]), 0.0);
    }
}
