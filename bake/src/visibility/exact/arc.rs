//! An arc of the sun's path in a frame of its own, and times along it as numbers that are cheap to compare.
//!
//! Frame: z is the arc's axis, x points at the middle of the arc, so that hour angles run from -w to w, w at most half
//! a turn. In it `dir(h) = (cos d cos h, cos d sin h, sin d)`, and for any vector n
//! `n . dir(h) = A cos h + B sin h + C` with `A = n_x cos d`, `B = n_y cos d`, `C = n_z sin d`.
//!
//! Where that is not negative: with `R^2 = A^2 + B^2` and `(A, B) = R (cos p, sin p)` it is `R cos(h - p) + C`. If
//! `R > |C|` it is not negative for `|h - p| <= q`, where `cos q = -C / R` and `sin q = W / R`, `W^2 = R^2 - C^2`. By
//! the addition theorems the ends `p - q` and `p + q` are the angles of the vectors `(W B - C A, -C B - W A)` and
//! `(-C A - W B, W A - C B)`, both times `R^2`. If `R <= |C|` the sign of C decides for all h.
//!
//! Hour angles are held as *diamond angles*: of a vector (x, y), `y / (|x| + |y|)` if x is not negative, else
//! `±2 - y / (|x| + |y|)`. It grows with the angle from -2 to 2 and costs a division, no trigonometry. Only the ends
//! of final answers are turned into times.

use crate::sun::{SunArc, SunPath};
use glam::{DMat3, DVec3};
use std::f64::consts::{PI, TAU};

/// Cosine and sine of a lane's declination.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Declination {
    pub cos: f64,
    pub sin: f64,
}

/// An arc of at most a full turn.
#[derive(Debug, Clone)]
pub(super) struct ArcFrame {
    /// From bake axes to the arc's.
    pub arc_from_bake: DMat3,
    /// One for each lane.
    pub lanes: Vec<Declination>,
    /// Diamond angles of the arc's ends.
    pub window: [f64; 2],
    arc: SunArc,
    /// Hour angle of the frame's x.
    middle_rad: f64,
}

impl ArcFrame {
    /// Frames of a path's arcs, in order; arcs of more than a turn in several. Lanes differ by declination alone.
    pub fn of_path(lanes: &[SunPath]) -> Vec<Self> {
        let Some(first) = lanes.first() else { return Vec::new() };
        let declination = |path: &SunPath, index: usize| {
            let (sin, cos) = path.arcs()[index].declination_rad.sin_cos();
            Declination { cos, sin }
        };
        let frames = |(index, arc): (usize, &SunArc)| {
            let declinations: Vec<_> = lanes.iter().map(|path| declination(path, index)).collect();
            pieces(arc).map(move |ends| Self::new(*arc, ends, declinations.clone())).collect::<Vec<_>>()
        };
        first.arcs().iter().enumerate().flat_map(frames).collect()
    }

    fn new(arc: SunArc, [start, end]: [f64; 2], lanes: Vec<Declination>) -> Self {
        let middle_rad = 0.5 * (start + end);
        let (sin, cos) = middle_rad.sin_cos();
        let x = (arc.zero * cos + arc.axis.cross(arc.zero) * sin).normalize();
        let y = arc.axis.cross(x);
        let half = 0.5 * (end - start);
        let reach = if half >= PI * (1.0 - 1e-12) { 2.0 } else { diamond(half.cos(), half.sin()) };
        Self {
            arc_from_bake: DMat3::from_cols(x, y, arc.axis).transpose(),
            lanes,
            window: [-reach, reach],
            arc,
            middle_rad,
        }
    }

    /// Path time of a diamond angle; the ends of the window are exactly the ends of the arc.
    pub fn t_of(&self, diamond_angle: f64) -> f64 {
        self.arc.t_at_hour_angle(self.middle_rad + angle_rad(diamond_angle))
    }

    /// When a vector (arc frame) and the direction to a lane's sun have a product of at least `-constant`: within the
    /// window, ascending.
    pub fn half_space(&self, n: DVec3, constant: f64, lane: usize) -> HalfSpace {
        let Declination { cos, sin } = self.lanes[lane];
        half_space(n.x * cos, n.y * cos, n.z * sin + constant).clipped(self.window)
    }
}

/// Hour angles of the pieces that an arc is cut into so that none is longer than a turn.
fn pieces(arc: &SunArc) -> impl Iterator<Item = [f64; 2]> {
    let [start, end] = arc.hour_angle_rad;
    let count = ((end - start) / TAU * (1.0 - 1e-12)).ceil().max(1.0);
    let at = move |i: f64| start + (end - start) * i / count;
    (0..count as usize).map(move |i| [at(i as f64), at(i as f64 + 1.0)])
}

/// Up to two disjoint spans of diamond angle, ascending.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct HalfSpace {
    spans: [[f64; 2]; 2],
    count: usize,
}

impl HalfSpace {
    pub fn as_slice(&self) -> &[[f64; 2]] {
        &self.spans[..self.count]
    }

