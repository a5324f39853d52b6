//! I2, I3 and I5: triangles where the point, the axis or the cone of the sun makes them awkward.

use glam::{DVec3, Vec3};
use sunbake::sun::SunArc;
use sunbake::testing::{SceneBuilder, block};
use sunbake_tests::engines::{ALL, EXACT, all_must_agree};
use sunbake_tests::paths::{Random, SOLSTICE_DEG, arc_through, of_every_kind};
use sunbake_tests::{Traced, over_the_top, path_of};

const PEDESTAL: usize = 0;

/// Triangles, and a pedestal 5 m below the origin of world space, which is that of bake space too.
fn around_the_origin(triangles: &[[Vec3; 3]]) -> Traced {
    let pedestal = [Vec3::new(-0.1, -5.0, -0.1), Vec3::new(0.0, -5.0, 0.1), Vec3::new(0.1, -5.0, -0.1)];
    // Far corners keep the bounding box, and with it bake space, centred.
    let corners = [Vec3::splat(-8.0), Vec3::splat(8.0)].map(|c| [c, c + Vec3::Y * 1e-3, c + Vec3::Z * 1e-3]);
    let frame = [corners[0], corners[1].map(|v| v - Vec3::new(0.0, 1e-3, 1e-3))];
    let here = Traced::new(SceneBuilder::new().soup(&[pedestal]).soup(&frame).soup(triangles).build());
    assert!(here.scene.centre_m.length() < 1e-3, "{}", here.scene.centre_m);
    here
}

/// Where rays of a point at the origin with a level plane start, in world space.
fn origin(here: &Traced) -> DVec3 {
    let point = here.observer(DVec3::ZERO, DVec3::Y, PEDESTAL);
    here.tracer.lift(point.position_m, point.normal, PEDESTAL as u32) + here.scene.centre_m
}

/// I2.
#[test]
fn triangles_through_the_point_hide_what_brute_force_says() {
    let at_the_start = origin(&around_the_origin(&[])).as_vec3();
    let wall = |x: f32| [Vec3::new(x, -1.0, -1.0), Vec3::new(x, 2.0, 0.1), Vec3::new(x, -1.0, 1.5)];
    let moved = |by: Vec3| wall(0.0).map(|v| v + by);
    let named: [(&str, [Vec3; 3]); 8] = [
        ("containing the surface point", wall(0.0)),
        ("a nanometre in front of it", wall(1e-9)),
        ("a tenth of a millimetre in front of it", wall(1e-4)),
        ("containing the ray's start", moved(at_the_start)),
        ("a corner at the surface point", moved(Vec3::new(0.0, 1.0, 1.0))),
        ("in a plane with the point, above it", moved(Vec3::new(0.0, 3.0, 0.0))),
        ("in a plane with the point, beside it", moved(Vec3::new(0.0, 0.5, 2.5))),
        ("lying on the point", [Vec3::new(-1.0, 0.0, -1.0), Vec3::new(1.0, 0.0, -1.0), Vec3::new(0.0, 0.0, 2.0)]),
    ];
    for (name, triangle) in named {
        let here = around_the_origin(&[triangle]);
        let points: Vec<_> = [DVec3::Y, DVec3::new(0.3, 0.9, 0.1).normalize(), DVec3::new(-0.9, 0.3, 0.2).normalize()]
            .map(|normal| here.observer(DVec3::ZERO, normal, PEDESTAL))
            .to_vec();
        for (kind, path) in of_every_kind() {
            all_must_agree(&format!("{name}, {kind}"), &here, &path, &points);
        }
    }
}

/// I2 and I3, where rounding decides: any answer will do, so long as it is one and always the same.
#[test]
fn suns_in_a_triangles_plane_and_corners_at_the_rays_start_give_well_formed_answers() {
    let start = origin(&around_the_origin(&[])).as_vec3();
    let corner = [start, start + Vec3::new(1.0, 1.0, 0.0), start + Vec3::new(0.2, 1.0, 1.0)];
    let edge_on = [Vec3::new(1.0, 1.0, 0.0), Vec3::new(2.0, 1.0, 0.0), Vec3::new(0.0, 3.0, 0.0)];
    let here = around_the_origin(&[corner, edge_on]);
    let point = here.observer(DVec3::ZERO, DVec3::Y, PEDESTAL);
    for path in [over_the_top(DVec3::X), over_the_top(-DVec3::X), over_the_top(DVec3::Z)] {
        for engine in ALL {
            let found = engine.lit(&here, &path, &point);
            assert!(found.as_slice().iter().flatten().all(|t| (0.0..=1.0).contains(t)), "{found:?}");
            assert_eq!(found, engine.lit(&here, &path, &point));
        }
    }
}

