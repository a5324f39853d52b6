//! The spans of a segment that are still open: occluders close them.

use super::span::Span;
use smallvec::SmallVec;

/// Open spans shorter than this, as a share of the segment, are closed: they come of two occluders that meet without
/// sharing an edge, and last a tenth of a microsecond of a segment that takes a quarter of an hour.
const LEAST_OPEN: f64 = 1e-10;

/// Disjoint spans, ascending, none of them empty; usually few, and then stored inline.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct OpenSpans(SmallVec<[Span; 4]>);

impl OpenSpans {
    /// One span, or none.
    pub fn new(span: Option<Span>) -> Self {
        Self(span.into_iter().collect())
    }

    pub fn as_slice(&self) -> &[Span] {
        &self.0
    }

    #[inline]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Removes a span. True if any of it was open.
    pub fn close(&mut self, [start, end]: Span) -> bool {
        let Some(first) = self.0.iter().position(|open| open[1] > start && open[0] < end) else { return false };
        let mut left: SmallVec<[Span; 4]> = self.0[..first].into();
        for &open in &self.0[first..] {
            for part in [[open[0], open[1].min(start)], [open[0].max(end), open[1]]] {
                if part[1] - part[0] > LEAST_OPEN {
                    left.push(part);
                }
            }
        }
        self.0 = left;
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn closed(spans: &[Span]) -> Vec<Span> {
        let mut open = OpenSpans::new(Some([0.0, 1.0]));
        for span in spans {
            open.close(*span);
        }
        open.as_slice().to_vec()
    }

    #[test]
    fn spans_trim_split_and_remove() {
        assert_eq!(closed(&[[0.25, 0.5]]), [[0.0, 0.25], [0.5, 1.0]]);
        assert_eq!(closed(&[[0.25, 0.5], [0.125, 0.75]]), [[0.0, 0.125], [0.75, 1.0]]);
        assert_eq!(closed(&[[-1.0, 0.25], [0.75, 2.0]]), [[0.25, 0.75]]);
        assert_eq!(closed(&[[0.25, 0.5], [0.0, 0.25], [0.5, 1.0]]), [[0.0; 2]; 0]);
    }

    #[test]
    fn spans_that_were_not_open_are_not_closed() {
        let mut open = OpenSpans::new(Some([0.25, 0.5]));
        assert!(!open.close([0.5, 0.75]) && !open.close([0.0, 0.25]) && open.close([0.0, 0.3]));
        assert!(!OpenSpans::new(None).close([0.0, 1.0]));
    }
}
