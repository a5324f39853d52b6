//! I1: nothing leaks out of a closed sphere, and a hole lets in what it should. I6: needles.

use glam::{DQuat, DVec3, Vec3};
use rayon::prelude::*;
use sunbake::atlas::SurfacePoint;
use sunbake::sun::{SunArc, SunPath};
use sunbake::testing::{SceneBuilder, icosphere};
use sunbake::visibility::{IntervalTable, Intervals};
use sunbake_tests::engines::{ALL, EXACT, assert_intervals};
use sunbake_tests::paths::{Random, SOLSTICE_DEG, arc_through};
use sunbake_tests::{Traced, path_of};

/// A small triangle below everything: the one whose rays points in the air borrow.
const PEDESTAL: usize = 0;

fn above_a_pedestal(triangles: &[[Vec3; 3]]) -> Traced {
    let pedestal = [Vec3::new(-0.1, -1.5, -0.1), Vec3::new(0.0, -1.5, 0.1), Vec3::new(0.1, -1.5, -0.1)];
    Traced::new(SceneBuilder::new().soup(&[pedestal]).soup(triangles).build())
}

/// 5,120 triangles, turned at random.
fn sphere(random: &mut Random) -> Vec<[Vec3; 3]> {
    let turn = DQuat::from_axis_angle(random.direction(), random.range(0.0, 6.0));
    icosphere(4).iter().map(|t| t.map(|v| (turn * v.as_dvec3()).as_vec3())).collect()
}

/// I1.
#[test]
fn no_light_enters_a_closed_sphere() {
    let mut random = Random::new(1);
    let here = above_a_pedestal(&sphere(&mut random));
    for _ in 0..1_000 {
        let point = inside(&here, &mut random);
        let path = random.path();
        for engine in ALL {
            assert_eq!(engine.lit(&here, &path, &point), Intervals::never(), "{point:?} along {path:?}");
        }
    }
}

fn inside(here: &Traced, random: &mut Random) -> SurfacePoint {
    here.observer(random.cube() * 0.57, random.direction(), PEDESTAL)
}

/// I1: a hundred thousand points, of which every hundred share a path: neighbours seed each other, as they do in a
/// bake.
#[test]
fn no_light_enters_a_closed_sphere_at_any_of_very_many_points() {
    let mut random = Random::new(9);
    let here = above_a_pedestal(&sphere(&mut random));
    let draws: Vec<(SunPath, Vec<SurfacePoint>)> =
        (0..1_000).map(|_| (random.path(), (0..100).map(|_| inside(&here, &mut random)).collect())).collect();
    let lit = draws.par_iter().map(|(path, points)| {
        let engine = (EXACT.make)(&here.tracer, std::slice::from_ref(path));
        let mut answers = IntervalTable::default();
        engine.session().lit(points, &mut answers);
        let leak = answers.iter().zip(points).find(|(found, _)| *found != Intervals::never());
        assert_eq!(leak, None, "along {path:?}");
        answers.iter().count()
    });
    assert_eq!(lit.sum::<usize>(), 100_000);
}

/// I1: suns that pass exactly through a corner or along an edge of the sphere.
#[test]
fn no_light_enters_along_a_shared_edge() {
    let mut random = Random::new(2);
    let triangles = sphere(&mut random);
    let here = above_a_pedestal(&triangles);
    for _ in 0..500 {
        let [a, b, _] = triangles[random.index(triangles.len())].map(|v| v.as_dvec3());
        let point = here.observer(random.cube() * 0.5, DVec3::Y, PEDESTAL);
        let from = origin(&here, &point) + here.scene.centre_m;
        let [to_a, to_b] = [a, b].map(|corner| (corner - from).normalize());
        let along_the_edge = arc_through(to_a, to_a.cross(to_b), 0.0, [-0.3, 0.3]);
        let through_a_corner = arc_through(to_a, random.direction(), SOLSTICE_DEG, [-1.0, 1.0]);
        for path in [along_the_edge, through_a_corner].map(path_of) {
            for engine in ALL {
                assert_eq!(engine.lit(&here, &path, &point), Intervals::never(), "{point:?} along {path:?}");
            }
        }
    }
}

/// Where rays start, in bake space.
fn origin(here: &Traced, point: &SurfacePoint) -> DVec3 {
    here.tracer.lift(point.position_m, point.normal, point.triangle)
}

/// When the sun is behind a convex outline, given by its corners in bake space seen from `origin`.
fn behind(path: &SunPath, origin: DVec3, outline: &[DVec3]) -> Intervals {
    let middle = outline.iter().sum::<DVec3>() / outline.len() as f64 - origin;
    let planes = (0..outline.len()).map(|i| {
        let normal = (outline[i] - origin).cross(outline[(i + 1) % outline.len()] - origin);
        normal * normal.dot(middle).signum()
    });
    planes.fold(Intervals::always(), |behind, normal| behind.intersection(&path.above_plane(normal)))
}