/// I3: a board of two triangles whose shared edge touches the sun's cone hides it in one piece.
#[test]
fn an_edge_tangent_to_the_suns_cone_leaves_no_gap() {
    let mut random = Random::new(4);
    let mut hidden = 0;
    for nudge in [-1e-6, -1e-9, -1e-15, 0.0, 1e-15, 1e-9, 1e-6] {
        for declination_deg in [SOLSTICE_DEG, -SOLSTICE_DEG, 50.0] {
            let middle = (random.direction() + DVec3::Y * 2.0).normalize();
            let arc = arc_through(middle, random.direction(), declination_deg, [-1.2, 1.2]);
            let here = around_the_origin(&board_with_a_tangent_edge(&arc, nudge));
            let point = here.observer(DVec3::ZERO, middle, PEDESTAL);
            let path = path_of(arc);
            all_must_agree("a tangent edge", &here, &path, &[point]);
            let around = EXACT.lit(&here, &path, &point);
            assert!(!around.contains(0.5), "{nudge}, {declination_deg}: {around:?}");
            let gaps = around.as_slice().iter().filter(|[a, b]| *a > 0.4 && *b < 0.6).count();
            assert_eq!(gaps, 0, "{nudge}, {declination_deg}: {around:?}");
            hidden += 1;
        }
    }
    assert_eq!(hidden, 21);
}

/// A square board across the direction at hour angle 0, cut in two along the great circle that touches the cone there.
fn board_with_a_tangent_edge(arc: &SunArc, nudge: f64) -> [[Vec3; 3]; 2] {
    let middle = arc.direction_at_hour_angle(0.0);
    let along = arc.axis.cross(middle).normalize();
    let across = middle.cross(along);
    let at = |a: f64, b: f64| ((middle + along * a + across * (b + nudge)) * 4.0).as_vec3();
    let [left, right] = [at(-0.3, 0.0), at(0.3, 0.0)];
    [[left, right, at(0.0, 0.3)], [right, left, at(0.0, -0.3)]]
}

/// I5: the axis through a triangle, boxes around the point, boxes across the cut of the angle.
#[test]
fn boxes_around_the_point_and_the_axis_hide_what_brute_force_says() {
    let mut random = Random::new(5);
    for case in 0..40 {
        let boxes: Vec<[Vec3; 3]> = (0..6)
            .flat_map(|_| {
                let middle = (random.cube() * 4.0).as_vec3();
                let half = (random.cube().abs() * 1.5 + 0.02).as_vec3();
                block(middle - half, middle + half)
            })
            .collect();
        // A long thin triangle makes boxes of the hierarchy that hold the point without hiding anything.
        let sliver = [Vec3::splat(-6.0), Vec3::splat(6.0), Vec3::new(6.0, 6.0, 6.1)];
        let here = around_the_origin(&[&boxes[..], &[sliver]].concat());
        let middle = boxes[0].iter().chain(&boxes[1]).fold(Vec3::ZERO, |sum, v| sum + *v).as_dvec3() / 6.0;
        let axis = (middle - random.cube() * 0.1).normalize();
        let zero = axis.any_orthonormal_vector();
        for declination_rad in [0.0, 0.4, 1.2, 1.5] {
            let start_rad = random.range(-7.0, 7.0);
            let hour_angle_rad = [start_rad, start_rad + random.range(1.0, 6.2)];
            let path = path_of(SunArc { axis, zero, declination_rad, hour_angle_rad, t: [0.0, 1.0] });
            let points: Vec<_> =
                (0..3).map(|_| here.observer(random.cube() * 0.2, random.direction(), PEDESTAL)).collect();
            all_must_agree(&format!("case {case}, declination {declination_rad}"), &here, &path, &points);
        }
    }
}
