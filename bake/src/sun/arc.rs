//! One arc of a sun path, and when the sun on it is on one side of a plane.
//!
//! Theory: a sun of constant declination moves on a cone about the arc's axis. For any vector `n`,
//! `n . dir(h) = A cos h + B sin h + C` with `A = cos d (n . zero)`, `B = cos d (n . axis x zero)` and
//! `C = sin d (n . axis)`. With `R = hypot(A, B)` and `p = atan2(B, A)` that is `R cos(h - p) + C`, which is never
//! negative if `C >= R`, always negative if `C < -R`, and otherwise not negative for `|h - p| <= w`,
//! `w = acos(-C / R)`, repeated every full turn.
//!
//! Practice: `w` is computed as `atan2(sqrt(R - C) sqrt(R + C), -C)`, which stays accurate where the plane is nearly
//! tangent to the cone and where `R` is tiny. The arc may be longer than a full turn, so the result is an iterator over
//! turns; it allocates nothing. `A = B = 0` (the plane is perpendicular to the axis) needs no special case, and NaN or
//! infinite input yields no interval.

use std::f64::consts::TAU;

use glam::DVec3;

/// A turn about a fixed axis at constant declination: `dir(h) = cos d (cos h zero + sin h axis x zero) + sin d axis`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SunArc {
    /// Axis of rotation, a unit vector in world space, right-handed as `h` grows. For a real day it is the *south*
    /// celestial pole, because the sky turns clockwise about the north pole; declinations have the opposite sign of the
    /// almanac's.
    pub axis: DVec3,
    /// Direction at `h` = 0 and declination 0: a unit vector perpendicular to the axis, world space.
    pub zero: DVec3,
    /// Angle of the direction above the plane perpendicular to the axis, in radians.
    pub declination_rad: f64,
    /// Hour angles at the arc's start and end, in radians, ascending.
    pub hour_angle_rad: [f64; 2],
    /// Path times at the arc's start and end, ascending, in [0, 1].
    pub t: [f64; 2],
}

impl SunArc {
    /// Direction towards the sun at an hour angle, unit length, world space.
    pub fn direction_at_hour_angle(&self, hour_angle_rad: f64) -> DVec3 {
        let (sin_d, cos_d) = self.declination_rad.sin_cos();
        let (sin_h, cos_h) = hour_angle_rad.sin_cos();
        (self.zero * cos_h + self.axis.cross(self.zero) * sin_h) * cos_d + self.axis * sin_d
    }

    /// Hour angle at path time `t`, extrapolated outside the arc.
    pub fn hour_angle_at(&self, t: f64) -> f64 {
        let [h0, h1] = self.hour_angle_rad;
        let [t0, t1] = self.t;
        h0 + (h1 - h0) * (t - t0) / (t1 - t0)
    }

    /// Path time at an hour angle, clamped to the arc. Its end points give exactly [`SunArc::t`].
    pub fn t_at_hour_angle(&self, hour_angle_rad: f64) -> f64 {
        let [h0, h1] = self.hour_angle_rad;
        let [t0, t1] = self.t;
        if hour_angle_rad <= h0 {
            t0
        } else if hour_angle_rad >= h1 {
            t1
        } else {
            (t0 + (t1 - t0) * (hour_angle_rad - h0) / (h1 - h0)).clamp(t0, t1)
        }
    }

    /// Angular speed of the sun: radians per unit of `t`.
    pub fn speed_rad(&self) -> f64 {
        let [h0, h1] = self.hour_angle_rad;
        let [t0, t1] = self.t;
        (h1 - h0).abs() / (t1 - t0) * self.declination_rad.cos()
    }

    /// `[A, B, C]` of `normal . dir(h) = A cos h + B sin h + C`.
    pub fn half_space_coefficients(&self, normal: DVec3) -> [f64; 3] {
        let (sin_d, cos_d) = self.declination_rad.sin_cos();
        let square = self.axis.cross(self.zero);
        [normal.dot(self.zero) * cos_d, normal.dot(square) * cos_d, normal.dot(self.axis) * sin_d]
    }

    /// Path times of this arc at which the sun is not behind the plane with this `normal` (of any length): `[start,
    /// end]` pairs of positive length, ascending, disjoint. At most two for an arc of up to a full turn, and one more
    /// for each further turn begun. If the plane contains the whole arc, the sun is not behind it.
    pub fn half_space_intervals(&self, normal: DVec3) -> HalfSpaceIntervals {
        let [a, b, c] = self.half_space_coefficients(normal);
        let r = a.hypot(b);
        let [h0, h1] = self.hour_angle_rad;
        let (middle, half_width) = if c >= r {
            return HalfSpaceIntervals { arc: *self, middle: 0.5 * (h0 + h1), half_width: h1 - h0, turns: [0, 0] };
        } else if c > -r {
            (b.atan2(a), ((r - c).sqrt() * (r + c).sqrt()).atan2(-c))
        } else {
            return HalfSpaceIntervals { arc: *self, middle: 0.0, half_width: 0.0, turns: [0, -1] };
        };
        // Casts saturate, and NaN becomes 0; `next` then drops the empty interval.
        let first = ((h0 - half_width - middle) / TAU).ceil() as i64;
        let last = ((h1 + half_width - middle) / TAU).floor() as i64;
        HalfSpaceIntervals { arc: *self, middle, half_width, turns: [first, last] }
    }
}

/// Iterator of [`SunArc::half_space_intervals`].
#[derive(Debug, Clone)]
pub struct HalfSpaceIntervals {
    arc: SunArc,
    /// Hour angle in the middle of turn 0's interval.
    middle: f64,
    /// Half of its length, in radians.
    half_width: f64,
    /// The next turn and the last.
    turns: [i64; 2],
}

impl Iterator for HalfSpaceIntervals {
    type Item = [f64; 2];

    fn next(&mut self) -> Option<[f64; 2]> {
        while self.turns[0] <= self.turns[1] {
            let middle = self.middle + self.turns[0] as f64 * TAU;
            self.turns[0] += 1;
            let [start, end] =
                [middle - self.half_width, middle + self.half_width].map(|h| self.arc.t_at_hour_angle(h));
            if start < end {
                return Some([start, end]);
            }
        }
        None
    }
}