/// I1.
#[test]
fn a_hole_lights_just_while_the_sun_is_in_it() {
    let mut random = Random::new(3);
    let mut long_enough = 0;
    for _ in 0..40 {
        let mut triangles = sphere(&mut random);
        let hole = triangles.swap_remove(random.index(triangles.len())).map(|v| v.as_dvec3());
        let here = above_a_pedestal(&triangles);
        // As the scene holds it: rounded in bake space.
        let outline = hole.map(|corner| (corner - here.scene.centre_m).as_vec3().as_dvec3());
        for _ in 0..5 {
            let point = here.observer(random.cube() * 0.5, DVec3::Y, PEDESTAL);
            let from = origin(&here, &point);
            let to_hole = (outline[0].lerp(outline[1], random.unit()).lerp(outline[2], 0.4) - from).normalize();
            let declination_deg = [0.0, SOLSTICE_DEG, -SOLSTICE_DEG][random.index(3)];
            let path = path_of(arc_through(to_hole, random.direction(), declination_deg, [-1.5, 1.5]));
            let up = path.above_horizon(DVec3::Y);
            let expected = behind(&path, from, &outline).intersection(&up);
            for engine in ALL {
                let found = engine.lit(&here, &path, &point);
                assert_intervals(
                    "a hole",
                    &found,
                    &expected,
                    (engine.edge_t)(&path) + 1e-9,
                    2.0 * engine.blind_interval_t,
                );
            }
            long_enough += u32::from(expected.lit_length() > 2.0 * EXACT.blind_interval_t);
        }
    }
    assert!(long_enough >= 60, "only {long_enough} holes let in light for long");
}

/// I6: a needle 1e-3 wide and 2 m tall at 50 m, and a sun at 30 degrees that passes behind it in 0.3 seconds.
#[test]
fn a_needle_hides_the_sun_for_a_third_of_a_second() {
    let (elevation, distance_m) = (30f64.to_radians(), 50.0);
    let needle = |azimuth_rad: f64| {
        let at = |side: f64, height: f64| {
            let azimuth_rad = azimuth_rad + side * 0.5e-3 / distance_m;
            let level = DVec3::new(azimuth_rad.cos(), 0.0, azimuth_rad.sin()) * distance_m * elevation.cos();
            (level + DVec3::Y * (height + distance_m * elevation.sin())).as_vec3()
        };
        [at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)]
    };
    let mut tried = 0;
    for azimuth_rad in [0.0, 0.7, 2.0, std::f64::consts::PI, -2.3] {
        let corners @ [a, b, c, d] = needle(azimuth_rad);
        let here = above_a_pedestal(&[[a, b, c], [a, c, d]]);
        let point = here.observer(DVec3::ZERO, DVec3::Y, PEDESTAL);
        let outline = corners.map(|corner| corner.as_dvec3() - here.scene.centre_m);
        for minutes in [0.5, 5.0, 720.0] {
            let path = turning_for(minutes, azimuth_rad, elevation);
            let dark = behind(&path, origin(&here, &point), &outline);
            let seconds = dark.lit_length() * minutes * 60.0;
            assert!((0.25..0.35).contains(&seconds), "the needle hides {seconds} s");
            if dark.lit_length() <= 2.0 * EXACT.blind_interval_t {
                continue;
            }
            tried += 1;
            let [start, end] = dark.as_slice()[0];
            let expected = Intervals::from_unsorted(vec![[0.0, start], [end, 1.0]]);
            let found = EXACT.lit(&here, &path, &point);
            assert_intervals(&format!("{minutes} minutes"), &found, &expected, (EXACT.edge_t)(&path) + 1e-9, 0.0);
            assert_eq!(found.as_slice().len(), 2);
        }
    }
    assert!(tried >= 5, "only {tried} needles lasted");
}

/// The sun at one height, turning as the real one does, for so long about an azimuth (from +X to +Z).
fn turning_for(minutes: f64, azimuth_rad: f64, elevation_rad: f64) -> SunPath {
    let half_rad = minutes / 1440.0 * std::f64::consts::PI;
    let (sin, cos) = azimuth_rad.sin_cos();
    let arc = SunArc {
        axis: -DVec3::Y,
        zero: DVec3::new(cos, 0.0, sin),
        declination_rad: -elevation_rad,
        // Not symmetric: the needle should not stand just between two suns.
        hour_angle_rad: [-half_rad * 0.9, half_rad * 1.1],
        t: [0.0, 1.0],
    };
    SunPath::new(vec![arc], 0.0, minutes).expect("the arc is well formed")
}
