//! The spans of an arc that are still lit: a list of gaps that occluders close.

/// Gaps narrower than this, in diamond angle, are closed: they last under a hundredth of a millisecond of a day and
/// come of two occluders that meet without sharing an edge.
const LEAST_GAP: f64 = 1e-10;

/// Disjoint spans of diamond angle, ascending, none of them empty. The order of occluders makes no difference: gaps
/// that become narrower than [`LEAST_GAP`] are dropped.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Gaps(Vec<[f64; 2]>);

impl Gaps {
    /// Becomes the intersection of two lists of ascending, disjoint spans.
    pub fn set_intersection(&mut self, some: &[[f64; 2]], others: &[[f64; 2]]) {
        self.0.clear();
        let pairs = some.iter().flat_map(|a| others.iter().map(move |b| [a[0].max(b[0]), a[1].min(b[1])]));
        self.0.extend(pairs.filter(|span| span[0] < span[1]));
    }

    /// Keeps what lies in ascending, disjoint spans.
    pub fn intersect(&mut self, spans: &[[f64; 2]]) {
        let gaps = std::mem::take(&mut self.0);
        self.set_intersection(&gaps, spans);
    }

    pub fn as_slice(&self) -> &[[f64; 2]] {
        &self.0
    }

    #[inline]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Removes a span. True if any of it was open.
    #[inline]
    pub fn close(&mut self, [start, end]: [f64; 2]) -> bool {
        let Some(first) = self.0.iter().position(|gap| gap[1] > start) else { return false };
        let mut index = first;
        let mut closes = false;
        while let Some(&gap) = self.0.get(index).filter(|gap| gap[0] < end) {
            closes = true;
            match [start - gap[0] > LEAST_GAP, gap[1] - end > LEAST_GAP] {
                [false, false] => {
                    self.0.remove(index);
                    continue;
                }
                [true, false] => self.0[index][1] = start,
                [false, true] => self.0[index][0] = end,
                [true, true] => {
                    self.0[index][1] = start;
                    self.0.insert(index + 1, [end, gap[1]]);
                    break;
                }
            }
            index += 1;
        }
        closes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gaps(spans: &[[f64; 2]]) -> Gaps {
        let mut gaps = Gaps::default();
        gaps.set_intersection(spans, &[[-2.0, 2.0]]);
        gaps
    }

    fn closed(spans: &[[f64; 2]]) -> Gaps {
        let mut gaps = gaps(&[[-1.0, 0.0], [0.5, 1.0]]);
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
    fn a_span_closes_something_once() {
        let mut gaps = gaps(&[[0.0, 1.0]]);
        assert!(gaps.close([0.25, 0.5]));
        assert!(gaps.close([0.0, 0.75]));
        assert!(!gaps.close([0.0, 0.75]));
        assert!(!gaps.close([1.0, 1.5]));
    }
}
