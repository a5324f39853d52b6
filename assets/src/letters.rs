//! A small stroke font: every letter is a few polylines in a box 1 high. Used for painted and for standing letters.

use glam::{DVec2, DVec3, dvec2};

use crate::material::Material;
use crate::round::arc;
use crate::soup::{Crease, Soup};

/// A polyline; a closed one joins its last point to its first.
pub(crate) struct Stroke {
    pub(crate) points: Vec<DVec2>,
    pub(crate) closed: bool,
}

/// Width of a letter's box and the gap to the next, in letter heights.
const ADVANCE: f64 = 0.98;
/// Width from the middle of the first stroke to the middle of the last.
const WIDE: f64 = 0.62;

fn line(points: &[(f64, f64)]) -> Stroke {
    Stroke { points: points.iter().map(|&(x, y)| dvec2(x * WIDE, y)).collect(), closed: false }
}

/// Strokes of `letter`, x from 0 to [`WIDE`], y from 0 to 1. Unknown letters are blank.
fn strokes(letter: char) -> Vec<Stroke> {
    let bowl = |y: f64, tall: f64| {
        let mut points = vec![dvec2(0.0, y)];
        let round = arc(dvec2(0.30, tall * 0.5), -90.0, 90.0, 9);
        points.extend(round.iter().map(|p| *p + dvec2(WIDE - 0.30, y + tall * 0.5)));
        points.push(dvec2(0.0, y + tall));
        Stroke { points, closed: false }
    };
    match letter {
        'A' => vec![line(&[(-0.06, 0.0), (0.5, 1.0), (1.06, 0.0)]), line(&[(0.18, 0.30), (0.82, 0.30)])],
        'B' => vec![line(&[(0.0, 0.0), (0.0, 1.0)]), bowl(0.0, 0.52), bowl(0.52, 0.48)],
        'E' => vec![line(&[(1.0, 1.0), (0.0, 1.0), (0.0, 0.0), (1.0, 0.0)]), line(&[(0.0, 0.52), (0.8, 0.52)])],
        'G' => vec![curve(40.0, 330.0, &[(1.0, 0.44), (0.55, 0.44)])],
        'K' => vec![line(&[(0.0, 0.0), (0.0, 1.0)]), line(&[(1.0, 1.0), (0.12, 0.47), (1.04, 0.0)])],
        'N' => vec![line(&[(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0)])],
        'O' => vec![ring()],
        'P' => vec![line(&[(0.0, 0.0), (0.0, 1.0)]), bowl(0.44, 0.56)],
        'R' => vec![line(&[(0.0, 0.0), (0.0, 1.0)]), bowl(0.46, 0.54), line(&[(0.45, 0.46), (1.04, 0.0)])],
        'S' => vec![snake()],
        'T' => vec![line(&[(0.0, 1.0), (1.0, 1.0)]), line(&[(0.5, 0.0), (0.5, 1.0)])],
        'U' => vec![cup()],
        'C' => vec![curve(45.0, 315.0, &[])],
        'D' => vec![line(&[(0.0, 0.0), (0.0, 1.0)]), bowl(0.0, 1.0)],
        'F' => vec![line(&[(1.0, 1.0), (0.0, 1.0), (0.0, 0.0)]), line(&[(0.0, 0.52), (0.8, 0.52)])],
        'H' => {
            vec![line(&[(0.0, 0.0), (0.0, 1.0)]), line(&[(1.0, 0.0), (1.0, 1.0)]), line(&[(0.0, 0.52), (1.0, 0.52)])]
        }
        'I' => vec![line(&[(0.5, 0.0), (0.5, 1.0)])],
        'L' => vec![line(&[(0.0, 1.0), (0.0, 0.0), (1.0, 0.0)])],
        _ => vec![],
    }
}

fn oval(from_deg: f64, to_deg: f64, count: usize) -> Vec<DVec2> {
    let half = dvec2(WIDE * 0.5, 0.5);
    arc(half, from_deg, to_deg, count).iter().map(|p| *p + half).collect()
}

fn ring() -> Stroke {
    let mut points = oval(0.0, 360.0, 21);
    points.pop();
    Stroke { points, closed: true }
}

