//! The knee of a curve of error against time: beyond it, more time gains little.
//!
//! Based on: Satopaa, Albrecht, Irwin and Raghavan, "Finding a 'Kneedle' in a Haystack: Detecting Knee Points in System
//! Behavior", *ICDCS Workshops*, 2011. The curve is scaled to the unit square, and its knee lies where it is farthest
//! from the chord between its ends. Departures: both numbers are taken as logarithms, since times and errors differ by
//! factors, and error falls by powers; there is no smoothing, since there are a dozen points and each is a measurement;
//! only points that no other beats in both time and error are on the curve; and a curve that is nearly straight has no
//! knee.

/// How far from the chord, in the unit square, a knee must be.
const LEAST_BEND: f64 = 0.05;
/// Least ratio of the largest to the smallest error: a curve that is flatter has no knee.
const LEAST_RATIO: f64 = 1.25;

/// Index of the knee of (time, error) pairs, if there is one. Pairs that are not positive have no logarithm and are
/// skipped.
pub(super) fn knee(points: &[(f64, f64)]) -> Option<usize> {
    let curve = frontier(points);
    let &[(first, x0, y0), .., (_, x1, y1)] = curve.as_slice() else { return None };
    if y0 - y1 < LEAST_RATIO.ln() {
        return None;
    }
    let below = |&(index, x, y): &(usize, f64, f64)| {
        let (across, down) = ((x - x0) / (x1 - x0), (y0 - y) / (y0 - y1));
        (index, down - across)
    };
    let (index, bend) =
        curve.iter().map(below).fold((first, 0.0), |best, next| if next.1 > best.1 { next } else { best });
    (bend > LEAST_BEND).then_some(index)
}

/// The logarithms of points that no other beats, by time; each with its index.
fn frontier(points: &[(f64, f64)]) -> Vec<(usize, f64, f64)> {
    let is_placed = |(_, (time, error)): &(usize, &(f64, f64))| {
        *time > 0.0 && *error > 0.0 && time.is_finite() && error.is_finite()
    };
    let placed = points.iter().enumerate().filter(is_placed);
    let mut logs: Vec<_> = placed.map(|(index, (time, error))| (index, time.ln(), error.ln())).collect();
    logs.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.2.total_cmp(&b.2)));
    let mut curve: Vec<(usize, f64, f64)> = Vec::with_capacity(logs.len());
    for point in logs {
        if curve.last().is_none_or(|last| point.2 < last.2 && point.1 > last.1) {
            curve.push(point);
        }
    }
    curve
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_knee_is_where_a_bent_curve_bends() {
        // Two power laws that meet at the third point.
        let curve = [(1.0, 1000.0), (2.0, 100.0), (4.0, 10.0), (40.0, 8.0), (400.0, 6.4)];
        assert_eq!(knee(&curve), Some(2));
        // In any order, with dominated points and points without a logarithm among them.
        let more = [
            (400.0, 6.4),
            (5.0, 50.0),
            (4.0, 10.0),
            (1.0, 1000.0),
            (3.0, 0.0),
            (2.0, 100.0),
            (f64::NAN, 1.0),
            (40.0, 8.0),
        ];
        assert_eq!(knee(&more), Some(2));
    }

    #[test]
    fn a_power_law_and_a_curve_of_two_points_have_none() {
        let straight: Vec<(f64, f64)> = (0..8).map(|k| (2f64.powi(k), 2f64.powi(-k))).collect();
        assert_eq!(knee(&straight), None);
        assert_eq!([knee(&[]), knee(&straight[..1]), knee(&straight[..2])], [None; 3]);
        assert_eq!(knee(&[(1.0, 1.0), (2.0, 1.0), (4.0, 1.0)]), None);
    }
}
