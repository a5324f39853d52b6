//! Closed-form half-space times against sampling the arc.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec3;

use super::super::SunArc;
use super::Random;

fn random_arc(random: &mut Random) -> SunArc {
    let axis = random.direction();
    let zero = axis.any_orthonormal_vector();
    let declination_rad = match (random.unit() * 4.0) as u32 {
        0 => 0.0,
        1 => random.range(-FRAC_PI_2, FRAC_PI_2),
        _ => random.range(-0.41, 0.41),
    };
    let h0 = random.range(-10.0, 10.0);
    let length = random.unit().powi(2) * 3.0 * TAU + 1e-6;
    let t0 = random.unit() * 0.5;
    SunArc { axis, zero, declination_rad, hour_angle_rad: [h0, h0 + length], t: [t0, t0 + random.range(1e-3, 0.5)] }
}

/// Normals that make trouble: along and across the axis, tangent to the cone, tiny, huge, zero.
fn random_normal(random: &mut Random, arc: &SunArc) -> DVec3 {
    let tangent = || {
        let cone = SunArc { declination_rad: arc.declination_rad - FRAC_PI_2, ..*arc };
        cone.direction_at_hour_angle(arc.hour_angle_rad[0] + 0.3)
    };
    match (random.unit() * 16.0) as u32 {
        0 => arc.axis,
        1 => -arc.axis,
        2 => arc.zero,
        3 => DVec3::ZERO,
        4 => tangent(),
        5 => -tangent(),
        6 => random.direction() * 1e-200,
        7 => random.direction() * 1e200,
        8 => DVec3::Y,
        _ => random.direction(),
    }
}

#[test]
fn a_hundred_thousand_arcs_and_normals_agree_with_sampling() {
    let mut random = Random::new(1);
    let mut compared = 0u64;
    for case in 0..100_000 {
        let arc = random_arc(&mut random);
        let normal = random_normal(&mut random, &arc);
        let intervals: Vec<[f64; 2]> = arc.half_space_intervals(normal).collect();
        for pair in intervals.windows(2) {
            assert!(pair[0][1] <= pair[1][0], "case {case}: {intervals:?} overlap or do not ascend");
        }
        for &[start, end] in &intervals {
            assert!(start < end && start >= arc.t[0] && end <= arc.t[1], "case {case}: {intervals:?} leave {arc:?}");
        }
        for i in 0..=40 {
            let t = (arc.t[0] + (arc.t[1] - arc.t[0]) * f64::from(i) / 40.0).min(arc.t[1]);
            let height = normal.normalize_or_zero().dot(arc.direction_at_hour_angle(arc.hour_angle_at(t)));
            if height.abs() < 1e-11 {
                continue;
            }
            let claimed = intervals.iter().any(|[start, end]| (*start..=*end).contains(&t));
            assert_eq!(claimed, height > 0.0, "case {case}: t {t}, height {height}, {arc:?}, {normal}, {intervals:?}");
            compared += 1;
        }
    }
    assert!(compared > 3_000_000, "only {compared} samples were far enough from the plane to compare");
}

fn arc(declination_rad: f64, hour_angle_rad: [f64; 2]) -> SunArc {
    SunArc { axis: DVec3::Z, zero: DVec3::X, declination_rad, hour_angle_rad, t: [0.0, 1.0] }
}

fn times(arc: &SunArc, normal: DVec3) -> Vec<[f64; 2]> {
    arc.half_space_intervals(normal).collect()
}

#[test]
fn edges_are_where_trigonometry_puts_them() {
    assert_eq!(times(&arc(0.0, [0.0, TAU]), DVec3::X).len(), 2);
    let [[a, b], [c, d]] = times(&arc(0.0, [0.0, TAU]), DVec3::X)[..] else { panic!("two pieces") };
    assert_eq!([a, d], [0.0, 1.0]);
    assert!((b - 0.25).abs() < 1e-15 && (c - 0.75).abs() < 1e-15, "{b} {c}");
    // Three turns: up once in each, and twice at the ends.
    assert_eq!(times(&arc(0.2, [0.0, 3.0 * TAU]), DVec3::X).len(), 4);
    assert_eq!(times(&arc(0.2, [-PI, 5.0 * PI]), DVec3::X).len(), 3);
}

#[test]
fn a_plane_square_to_the_axis_is_all_or_nothing() {
    for declination in [-1.5, -0.4, -1e-300, 1e-300, 0.4, 1.5] {
        let expected: &[[f64; 2]] = if declination > 0.0 { &[[0.0, 1.0]] } else { &[] };
        assert_eq!(times(&arc(declination, [-9.0, 9.0]), DVec3::Z), expected, "declination {declination}");
    }
    assert_eq!(times(&arc(0.0, [-9.0, 9.0]), DVec3::Z), [[0.0, 1.0]], "a plane that contains the arc is not above it");
}

/// I3.
#[test]
fn a_tangent_plane_touches_without_nan() {
    for declination in [-1.3f64, -0.4, 0.0, 0.4, 1.3] {
        for nudge in [-1e-9, -1e-16, 0.0, 1e-16, 1e-9] {
            for sign in [-1.0, 1.0] {
                let tilt = FRAC_PI_2 - declination + nudge;
                let normal = DVec3::new(-tilt.sin(), 0.0, tilt.cos()) * sign;
                let pieces = times(&arc(declination, [-4.0, 4.0]), normal);
                assert!(pieces.iter().flatten().all(|t| t.is_finite()), "{declination} {nudge} {sign}: {pieces:?}");
            }
        }
    }
}

#[test]
fn numbers_that_are_not_finite_give_no_nan() {
    let bad = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0];
    for (x, y, z) in bad.into_iter().flat_map(|x| bad.into_iter().flat_map(move |y| bad.map(|z| (x, y, z)))) {
        for piece in times(&arc(0.3, [-3.0, 3.0]), DVec3::new(x, y, z)) {
            assert!(piece[0] < piece[1], "{x} {y} {z}: {piece:?}");
        }
    }
}
