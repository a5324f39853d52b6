//! Fits arcs of constant declination to an ephemeris.
//!
//! Theory: in a day the sun turns once about the celestial pole while its declination drifts, by up to 0.4 degrees at
//! an equinox. A cone about the pole does not fit this. A cone about an axis tilted by a few hundredths of a degree
//! fits the part of the drift that is proportional to the sine of the hour angle, which leaves an error of 0.01 degrees
//! over half a turn. The remaining error falls with the cube of the arc's length, so two or three arcs a day suffice.
//!
//! Practice: write the sample at moment `s` as hour angle `H` and declination `D` in the arc's own frame (x = zero, z =
//! axis). Turning the frame by the small vector `(p, q, 0)` changes them to `D + q cos H - p sin H` and `H + tan D (p
//! cos H + q sin H)`. They should be `d` and `h + r s`. That is linear in `p, q, d, h, r`; it is solved by least
//! squares and repeated in the turned frame until it converges (three times). Weights `1 / sqrt(1 - u^2)` (`u` from -1
//! to 1 along the arc) emphasise the ends, like Chebyshev points: the largest error is close to the smallest possible.
//! To make neighbouring arcs meet, each is fitted a second time with its ends pinned halfway between the two arcs'
//! ends.

use std::f64::consts::{PI, TAU};

use glam::{DQuat, DVec3};

use super::arc::SunArc;

/// Parameters of one arc's linear fit: `p, q, d, h, r` of the theory above.
const UNKNOWNS: usize = 5;

/// Regularisation of the tilt, for windows too short to determine an axis: square radians of error per sample and per
/// square radian of tilt. Changes a well-determined fit by less than 0.0001 degrees.
const TILT_DAMPING: f64 = 1e-7;

/// Weight of a pinned end, relative to all samples of the arc together.
const PIN_WEIGHT: f64 = 1e4;

/// Least y of a unit direction that counts as above the horizon: slightly below 0, so that sunrise and sunset
/// themselves count despite rounding.
const UP_FROM: f64 = -1e-4;

/// The sun's direction at one moment, from the ephemeris.
#[derive(Debug, Clone, Copy)]
pub(super) struct EphemerisSample {
    /// Path time.
    pub t: f64,
    /// Towards the sun, unit length, world space.
    pub direction: DVec3,
}

/// Fitted arcs and their error.
pub(super) struct Fit {
    /// One to three arcs.
    pub arcs: Vec<SunArc>,
    /// Largest angle to any sample above the horizon, in degrees.
    pub error_deg: f64,
}

/// Fits as few arcs as stay within `enough_deg` of the samples above the horizon, three at most.
///
/// Samples are evenly spaced from t = 0 to t = 1; the number of steps is a multiple of six. `axis_and_zero` is the
/// initial frame, accurate to a few degrees.
pub(super) fn fit(samples: &[EphemerisSample], axis_and_zero: [DVec3; 2], enough_deg: f64) -> Fit {
    let mut best = fit_equal_arcs(samples, axis_and_zero, 1);
    for count in 2..=3 {
        if best.error_deg <= enough_deg {
            break;
        }
        let finer = fit_equal_arcs(samples, axis_and_zero, count);
        if finer.error_deg < best.error_deg {
            best = finer;
        }
    }
    best
}

fn fit_equal_arcs(samples: &[EphemerisSample], axis_and_zero: [DVec3; 2], count: usize) -> Fit {
    let last = samples.len() - 1;
    let share = |i: usize| &samples[i * last / count..=(i + 1) * last / count];
    let loose: Vec<SunArc> = (0..count).map(|i| fit_arc(share(i), axis_and_zero, [None; 2])).collect();
    // Where two arcs should meet: halfway between the end of the one and the start of the next.
    let joint = |i: usize| (end_direction(&loose[i], 1) + end_direction(&loose[i + 1], 0)).normalize();
    let pins = |i: usize| [(i > 0).then(|| joint(i - 1)), (i + 1 < count).then(|| joint(i))];
    let arcs: Vec<SunArc> = (0..count).map(|i| fit_arc(share(i), axis_and_zero, pins(i))).collect();
    let errors = arcs.iter().enumerate().map(|(i, arc)| worst_error_rad(arc, share(i)).to_degrees());
    let error_deg = errors.fold(0.0, f64::max);
    Fit { arcs, error_deg }
}

fn end_direction(arc: &SunArc, end: usize) -> DVec3 {
    arc.direction_at_hour_angle(arc.hour_angle_rad[end])
}