fn curve(from_deg: f64, to_deg: f64, tail: &[(f64, f64)]) -> Stroke {
    let mut points = oval(from_deg, to_deg, 16);
    points.extend(tail.iter().map(|&(x, y)| dvec2(x * WIDE, y)));
    Stroke { points, closed: false }
}

fn cup() -> Stroke {
    let half = dvec2(WIDE * 0.5, 0.34);
    let mut points = vec![dvec2(0.0, 1.0)];
    points.extend(arc(half, 180.0, 360.0, 11).iter().map(|p| *p + half));
    points.push(dvec2(WIDE, 1.0));
    Stroke { points, closed: false }
}

fn snake() -> Stroke {
    let half = dvec2(WIDE * 0.5, 0.25);
    let mut points: Vec<_> = arc(half, 40.0, 270.0, 10).iter().map(|p| *p + dvec2(half.x, 0.75)).collect();
    points.pop();
    points.extend(arc(half, 90.0, -140.0, 10).iter().map(|p| *p + dvec2(half.x, 0.25)));
    Stroke { points, closed: false }
}

/// Width of `text` in letter heights, from the first stroke's middle to the last's.
pub(crate) fn width_of(text: &str) -> f64 {
    ADVANCE * (text.chars().count() as f64 - 1.0) + WIDE
}

/// All strokes of `text`, `high` high, centred on the origin.
pub(crate) fn text_strokes(text: &str, high: f64) -> Vec<Stroke> {
    let mut all = Vec::new();
    for (k, letter) in text.chars().enumerate() {
        let left = ADVANCE * k as f64 - width_of(text) * 0.5;
        for mut stroke in strokes(letter) {
            for p in &mut stroke.points {
                *p = (*p + dvec2(left, -0.5)) * high;
            }
            all.push(stroke);
        }
    }
    all
}

impl Soup {
    /// Standing letters in the XY plane, readable from +Z, centred on the origin; all lengths in metres.
    pub(crate) fn letters(
        &mut self,
        material: Material,
        text: &str,
        high_m: f64,
        bold_m: f64,
        deep_m: f64,
    ) -> &mut Self {
        for (k, stroke) in text_strokes(text, high_m).iter().enumerate() {
            // Strokes of one letter cross; a slightly different depth keeps their faces apart.
            let deep_m = deep_m - 0.016 * (k % 3) as f64;
            self.ribbon(material, stroke, bold_m, deep_m);
        }
        self
    }

    /// A bar of rectangular section along a stroke in the XY plane, mitred at its bends.
    fn ribbon(&mut self, material: Material, stroke: &Stroke, wide_m: f64, deep_m: f64) {
        let (left, right) = rails(stroke, wide_m * 0.5);
        let at = |p: DVec2, side: f64| p.extend(side * deep_m * 0.5);
        let ring = |k: usize| [at(left[k], -1.0), at(left[k], 1.0), at(right[k], 1.0), at(right[k], -1.0)];
        let count = left.len();
        self.patch(material, Crease::Soft);
        for k in 1..count + usize::from(stroke.closed) {
            let (a, b) = (ring(k - 1), ring(k % count));
            for s in 0..4 {
                self.polygon(&[a[s], a[(s + 1) % 4], b[(s + 1) % 4], b[s]]);
            }
        }
        if !stroke.closed {
            let reversed = |r: [DVec3; 4]| [r[3], r[2], r[1], r[0]];
            self.polygon(&reversed(ring(0))).polygon(&ring(count - 1));
        }
    }
}

/// The two edges of a stroke, `half` to either side, mitred.
fn rails(stroke: &Stroke, half: f64) -> (Vec<DVec2>, Vec<DVec2>) {
    let points = &stroke.points;
    let n = points.len();
    let direction = |k: usize| (points[(k + 1) % n] - points[k % n]).normalize();
    let offset = |k: usize| {
        let before = if k > 0 || stroke.closed { direction(k + n - 1) } else { direction(k) };
        let after = if k + 1 < n || stroke.closed { direction(k) } else { before };
        let across = (before + after).normalize().perp();
        across * (half / across.dot(after.perp()).max(0.45))
    };
    ((0..n).map(|k| points[k] + offset(k)).collect(), (0..n).map(|k| points[k] - offset(k)).collect())
}