    fn of(spans: &[[f64; 2]]) -> Self {
        let mut all = [[0.0; 2]; 2];
        all[..spans.len()].copy_from_slice(spans);
        Self { spans: all, count: spans.len() }
    }

    fn clipped(self, [low, high]: [f64; 2]) -> Self {
        let mut clipped = Self { spans: [[0.0; 2]; 2], count: 0 };
        for [start, end] in self.as_slice() {
            let span = [start.max(low), end.min(high)];
            if span[0] < span[1] {
                clipped.spans[clipped.count] = span;
                clipped.count += 1;
            }
        }
        clipped
    }
}

/// Where `a cos h + b sin h + c` is not negative, over the whole turn.
pub(super) fn half_space(a: f64, b: f64, c: f64) -> HalfSpace {
    let r2 = a * a + b * b;
    let d = r2 - c * c;
    let is_part = d > 0.0;
    if !is_part {
        // NaN yields no span.
        return if c >= 0.0 { HalfSpace::of(&[[-2.0, 2.0]]) } else { HalfSpace::of(&[]) };
    }
    let w = d.sqrt();
    let [start, end] = diamonds([w * b - c * a, -(c * b) - w * a], [-(c * a) - w * b, w * a - c * b]);
    if start <= end { HalfSpace::of(&[[start, end]]) } else { HalfSpace::of(&[[-2.0, end], [start, 2.0]]) }
}

/// Diamond angle of a vector, from -2 to 2.
pub(super) fn diamond(x: f64, y: f64) -> f64 {
    unfold(x, y, y / (x.abs() + y.abs()))
}

/// Diamond angles of two vectors, by one division. Neither order nor sign changes how they round.
fn diamonds([x, y]: [f64; 2], [x1, y1]: [f64; 2]) -> [f64; 2] {
    let (sum, sum1) = (x.abs() + y.abs(), x1.abs() + y1.abs());
    let inverse = 1.0 / (sum * sum1);
    [unfold(x, y, y * (sum1 * inverse)), unfold(x1, y1, y1 * (sum * inverse))]
}

/// Diamond angle of (x, y) from the ratio of y to their sum.
fn unfold(x: f64, y: f64, r: f64) -> f64 {
    match (x < 0.0, y < 0.0) {
        (false, _) => r,
        (true, false) => 2.0 - r,
        (true, true) => -2.0 - r,
    }
}

/// A vector of a diamond angle.
pub(super) fn of_diamond(u: f64) -> [f64; 2] {
    if u.abs() <= 1.0 {
        [1.0 - u.abs(), u]
    } else {
        let y = if u > 0.0 { 2.0 - u } else { -2.0 - u };
        [y.abs() - 1.0, y]
    }
}

/// Angle of a diamond angle, in radians.
fn angle_rad(u: f64) -> f64 {
    let [x, y] = of_diamond(u);
    // The cut itself: the sign of zero would be lost.
    if u <= -2.0 { -PI } else { y.atan2(x) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::pseudo_random;

    #[test]
    fn diamond_angles_grow_with_the_angle_and_turn_back_into_it() {
        let mut before = -2.0;
        for step in -1000i32..=1000 {
            let angle = f64::from(step) / 1000.0 * PI;
            let u = diamond(angle.cos(), angle.sin());
            assert!(u >= before, "{u} after {before}");
            assert!(
                (angle_rad(u) - angle).abs() < 1e-15 * 8.0 || step.abs() == 1000,
                "{angle} came back as {}",
                angle_rad(u)
            );
            before = u;
        }
    }

    #[test]
    fn half_spaces_hold_where_their_function_is_not_negative() {
        let mut state = 5;
        let mut random = || 2.0 * pseudo_random(&mut state) - 1.0;
        for _ in 0..20_000 {
            let [a, b, c] = [random(), random(), 1.2 * random()];
            let spans = half_space(a, b, c);
            let h = random() * PI;
            let value = a * h.cos() + b * h.sin() + c;
            let u = diamond(h.cos(), h.sin());
            let inside = spans.as_slice().iter().any(|s| (s[0]..=s[1]).contains(&u));
            assert!(inside == (value >= 0.0) || value.abs() < 1e-9, "{a} {b} {c} at {h}: {value}");
        }
    }

    /// I3.
    #[test]
    fn a_plane_and_its_back_share_their_ends_exactly() {
        let mut state = 11;
        let mut random = || 2.0 * pseudo_random(&mut state) - 1.0;
        for _ in 0..20_000 {
            let [a, b, c] = [random(), random(), random()];
            let [front, back] = [half_space(a, b, c), half_space(-a, -b, -c)];
            let mut ends: Vec<f64> = front.as_slice().iter().chain(back.as_slice()).flatten().copied().collect();
            ends.retain(|u| u.abs() < 2.0);
            ends.sort_by(f64::total_cmp);
            assert!(ends.chunks(2).all(|pair| pair[0] == pair[1]), "{ends:?}");
        }
    }
}
