//! On which part of a segment a triangle occludes the lamp.
//!
//! Theory: let the corners v be relative to the point, `n_i = v_i x v_(i+1)` signed so that `V = v0 . (v1 x v2) > 0`,
//! and N their sum. The ray to the lamp l passes inside the triangle where all `n_i . l >= 0`, and meets its plane in
//! front of the lamp where `N . l >= V`. On a segment `l(s) = l0 + s (l1 - l0)`, so all four are linear in s, and what
//! is hidden is one span in closed form. Watertight, since `a x b` and `b x a` are exact opposites: neighbours end at
//! the same number.
//!
//! Two departures from this keep rounding from deciding:
//!
//! * A lamp within the run-up r of shadow rays behind a triangle is not occluded by it, `N . l >= V + r |N|`. A lamp
//!   that moves along a wall is visible from both sides.
//! * Shadow rays start r before their point (see [`crate::trace`]), so a triangle counts that far behind it. With
//!   either orientation of the n_i, where V is negative, the ray's line crosses the plane at the distance
//!   `|V| |l| / (N . l)` behind the point, which is at most r where `N . l >= |V| / r |l|`. That is a cone; a segment
//!   meets it in one span, whose ends are roots of a quadratic.

use super::span::{Span, all_not_negative, common};
use glam::DVec3;
use smallvec::SmallVec;

/// At most one span for each orientation.
pub(super) type Spans = SmallVec<[Span; 2]>;

/// A segment of the lamp's path seen from a point, tracer space.
#[derive(Debug, Clone, Copy)]
pub(super) struct SegmentFromPoint {
    /// Its ends, relative to the point.
    pub ends: [DVec3; 2],
    /// Run-up of shadow rays.
    pub run_up: f64,
}

impl SegmentFromPoint {
    /// The values of `n . l` at both ends.
    #[inline]
    pub fn along(&self, n: DVec3) -> [f64; 2] {
        self.ends.map(|end| n.dot(end))
    }

    /// Where a triangle (corners relative to the point) hides the lamp.
    #[inline]
    pub fn hidden_by(&self, [a, b, c]: [DVec3; 3]) -> Spans {
        let normals = [a.cross(b), b.cross(c), c.cross(a)];
        let area = normals[0] + normals[1] + normals[2];
        let volume = a.dot(normals[1]);
        let margin = area.length() * self.run_up;
        if area == DVec3::ZERO {
            return Spans::new();
        }
        if volume.abs() > margin {
            let side = if volume < 0.0 { -1.0 } else { 1.0 };
            return self.passed(normals, area, volume, margin, side).into_iter().collect();
        }
        let orientations = [1.0, -1.0].into_iter();
        orientations.filter_map(|side| self.passed_near(normals, area, volume, margin, side)).collect()
    }

    /// Where the ray passes inside the triangle, oriented by `side`, and the lamp is beyond its plane.
    #[inline]
    fn passed(&self, normals: [DVec3; 3], area: DVec3, volume: f64, margin: f64, side: f64) -> Option<Span> {
        let beyond = self.along(area).map(|value| side * (value - volume) - margin);
        let inside = normals.map(|n| self.along(n).map(|value| side * value));
        all_not_negative(std::iter::once(beyond).chain(inside))
    }

    /// The same for a triangle whose plane is within the run-up of the point.
    fn passed_near(&self, normals: [DVec3; 3], area: DVec3, volume: f64, margin: f64, side: f64) -> Option<Span> {
        let span = self.passed(normals, area, volume, margin, side)?;
        if side * volume >= 0.0 {
            return Some(span);
        }
        common(span, self.within_cone(area * side, volume.abs() / self.run_up)?)
    }

    /// Where `axis . l >= slope |l|`.
    fn within_cone(&self, axis: DVec3, slope: f64) -> Option<Span> {
        let [first, last] = self.ends;
        let (motion, [height, high]) = (last - first, self.along(axis));
        let climb = high - height;
        let slope2 = slope * slope;
        // Coefficients of (axis . l)^2 - slope^2 |l|^2 in s.
        let a = climb * climb - slope2 * motion.length_squared();
        let b = 2.0 * (height * climb - slope2 * first.dot(motion));
        let c = height * height - slope2 * first.length_squared();
        let mut ends: SmallVec<[f64; 4]> = SmallVec::from_slice(&[0.0, 1.0]);
        ends.extend(roots(a, b, c).into_iter().filter(|root| (0.0..1.0).contains(root)));
        ends.sort_by(f64::total_cmp);
        let is_inside = |s: f64| {
            let lamp = first + motion * s;
            axis.dot(lamp) >= slope * lamp.length()
        };
        let inside = ends.windows(2).filter(|part| is_inside(0.5 * (part[0] + part[1])));
        // The cone is convex, so its parts follow one another.
        inside.map(|part| [part[0], part[1]]).reduce(|whole, part| [whole[0], part[1]])
    }
}

