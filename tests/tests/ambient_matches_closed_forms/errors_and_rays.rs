//! How large errors are with 256 rays, how fast they fall with more, and how a requested error is met.

use crate::{BOUND, POINTS, cases, ground};
use glam::{DVec3, Vec3};
use sunbake::ambient::{AmbientPoint, AmbientSettings};
use sunbake::testing::block;
use sunbake_tests::Traced;
use sunbake_tests::ambient::{ambient_at, ambient_visibility, flat, rays, rms};

/// Of the line nearest to points, by least squares.
fn slope(points: &[(f64, f64)]) -> f64 {
    let count = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum::<f64>() / points.iter().map(|p| (p.0 - x).powi(2)).sum::<f64>()
}

#[test]
fn ambient_visibility_matches_geometry() {
    for case in cases() {
        let errors = case.errors(rays(256));
        let worst = errors.iter().fold(0.0f64, |worst, error| worst.max(error.abs()));
        let typical = rms(errors.iter().copied());
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        println!("{:<24} worst {worst:.4}  rms {typical:.4}  mean {mean:+.5}", case.name);
        assert!(worst <= BOUND[0] && typical <= BOUND[1], "{}: {worst}, {typical}", case.name);
        // Over 256 points errors cancel: what is left would be a bias.
        assert!(mean.abs() <= 4.0 * BOUND[1] / (POINTS as f64).sqrt(), "{}: biased by {mean}", case.name);
        if matches!(case.name, "open plane" | "flat fold") {
            assert_eq!(worst, 0.0, "{}: nothing hides anything", case.name);
        }
    }
}

#[test]
fn errors_fall_at_least_as_the_power_of_rays_of_seven_tenths() {
    for case in cases().into_iter().filter(|case| case.expected.iter().any(|&open| open < 1.0)) {
        let at = |bits: u32| (f64::from(bits), rms(case.errors(rays(1 << bits)).into_iter()).log2());
        let power = slope(&(2..=12).map(at).collect::<Vec<_>>());
        println!("{:<24} rms falls as N^{power:.2}", case.name);
        assert!(power <= -0.7, "{}: N^{power}", case.name);
    }
}

#[test]
fn a_requested_error_is_met_with_few_rays_where_few_suffice() {
    for error in [0.05, 0.02, 0.01] {
        let (mut within, mut all) = (0, 0);
        for case in cases() {
            let settings = AmbientSettings { error: Some(error), ..rays(4096) };
            let errors = case.errors(settings);
            let of_case = errors.iter().filter(|e| e.abs() <= error).count();
            assert!(of_case * 100 >= 95 * errors.len(), "{}: {of_case} of {} within {error}", case.name, errors.len());
            (within, all) = (within + of_case, all + errors.len());
            if case.name == "open plane" {
                let (_, traced) = ambient_at(&case.traced, &case.points, settings);
                assert!(traced <= 64 * POINTS as u64, "{traced} rays for an open plane");
            }
        }
        let share = within as f64 / all as f64;
        println!("to {error}: {share:.4} of the points are within");
        assert!(share >= 0.95, "{share} within {error}");
    }
}

#[test]
fn a_hard_texel_among_easy_ones_gets_its_rays() {
    // Fifteen points in the open, and one beside a wall and under bars, again and again.
    let wall = block(Vec3::new(-0.2, 0.0, -40.0), Vec3::new(0.0, 1.5, 40.0));
    let bars: Vec<[Vec3; 3]> = (0..40)
        .flat_map(|i| block(Vec3::new(0.1 * i as f32, 1.0, -40.0), Vec3::new(0.1 * i as f32 + 0.04, 1.05, 40.0)))
        .collect();
    let traced = Traced::new(ground().soup(&wall).soup(&bars).build());
    let place = |i: usize| match i % 16 {
        7 => DVec3::new(0.6, 0.0, 0.02 * (i / 16) as f64),
        _ => DVec3::new(900.0, 0.0, 0.1 * i as f64),
    };
    let points: Vec<AmbientPoint> = (0..4096).map(|i| flat(traced.point_at(place(i), 0))).collect();
    let truth = ambient_visibility(&traced, &points[7..8], rays(65_536))[0];
    for error in [0.05, 0.02] {
        let found = ambient_visibility(&traced, &points, AmbientSettings { error: Some(error), ..rays(4096) });
        let hard: Vec<f64> = found.iter().skip(7).step_by(16).map(|open| (open - truth).abs()).collect();
        let within = hard.iter().filter(|off| **off <= error).count() as f64 / hard.len() as f64;
        println!("to {error}: {within:.3} of the hard ones are within");
        // One draw of the error, or two, are all that tells a lone one: pooling over its neighbours alone kept 59 of
        // 100.
        assert!(within >= 0.8, "{within} within {error}");
    }
}

#[test]
fn symmetric_scenes_read_alike_on_both_sides() {
    let post = block(Vec3::new(-0.3, 0.0, -0.3), Vec3::new(0.3, 2.0, 0.3));
    let traced = Traced::new(ground().soup(&post).build());
    let read = |sign_x: f64, sign_z: f64, swap: bool| {
        let place = |i: usize| {
            let (x, z) = (0.4 + 0.01 * (i % 64) as f64, 0.05 * (i / 64) as f64);
            let (x, z) = if swap { (z, x) } else { (x, z) };
            flat(traced.point_at(DVec3::new(sign_x * x, 0.0, sign_z * z), 0))
        };
        ambient_visibility(&traced, &(0..512).map(place).collect::<Vec<_>>(), rays(256))
    };
    let one = read(1.0, 1.0, false);
    for (sign_x, sign_z, swap) in [(-1.0, 1.0, false), (1.0, -1.0, false), (1.0, 1.0, true), (-1.0, -1.0, true)] {
        let other = read(sign_x, sign_z, swap);
        let differences = one.iter().zip(&other).map(|(a, b)| a - b);
        let mean = differences.clone().sum::<f64>() / 512.0;
        assert!(rms(differences.clone()) < 0.014 && mean.abs() < 0.002, "{} {mean}", rms(differences));
    }
}
