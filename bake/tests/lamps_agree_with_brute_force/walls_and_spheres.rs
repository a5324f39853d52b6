//! Walls, doorways, planes and a closed sphere.

use crate::brute_force::{Here, STEPS, agree};
use crate::{ground, wall};
use glam::{DVec3, Vec2, Vec3};
use sunbake::atlas::SurfacePoint;
use sunbake::testing::{SceneBuilder, floor, icosphere, opaque};
use sunbake::visibility::{Intervals, LampEngine, lit_at};

#[test]
fn a_lamp_passes_behind_a_wall() {
    let here = Here::new(SceneBuilder::new().soup(&ground()).soup(&wall([-1.0, 0.0], [1.0, 3.0], 0.0)));
    let lamp = here.lamp(&[[-6.0, 1.0, -2.0], [6.0, 1.0, -2.0]]);
    agree("wall", &here, &lamp, &here.points(2, 60, 1));
    // Straight through: from (0, 0, 2), edges at x = -1 and 1 hide x = -2 and 2 of the lamp's line.
    let mut point = here.point(0, [0.3, 0.3]);
    point.position_m = DVec3::new(0.0, 0.0, 2.0) - here.scene.centre_m;
    let lit = agree("wall, trigonometry", &here, &lamp, &[point]);
    let expected = [[0.0, 4.0 / 12.0], [8.0 / 12.0, 1.0]];
    for (found, expected) in lit[0].as_slice().iter().flatten().zip(expected.iter().flatten()) {
        assert!((found - expected).abs() < 1e-5, "{found} {expected}");
    }
}

#[test]
fn a_lamp_passes_a_doorway() {
    let door =
        [wall([-4.0, 0.0], [-0.5, 3.0], 0.0), wall([0.5, 0.0], [4.0, 3.0], 0.0), wall([-0.5, 2.0], [0.5, 3.0], 0.0)];
    let here = Here::new(SceneBuilder::new().soup(&ground()).soup(&door.concat()));
    // Along the wall, through the door and back outside of it.
    let lamp = here.lamp(&[[-4.0, 1.2, -1.5], [0.1, 1.0, -1.5], [0.1, 1.3, 1.7], [3.0, 1.6, -0.4]]);
    agree("doorway", &here, &lamp, &here.points(8, 16, 2));
}

#[test]
fn occluders_beyond_the_lamp_do_not_count() {
    let roof = ground().iter().map(|t| t.map(|v| v + Vec3::Y * 3.0)).collect::<Vec<_>>();
    let here =
        Here::new(SceneBuilder::new().soup(&ground()).soup(&roof).block(Vec3::new(3.0, 0.0, -5.0), Vec3::splat(4.5)));
    let below = here.lamp(&[[-4.0, 2.9, 1.0], [2.5, 2.5, -1.0]]);
    let answers = agree("below the roof", &here, &below, &here.points(2, 40, 3));
    let is_free = |(point, answer): &(SurfacePoint, Intervals)| {
        point.position_m.x + here.scene.centre_m.x < 2.9 && *answer != Intervals::always()
    };
    assert!(!here.points(2, 40, 3).into_iter().zip(answers).any(|pair| is_free(&pair)));
    let above = here.lamp(&[[-4.0, 3.1, 1.0], [2.5, 3.5, -1.0]]);
    assert!(agree("above the roof", &here, &above, &here.points(2, 40, 3)).iter().all(|a| *a == Intervals::never()));
}

#[test]
fn a_lamp_passes_through_what_it_meets() {
    let here =
        Here::new(SceneBuilder::new().soup(&ground()).block(Vec3::new(-1.0, 0.0, -1.0), Vec3::new(1.0, 2.0, 1.0)));
    let lamp = here.lamp(&[[-3.0, 1.0, 0.2], [3.0, 1.0, 0.2], [0.0, -1.0, 3.0], [0.0, 4.0, -1.5]]);
    agree("through a box", &here, &lamp, &here.points(14, 8, 4));
    let through_points = here.points(2, 10, 5);
    let target = through_points[3].position_m + here.scene.centre_m;
    let lamp = here.lamp(&[[-2.0, 3.0, 1.0], target.to_array(), [1.0, 2.5, 1.0]]);
    agree("onto a point", &here, &lamp, &through_points);
}

