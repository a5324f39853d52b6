//! The tracer against brute force, at edges, at any size.

use super::*;
use crate::testing::{SceneBuilder, pseudo_random};

fn traced(builder: SceneBuilder) -> Tracer {
    let scene = builder.build();
    Tracer::new(&scene, &Geometry::new(&scene))
}

/// A sphere of `20 * 4^level` triangles.
fn sphere(level: u32) -> Vec<[Vec3; 3]> {
    crate::testing::icosphere(level)
}

/// I1.
#[test]
fn no_ray_slips_out_of_a_closed_sphere() {
    let triangles = sphere(4);
    let tracer = traced(SceneBuilder::new().soup(&triangles));
    let mut state = 7;
    let mut random = || 2.0 * pseudo_random(&mut state) - 1.0;
    for _ in 0..20_000 {
        let origin = DVec3::new(random(), random(), random()) * 0.5;
        // Towards corners and points of edges, where leaks would be.
        let triangle = triangles[((random() * 0.5 + 0.5) * (triangles.len() - 1) as f64) as usize];
        let [a, b, _] = triangle.map(|v| v.as_dvec3());
        for target in [a, (a + b) * 0.5, a.lerp(b, 0.1)] {
            assert!(tracer.is_occluded(origin, &Direction::new((target - origin).normalize())));
        }
    }
}

#[test]
fn the_nearest_hit_is_brute_force_nearest() {
    let mut state = 3;
    let mut random = || (2.0 * pseudo_random(&mut state) - 1.0) as f32;
    let triangles: Vec<[Vec3; 3]> = (0..300)
        .map(|_| {
            let centre = Vec3::new(random(), random(), random()) * 10.0;
            [0; 3].map(|_| centre + Vec3::new(random(), random(), random()))
        })
        .collect();
    let scene = SceneBuilder::new().soup(&triangles).build();
    let tracer = Tracer::new(&scene, &Geometry::new(&scene));
    for _ in 0..2000 {
        let origin = Vec3::new(random(), random(), random()).as_dvec3() * 12.0;
        let unit = Vec3::new(random(), random(), random()).as_dvec3().normalize();
        let hit = tracer.closest_hit(origin - scene.centre_m, &Direction::new(unit)).map(|h| h.distance_m);
        let expected = triangles.iter().filter_map(|t| moller_trumbore(origin, unit, t)).reduce(f64::min);
        match (hit, expected) {
            (None, None) => {}
            (Some(found), Some(distance)) => assert!((found - distance).abs() < 1e-5, "{found} {distance}"),
            _ => panic!("{hit:?} against {expected:?}"),
        }
    }
}

fn moller_trumbore(origin: DVec3, unit: DVec3, triangle: &[Vec3; 3]) -> Option<f64> {
    let [a, b, c] = triangle.map(|v| v.as_dvec3());
    let (e1, e2) = (b - a, c - a);
    let p = unit.cross(e2);
    let inverse = 1.0 / e1.dot(p);
    let u = (origin - a).dot(p) * inverse;
    let q = (origin - a).cross(e1);
    let (v, t) = (unit.dot(q) * inverse, e2.dot(q) * inverse);
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0).then_some(t)
}

/// I2.
#[test]
fn a_ray_in_a_triangles_plane_or_from_its_corner_gives_no_nan() {
    let triangle = [Vec3::ZERO, Vec3::X, Vec3::Z];
    let tracer = traced(SceneBuilder::new().soup(&[triangle]));
    for unit in [DVec3::X, -DVec3::X, DVec3::Z, DVec3::new(1.0, 0.0, 1.0).normalize()] {
        assert!(!tracer.is_occluded(DVec3::new(-1.5, 0.0, -0.3), &Direction::new(unit)));
    }
    for corner in triangle {
        let origin = tracer.lift(corner.as_dvec3() - DVec3::new(0.5, 0.0, 0.5), DVec3::Y, 0);
        assert!(!tracer.is_occluded(origin, &Direction::new(DVec3::Y)));
        assert!(tracer.is_occluded(origin, &Direction::new(-DVec3::Y)));
    }
}

#[test]
fn an_empty_scene_hides_nothing() {
    assert!(!traced(SceneBuilder::new()).is_occluded(DVec3::ZERO, &Direction::new(DVec3::Y)));
}

#[test]
fn size_does_not_change_what_is_hit() {
    for exponent in [-4, 0, 4] {
        let size = 10f32.powi(exponent);
        let scaled: Vec<_> = sphere(2).iter().map(|t| t.map(|v| v * size)).collect();
        let tracer = traced(SceneBuilder::new().soup(&scaled));
        let hit = tracer.closest_hit(DVec3::ZERO, &Direction::new(DVec3::new(0.3, 0.8, -0.5).normalize()));
        let distance = hit.map_or(0.0, |h| h.distance_m) / f64::from(size);
        assert!((0.94..=1.0).contains(&distance), "{distance} at size {size}");
    }
}
