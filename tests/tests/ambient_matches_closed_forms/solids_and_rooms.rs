//! Ambient visibility in a closed box, on a wedge and on a sphere.

use crate::{BOUND, POINTS, ground};
use glam::{DVec3, Vec3};
use std::f64::consts::TAU;
use sunbake::ambient::{AmbientPoint, AmbientSettings};
use sunbake::testing::{SceneBuilder, block, icosphere};
use sunbake_tests::Traced;
use sunbake_tests::ambient::{ambient_visibility, flat, rays, rms};

#[test]
fn a_closed_box_is_dark_and_with_a_distance_only_its_corners_are() {
    let half = Vec3::new(1.0, 1.5, 2.0);
    // Turned inside out, as rooms are, and as they come.
    for is_room in [true, false] {
        let walls = block(-half, half);
        let walls = if is_room { sunbake_tests::flipped(&walls) } else { walls };
        let traced = Traced::new(SceneBuilder::new().soup(&walls).build());
        let normals: Vec<DVec3> =
            (0..12).map(|t| traced.geometry.normal(t) * if is_room { 1.0 } else { -1.0 }).collect();
        let inside = |i: usize| {
            let triangle = i % 12;
            let weights = [0.1 + 0.05 * (i % 7) as f64, 0.1 + 0.06 * (i % 5) as f64];
            let point = traced.point(triangle, weights);
            AmbientPoint {
                shading_normal: normals[triangle],
                surface: sunbake::atlas::SurfacePoint { normal: normals[triangle], ..point },
            }
        };
        let points: Vec<AmbientPoint> = (0..240).map(inside).collect();
        assert!(ambient_visibility(&traced, &points, rays(256)).iter().all(|&open| open == 0.0));
        let reach = 1.2;
        let found = ambient_visibility(&traced, &points, AmbientSettings { distance_m: Some(reach), ..rays(256) });
        for (point, found) in points.iter().zip(found) {
            let expected = visibility_in_box(point.surface.position_m, point.shading_normal, half.as_dvec3(), reach);
            assert!((found - expected).abs() < 0.02, "{found} for {expected}");
        }
    }
}

/// Ambient visibility inside a box within a distance, by a fine rule over the disc under the hemisphere.
fn visibility_in_box(from: DVec3, normal: DVec3, half: DVec3, reach: f64) -> f64 {
    let (across, up) = normal.any_orthonormal_pair();
    let (rings, spokes) = (200, 200);
    let mut hidden = 0.0;
    for ring in 0..rings {
        let radius = ((f64::from(ring) + 0.5) / f64::from(rings)).sqrt();
        for spoke in 0..spokes {
            let (sin, cos) = (f64::from(spoke) / f64::from(spokes) * TAU).sin_cos();
            let direction = across * (radius * cos) + up * (radius * sin) + normal * (1.0 - radius * radius).sqrt();
            let to_wall = |k: usize| {
                let along = direction[k];
                if along.abs() < 1e-12 { f64::INFINITY } else { (half[k] * along.signum() - from[k]) / along }
            };
            let distance = to_wall(0).min(to_wall(1)).min(to_wall(2)).max(0.0);
            hidden += (1.0 - (distance / reach).min(1.0).powi(2)).powi(2);
        }
    }
    1.0 - hidden / f64::from(rings * spokes)
}

#[test]
fn a_convex_solid_on_the_ground_sees_the_sky_by_its_slope() {
    // A wedge: its slope leans by 30, 45 and 70 degrees, its back stands upright.
    for degrees in [30.0f64, 45.0, 70.0] {
        let top = degrees.to_radians().tan() as f32;
        let [a, b] = [Vec3::ZERO, Vec3::X];
        let c = Vec3::new(1.0, top, 0.0);
        let deep = Vec3::Z * 3.0;
        let slope = [[a, a + deep, c + deep], [a, c + deep, c]];
        let back = [[b, c, c + deep], [b, c + deep, b + deep]];
        let ends = [[a, c, b], [a + deep, b + deep, c + deep]];
        let traced = Traced::new(ground().soup(&slope).soup(&back).soup(&ends).build());
        for (triangle, lean) in [(2, degrees), (4, 90.0)] {
            let points: Vec<AmbientPoint> =
                (0..POINTS).map(|i| flat(traced.point(triangle, [0.2 + 0.001 * i as f64, 0.3]))).collect();
            assert!(points[0].surface.normal.y >= -1e-6);
            let expected = (1.0 + lean.to_radians().cos()) / 2.0;
            let errors = ambient_visibility(&traced, &points, rays(256))
                .into_iter()
                .map(|open| open - expected)
                .collect::<Vec<_>>();
            assert!(rms(errors.iter().copied()) < BOUND[1], "{lean}: {}", rms(errors.iter().copied()));
        }
    }
}

#[test]
fn a_sphere_alone_reads_one_at_any_number_of_facets() {
    for level in [0, 1, 2] {
        let traced = Traced::new(SceneBuilder::new().soup(&icosphere(level)).build());
        let count = traced.geometry.triangles.len();
        let point = |i: usize| {
            let surface = traced.point(i % count, [0.1 + 0.013 * (i % 50) as f64, 0.1]);
            AmbientPoint { shading_normal: (surface.position_m + traced.scene.centre_m).normalize(), surface }
        };
        let points: Vec<AmbientPoint> = (0..1000).map(point).collect();
        assert!(ambient_visibility(&traced, &points, rays(64)).iter().all(|&open| open == 1.0), "level {level}");
    }
}
