//! One arc of a sun path, and when it is on one side of a plane.
//!
//! Theory: seen from one point, a sun of constant declination stays on a cone about the arc's axis. For any vector `n`,
//! `n . dir(h) = A cos h + B sin h + C` with `A = cos d (n . zero)`, `B = cos d (n . axis x zero)` and
//! `C = sin d (n . axis)`. With `R = hypot(A, B)` and `p = atan2(B, A)` that is `R cos(h - p) + C`, which is never
//! negative if `C >= R`, always negative if `C < -R`, and otherwise not negative for `|h - p| <= w`,
//! `w = acos(-C / R)`, repeated every full turn.
//!
//! Practice: `w` is taken as `atan2(sqrt(R - C) sqrt(R + C), -C)`, which keeps its digits where the plane is nearly
//! tangent to the cone and where `R` is tiny. The arc may be longer than a full turn, so the answer is an iterator over
//! turns; it allocates nothing. `A = B = 0` (the plane is square to the axis) needs no case of its own, and numbers that
//! are not finite yield no interval instead of NaN.

use std::f64::consts::TAU;

use glam::DVec3;

/// A turn about a fixed axis at constant declination: `dir(h) = cos d (cos h zero + sin h axis x zero) + sin d axis`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SunArc {
    /// Unit vector, world space: what the sun turns about, right-handed as `h` grows. For a real day that is the
    /// *south* celestial pole, because the sky turns clockwise about the north one; declinations change sign with it.
    pub axis: DVec3,
    /// Unit vector across the axis, world space: where `h` is zero.
    pub zero: DVec3,
    /// Angle of the direction above the plane across the axis, in radians.
    pub declination_rad: f64,
    /// Hour angles at the arc's start and end, in radians, ascending.
    pub hour_angle_rad: [f64; 2],
    /// Path times at the arc's start and end, ascending.
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

    /// Path time at an hour angle, clamped to the arc: its ends come out as exactly its `t`.
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

    /// Angle through which the sun moves across the sky for a unit of `t`, in radians.
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

    /// Path times of this arc at which the sun is not behind the plane across `normal` (any length): `[start, end]`
    /// pairs of positive length, ascending, disjoint. At most two for an arc of up to a full turn, one more for each
    /// further turn begun. A plane that contains the whole arc counts as not behind.
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
        // Casts saturate, and NaN becomes 0: the emptiness test in `next` then drops it.
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