#[test]
fn points_and_lamps_in_one_plane_or_line_agree() {
    let here = Here::new(
        SceneBuilder::new()
            .soup_of(&ground(), sunbake::scene::Material { is_double_sided: true, ..opaque() })
            .block(Vec3::new(-1.0, 0.0, -1.0), Vec3::new(1.0, 2.0, 1.0)),
    );
    // In the ground's plane, in a side's plane, along an edge, straight away from a point, and back through it.
    let point = here.point(0, [0.25, 0.25]);
    let at = (point.position_m + here.scene.centre_m).to_array();
    let up = |y: f64| [at[0], at[1] + y, at[2]];
    for (name, places) in [
        ("in the ground", [[-4.0, 0.0, 3.0], [4.0, 0.0, 3.5]]),
        ("in a side", [[-4.0, 1.0, 1.0], [4.0, 1.0, 1.0]]),
        ("along an edge", [[-4.0, 2.0, 1.0], [4.0, 2.0, 1.0]]),
        ("away from a point", [up(0.5), up(3.0)]),
        ("through a point", [up(-1.0), up(3.0)]),
    ] {
        let mut points = here.points(14, 6, 6);
        points.push(point);
        agree(name, &here, &here.lamp(&places), &points);
    }
}

#[test]
fn a_closed_sphere_keeps_its_light() {
    let sphere = icosphere(3);
    let seat = floor(Vec2::splat(-0.3), Vec2::splat(0.3), -0.2);
    let here = Here::new(
        SceneBuilder::new()
            .soup_of(&seat, sunbake::scene::Material { is_double_sided: true, ..opaque() })
            .soup(&sphere),
    );
    let points = here.points(2, 40, 9);
    // A spiral around the sphere.
    let turn = |i: i32| (f64::from(i) * 0.5).sin_cos();
    let height = |i: i32| f64::from(i) / 12.0 - 2.5;
    let place = |i: i32| [3.0 * turn(i).0, height(i), 3.0 * turn(i).1];
    let around: Vec<[f64; 3]> = (0..=60).map(place).collect();
    let outside = agree("outside", &here, &here.lamp(&around), &points);
    assert!(outside.iter().all(|a| *a == Intervals::never()));
    // Rays from a point move along an edge of the sphere from corner to corner, and go on to the next.
    let from = points[7].position_m + here.scene.centre_m;
    let beyond = |corner: Vec3| (from + 3.0 * (corner.as_dvec3() - from)).to_array();
    for triangle in sphere.iter().step_by(29) {
        let lamp = here.lamp(&triangle.map(beyond));
        let engine = LampEngine::new(&here.tracer, &lamp);
        assert_eq!(lit_at(&engine, &points[7]), [Intervals::never()]);
    }
    let inside = here.lamp(&[[-0.4, 0.1, 0.2], [0.3, 0.5, -0.4], [0.2, 0.3, 0.6]]);
    assert!(agree("inside", &here, &inside, &points).iter().all(|a| *a == Intervals::always()));
    let leaving = here.lamp(&[[0.0, 0.4, 0.1], [0.3, 1.9, 0.2]]);
    let answers = agree("leaving", &here, &leaving, &points);
    assert!(answers.iter().all(|a| a.as_slice().len() == 1 && a.as_slice()[0][0] == 0.0 && a.lit_length() < 0.5));
}

/// Brute force cannot see what is shorter than its step; the exact engine does, and its answer is trigonometry's.
#[test]
fn shadows_shorter_than_a_step_are_found() {
    let wire = wall([-0.0001, 0.0], [0.0001, 3.0], 0.0);
    let here = Here::new(SceneBuilder::new().soup(&ground()).soup(&wire));
    let lamp = here.lamp(&[[-4.0, 1.0, -2.0], [4.0, 1.0, -2.0]]);
    let mut point = here.point(0, [0.3, 0.3]);
    point.position_m = DVec3::new(0.001, 0.0, 2.0) - here.scene.centre_m;
    let lit = agree("wire", &here, &lamp, &[point]);
    let ends: Vec<f64> = lit[0].as_slice().iter().flatten().copied().collect();
    // From (0.001, 0, 2) the wire's edges at x = ±0.0001 hide x = -0.001 ± 0.0002 of the lamp's line.
    let expected = [0.0, (4.0 - 0.0012) / 8.0, (4.0 - 0.0008) / 8.0, 1.0];
    assert_eq!(ends.len(), 4, "{ends:?}");
    for (found, expected) in ends.iter().zip(expected) {
        // Where the ray starts is off the ground by a lift of a few micrometres, and off the triangle's edges too.
        assert!((found - expected).abs() < 3e-6, "{ends:?}");
    }
    assert!(ends[2] - ends[1] < 1.0 / STEPS as f64);
}
