//! Where linear conditions hold along a segment, `s` running over [0, 1].
//!
//! A condition is given by its values at both ends. Opposite values give the same root, bit for bit, so that what ends
//! at an edge for one triangle starts there for its neighbour.

/// A part of a segment.
pub(super) type Span = [f64; 2];

/// The whole segment.
pub(super) const WHOLE: Span = [0.0, 1.0];

/// Where a linear function with these values at 0 and 1 is not negative.
#[inline]
pub(super) fn not_negative([first, last]: [f64; 2]) -> Option<Span> {
    match (first >= 0.0, last >= 0.0) {
        (true, true) => Some(WHOLE),
        (true, false) => Some([0.0, first / (first - last)]),
        (false, true) => Some([first / (first - last), 1.0]),
        (false, false) => None,
    }
}

/// The intersection of two spans, if it has a length.
#[inline]
pub(super) fn common(a: Span, b: Span) -> Option<Span> {
    let span = [a[0].max(b[0]), a[1].min(b[1])];
    (span[0] < span[1]).then_some(span)
}

/// Where all of some linear functions are not negative.
#[inline]
pub(super) fn all_not_negative(functions: impl IntoIterator<Item = [f64; 2]>) -> Option<Span> {
    functions.into_iter().try_fold(WHOLE, |span, function| common(span, not_negative(function)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spans_end_at_roots_and_opposites_share_them() {
        assert_eq!(not_negative([1.0, 3.0]), Some(WHOLE));
        assert_eq!(not_negative([-1.0, -3.0]), None);
        for (first, last) in [(1.0, -3.0), (0.1, -0.7), (1e-300, -1e300), (0.3, -1e-17)] {
            let [[_, end], [start, _]] = [[first, last], [-first, -last]].map(|f| not_negative(f).unwrap());
            assert_eq!(end, start);
        }
        assert_eq!(not_negative([f64::NAN, f64::NAN]), None);
    }

    #[test]
    fn spans_that_only_touch_have_no_intersection() {
        assert_eq!(all_not_negative([[1.0, -1.0], [-1.0, 1.0]]), None);
        assert_eq!(all_not_negative([[1.0, -1.0], [-1.0, 3.0]]), Some([0.25, 0.5]));
        assert_eq!(all_not_negative([[0.0, -1.0]]), None);
    }
}
