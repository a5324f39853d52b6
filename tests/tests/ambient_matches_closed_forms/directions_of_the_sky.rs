//! Bent normals, and the sky in spherical harmonics.

use crate::{cases, fold, turned};
use glam::{DVec2, DVec3, Vec3};
use std::f64::consts::FRAC_PI_2;
use sunbake::ambient::{AmbientPoint, harmonics};
use sunbake_tests::Traced;
use sunbake_tests::ambient::{ambient_at, flat, rays};

#[test]
fn bent_normals_point_to_the_unoccluded_directions() {
    let open = &cases()[0];
    let (found, _) = ambient_at(&open.traced, &open.points, rays(256));
    assert!(found.iter().all(|e| e.bent.as_dvec3().distance(DVec3::Y * (2.0 / 3.0)) < 0.01));
    // Before an endless wall half of the disc under the hemisphere is free, and its centroid lies 4/(3 pi) off.
    let traced = Traced::new(fold(FRAC_PI_2).build());
    let points: Vec<AmbientPoint> = open
        .points
        .iter()
        .map(|p| flat(traced.point_at(p.surface.position_m + open.traced.scene.centre_m, 0)))
        .collect();
    let (found, _) = ambient_at(&traced, &points, rays(256));
    let expected = turned(Vec3::new(4.0 / (3.0 * std::f32::consts::PI), 2.0 / 3.0, 0.0)).as_dvec3();
    let worst = found.iter().map(|e| e.bent.as_dvec3().distance(expected)).fold(0.0, f64::max);
    assert!(worst < 0.03, "{worst}");
}

#[test]
fn sky_harmonics_are_the_integral_over_the_unoccluded_directions() {
    // In the open, degree by degree: 1, 2/3 and 1/4 of the functions at the normal (Ramamoorthi and Hanrahan, 2001).
    let open = &cases()[0];
    let (found, _) = ambient_at(&open.traced, &open.points, rays(1024));
    let at_normal = harmonics::basis(DVec3::Y);
    let shares = [1.0, 2.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0, 0.25, 0.25, 0.25, 0.25, 0.25];
    for estimate in &found {
        for k in 0..harmonics::COUNT {
            assert!((f64::from(estimate.sky[k]) - shares[k] * at_normal[k]).abs() < 0.01, "{k}");
        }
    }
    // Before a wall: by a fine rule over the free half of the disc.
    let traced = Traced::new(fold(FRAC_PI_2).build());
    let points: Vec<AmbientPoint> =
        (0..64).map(|i| flat(traced.point_at(turned(Vec3::new(1.0, 0.0, 0.1 * i as f32)).as_dvec3(), 0))).collect();
    let (found, _) = ambient_at(&traced, &points, rays(1024));
    let mut expected = [0.0; harmonics::COUNT];
    let steps = 400;
    let mut inside = 0;
    for i in 0..steps {
        for j in 0..steps {
            let disc = (DVec2::new(f64::from(i) + 0.5, f64::from(j) + 0.5) / f64::from(steps)) * 2.0 - 1.0;
            if disc.length_squared() < 1.0 {
                inside += 1;
                if disc.x > 0.0 {
                    let direction =
                        Vec3::new(disc.x as f32, (1.0 - disc.length_squared()).sqrt() as f32, disc.y as f32);
                    let direction = turned(direction).as_dvec3();
                    expected.iter_mut().zip(harmonics::basis(direction)).for_each(|(sum, value)| *sum += value);
                }
            }
        }
    }
    for (k, expected) in expected.map(|sum| sum / f64::from(inside)).into_iter().enumerate() {
        let mean = found.iter().map(|e| f64::from(e.sky[k])).sum::<f64>() / found.len() as f64;
        assert!((mean - expected).abs() < 0.003, "{k}: {mean} for {expected}");
    }
}