/// Roots of `a x^2 + b x + c`, without cancellation; infinite or NaN where there are none.
fn roots(a: f64, b: f64, c: f64) -> [f64; 2] {
    let half = -0.5 * (b + (b * b - 4.0 * a * c).sqrt().copysign(b));
    [half / a, c / half]
}

#[cfg(test)]
mod tests {
    use super::*;

    const RUN_UP: f64 = 0.01;

    fn segment(from: [f64; 3], to: [f64; 3]) -> SegmentFromPoint {
        SegmentFromPoint { ends: [from, to].map(DVec3::from_array), run_up: RUN_UP }
    }

    /// A square's half, one above the point, and the same at another height.
    fn roof(height: f64) -> [DVec3; 3] {
        [[-1.0, -1.0], [3.0, -1.0], [-1.0, 3.0]].map(|[x, z]| DVec3::new(x, height, z))
    }

    #[test]
    fn a_lamp_is_hidden_while_it_is_behind_the_triangle() {
        // At height 2 the shadow of the edge x = -1 is at x = -2.
        let spans = segment([-4.0, 2.0, 0.0], [0.0, 2.0, 0.0]).hidden_by(roof(1.0));
        assert_eq!(spans.as_slice(), [[0.5, 1.0]]);
        let [a, b, c] = roof(1.0);
        assert_eq!(segment([-4.0, 2.0, 0.0], [0.0, 2.0, 0.0]).hidden_by([c, b, a]), spans);
    }

    #[test]
    fn triangles_beyond_the_lamp_occlude_nothing() {
        assert!(segment([-4.0, 0.5, 0.0], [4.0, 0.5, 0.0]).hidden_by(roof(1.0)).is_empty());
        // Rising through the roof, hidden from there on, but for the margin.
        let spans = segment([0.0, 0.5, 0.0], [0.0, 1.5, 0.0]).hidden_by(roof(1.0));
        assert!((spans[0][0] - 0.5 - RUN_UP).abs() < 1e-12 && spans[0][1] == 1.0, "{spans:?}");
    }

    #[test]
    fn a_lamp_in_a_plane_is_hidden_from_neither_side_of_it() {
        for height in [1.0, 1.0 - 1e-9, 1.0 + 1e-9] {
            assert!(segment([-0.5, height, 0.0], [0.5, height, 0.0]).hidden_by(roof(1.0)).is_empty());
        }
        assert!(segment([-0.5, 0.0, 0.0], [0.5, 0.0, 0.3]).hidden_by(roof(0.0)).is_empty());
    }

    /// Shadow rays start before the point: what is a little behind it hides the lamp, what is farther does not.
    #[test]
    fn a_triangle_just_behind_the_point_hides_as_rays_find_it() {
        let segment = segment([-4.0, 1.0, 0.0], [4.0, 1.0, 0.0]);
        for (below, expected) in [(0.5 * RUN_UP, true), (1.5 * RUN_UP, false)] {
            assert_eq!(!segment.hidden_by(roof(-below)).is_empty(), expected, "{below}");
        }
        let below = 0.5 * RUN_UP;
        let [start, end] = segment.hidden_by(roof(-below))[0];
        // A ray that climbs 1 in a distance of 2 has used up its run-up: x = -+sqrt(3).
        let reach = 3f64.sqrt() / 8.0;
        assert!((start - 0.5 + reach).abs() < 1e-12 && (end - 0.5 - reach).abs() < 1e-12, "{start} {end}");
    }

    #[test]
    fn triangles_without_area_and_lamps_at_the_point_occlude_nothing() {
        let line = [DVec3::X, DVec3::X * 2.0, DVec3::X * 3.0];
        assert!(segment([0.0, 1.0, 0.0], [9.0, 0.0, 0.0]).hidden_by(line).is_empty());
        assert!(segment([0.0; 3], [0.0; 3]).hidden_by(roof(0.0)).is_empty());
        assert!(segment([-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]).hidden_by(roof(0.5)).is_empty());
    }
}