/// Largest angle between an arc and the samples above the horizon, in radians.
fn worst_error_rad(arc: &SunArc, samples: &[EphemerisSample]) -> f64 {
    let up = samples.iter().filter(|sample| sample.direction.y >= UP_FROM);
    up.map(|sample| {
        let direction = arc.direction_at_hour_angle(arc.hour_angle_at(sample.t));
        direction.cross(sample.direction).length().atan2(direction.dot(sample.direction))
    })
    .fold(0.0, f64::max)
}

/// Fits one arc. A pinned end replaces the sample there.
fn fit_arc(samples: &[EphemerisSample], [mut axis, mut zero]: [DVec3; 2], pins: [Option<DVec3>; 2]) -> SunArc {
    let weighted = weigh(samples, pins);
    let mut solution = [0.0; UNKNOWNS];
    for _ in 0..3 {
        solution = solve_linearised(&weighted, axis, zero);
        let [p, q, ..] = solution;
        let turn = DQuat::from_scaled_axis(zero * p + axis.cross(zero) * q);
        axis = (turn * axis).normalize();
        zero = (turn * zero).reject_from_normalized(axis).normalize();
    }
    let [_, _, declination_rad, middle, rate] = solution;
    let t = [samples[0].t, samples[samples.len() - 1].t];
    SunArc { axis, zero, declination_rad, hour_angle_rad: [middle - 0.5 * rate, middle + 0.5 * rate], t }
}

/// A target direction at `s` (-0.5 at the arc's start, 0.5 at its end) with its weight in the fit.
struct WeightedDirection {
    s: f64,
    direction: DVec3,
    weight: f64,
}

fn weigh(samples: &[EphemerisSample], pins: [Option<DVec3>; 2]) -> Vec<WeightedDirection> {
    let last = samples.len() - 1;
    let one = |(i, sample): (usize, &EphemerisSample)| {
        let s = i as f64 / last as f64 - 0.5;
        let weight = 1.0 / (1.0 - 4.0 * s * s).max(1.0 / last as f64).sqrt();
        let pin = if i == 0 { pins[0] } else { pins[1].filter(|_| i == last) };
        match pin {
            Some(direction) => WeightedDirection { s, direction, weight: PIN_WEIGHT * last as f64 },
            None => WeightedDirection { s, direction: sample.direction, weight },
        }
    };
    samples.iter().enumerate().map(one).collect()
}

/// One least squares step: `[p, q, d, h, r]`.
fn solve_linearised(samples: &[WeightedDirection], axis: DVec3, zero: DVec3) -> [f64; UNKNOWNS] {
    let square = axis.cross(zero);
    let mut normal = [[0.0; UNKNOWNS + 1]; UNKNOWNS];
    let mut previous_hour_angle: Option<f64> = None;
    for &WeightedDirection { s, direction, weight } in samples {
        let declination = direction.dot(axis).clamp(-1.0, 1.0).asin();
        let wrapped = direction.dot(square).atan2(direction.dot(zero));
        let hour_angle = previous_hour_angle.map_or(wrapped, |h| h + (wrapped - h + PI).rem_euclid(TAU) - PI);
        previous_hour_angle = Some(hour_angle);
        let ((sin_d, cos_d), (sin_h, cos_h)) = (declination.sin_cos(), hour_angle.sin_cos());
        add_row(&mut normal, weight, [sin_h, -cos_h, 1.0, 0.0, 0.0], declination);
        add_row(&mut normal, weight, [-sin_d * cos_h, -sin_d * sin_h, 0.0, cos_d, cos_d * s], cos_d * hour_angle);
    }
    normal[0][0] += TILT_DAMPING * samples.len() as f64;
    normal[1][1] += TILT_DAMPING * samples.len() as f64;
    solve(normal)
}

fn add_row(normal: &mut [[f64; UNKNOWNS + 1]; UNKNOWNS], weight: f64, row: [f64; UNKNOWNS], value: f64) {
    for (equation, &factor) in normal.iter_mut().zip(&row) {
        for (sum, &term) in equation.iter_mut().zip(row.iter().chain([&value])) {
            *sum += weight * factor * term;
        }
    }
}

/// Gauss elimination of a positive definite system, right side in the last column.
fn solve(mut m: [[f64; UNKNOWNS + 1]; UNKNOWNS]) -> [f64; UNKNOWNS] {
    for pivot in 0..UNKNOWNS {
        let pivot_row = m[pivot];
        for (i, row) in m.iter_mut().enumerate() {
            if i != pivot {
                let factor = row[pivot] / pivot_row[pivot];
                for (value, &pivot_value) in row.iter_mut().zip(&pivot_row) {
                    *value -= factor * pivot_value;
                }
            }
        }
    }
    std::array::from_fn(|i| m[i][UNKNOWNS] / m[i][i])
}
