//! Hard cases B1, B5, B6, B8 and B10 at the level of single points: what a shadow ray may and may not see, by rays
//! and by the exact engine.

use glam::{DVec3, Vec2, Vec3};
use sunbake::scene::Material;
use sunbake::testing::{SceneBuilder, block, floor, icosphere, opaque};
use sunbake_tests::{Traced, flipped, over_the_top, standing};

const FLOOR: usize = 0;

fn a_floor() -> Vec<[Vec3; 3]> {
    floor(Vec2::splat(-10.0), Vec2::splat(10.0), 0.0)
}

/// B1.
#[test]
fn no_sun_at_or_below_the_horizon_lights_anything() {
    let here = Traced::new(SceneBuilder::new().soup(&a_floor()).build());
    let point = here.point(FLOOR, [0.3, 0.3]);
    for azimuth_deg in (0..360).step_by(15) {
        let (sin, cos) = f64::from(azimuth_deg).to_radians().sin_cos();
        for (elevation_deg, expected) in [(-0.01f64, 0.0), (0.01, 1.0), (-90.0, 0.0), (90.0, 1.0)] {
            let (up, level) = elevation_deg.to_radians().sin_cos();
            let path = standing(DVec3::new(cos * level, up, sin * level));
            for (lit, _) in here.lit_by_both(&path, 16, &point) {
                let off = (lit.lit_length() - expected).abs();
                assert!(off <= 1e-12, "azimuth {azimuth_deg}, elevation {elevation_deg}: {lit:?}");
            }
        }
    }
    for axis in [DVec3::X, -DVec3::X, DVec3::Z, -DVec3::Z, -DVec3::Y] {
        for (lit, _) in here.lit_by_both(&standing(axis), 16, &point) {
            assert!(lit.lit_length() < 1.0, "{axis} lights the floor for {}", lit.lit_length());
        }
    }
}

/// B6: the floor behind a wall is lit just from when the sun stands above the wall's top, at any distance from its
/// foot.
#[test]
fn light_does_not_leak_under_a_wall_at_any_distance_or_height() {
    let (height, thickness) = (2.0, 0.2);
    let wall = block(Vec3::new(-thickness, 0.0, -10.0), Vec3::new(0.0, height, 10.0));
    let sheet: Vec<_> = floor(Vec2::new(0.0, -10.0), Vec2::new(height, 10.0), 0.0)
        .iter()
        .map(|t| t.map(|v| Vec3::new(0.0, v.x, v.z)))
        .collect();
    for (name, wall, top_x) in [("block", wall, -f64::from(thickness)), ("sheet", sheet, 0.0)] {
        let here = Traced::new(SceneBuilder::new().soup(&a_floor()).soup(&wall).build());
        // The sun rises behind the wall, at -X.
        let path = over_the_top(-DVec3::X);
        for exponent in 0..12 {
            let distance_m = 4.0 * 0.3f64.powi(exponent);
            for z in [-3.1, 0.0, 0.7] {
                let point = here.point_at(DVec3::new(distance_m, 0.0, z), FLOOR);
                let from = here.start(&point);
                let rise_m = f64::from(height) - from.y;
                let expected = rise_m.atan2(from.x).max(rise_m.atan2(from.x - top_x)) / std::f64::consts::PI;
                for (lit, off_t) in here.lit_by_both(&path, 4096, &point) {
                    let [start, end] = *lit.as_slice().first().expect("the afternoon is sunny");
                    assert!(lit.as_slice().len() == 1 && end == 1.0);
                    assert!((start - expected).abs() <= off_t, "{name}, {distance_m} m: {start}, not {expected}");
                }
            }
        }
    }
}

/// B6: a closed room is dark up to its edges and corners.
#[test]
fn a_closed_room_is_dark_in_its_corners() {
    let inside = flipped(&block(Vec3::splat(-2.0), Vec3::splat(2.0)));
    let here = Traced::new(SceneBuilder::new().soup(&inside).build());
    let path = over_the_top(DVec3::new(0.8, 0.0, 0.6));
    for triangle in 0..inside.len() {
        for near in [1e-1, 1e-3, 1e-5, 1e-7, 0.0] {
            for barycentric in [[near, near], [1.0 - 2.0 * near, near], [near, 1.0 - 2.0 * near], [0.5, 0.5 - near]] {
                for (lit, _) in here.lit_by_both(&path, 256, &here.point(triangle, barycentric)) {
                    assert_eq!(lit.lit_length(), 0.0, "triangle {triangle} at {barycentric:?}");
                }
            }
        }
    }
}

/// B5: duplicates of a face, either way round, change nothing about who sees the sun.
#[test]
fn coincident_faces_do_not_speckle() {
    let pole = block(Vec3::new(-0.1, 0.0, -0.1), Vec3::new(0.1, 3.0, 0.1));
    let path = over_the_top(DVec3::new(0.6, 0.0, 0.8));
    let scene = |extra: &[[Vec3; 3]]| Traced::new(SceneBuilder::new().soup(&a_floor()).soup(&pole).soup(extra).build());
    let alone = scene(&[]);
    for (name, extra) in [("same winding", a_floor()), ("opposite winding", flipped(&a_floor()))] {
        let doubled = scene(&extra);
        for i in 0..1000 {
            let (u, v) = (f64::from(i % 31) / 31.0, f64::from(i / 31) / 33.0);
            let barycentric = [u * (1.0 - v), v];
            let [expected, found] = [&alone, &doubled].map(|s| s.lit_by_both(&path, 128, &s.point(FLOOR, barycentric)));
            assert_eq!(found, expected, "{name} at {barycentric:?}");
        }
    }
}

/// B5: the ground that a slab lies on is dark, and only that ground, right up to the slab's edge.
#[test]
fn the_ground_under_a_slab_is_dark_up_to_its_edge() {
    for thickness_m in [0.5f32, 0.01, 0.001] {
        let slab = block(Vec3::new(-1.0, 0.0, -1.0), Vec3::new(1.0, thickness_m, 1.0));
        let here = Traced::new(SceneBuilder::new().soup(&a_floor()).soup(&slab).build());
        let path = over_the_top(DVec3::X);
        for x in [0.0, 0.5, 0.9, 0.999, 0.99999] {
            for (lit, _) in here.lit_by_both(&path, 256, &here.point_at(DVec3::new(x, 0.0, 0.3), FLOOR)) {
                assert_eq!(lit.lit_length(), 0.0, "{x} m from the middle under {thickness_m} m");
            }
        }
        for (beside, _) in here.lit_by_both(&path, 256, &here.point_at(DVec3::new(1.0 + 1.0, 0.0, 0.3), FLOOR)) {
            assert!(beside.lit_length() > 0.8);
        }
    }
}

/// B5: a face lying on the ground, a millimetre or a tenth of one above it, hides it but for the sun that shines in
/// under the gap. At no distance at all neither of the two is on top, and both keep their light, without speckle.
#[test]
fn a_face_lying_on_the_ground_hides_it_up_to_its_edge() {
    let path = over_the_top(DVec3::X);
    for gap_m in [1e-3f32, 1e-4, 0.0] {
        let face = floor(Vec2::splat(-1.0), Vec2::splat(1.0), gap_m);
        let here = Traced::new(SceneBuilder::new().soup(&a_floor()).soup(&face).build());
        // Within a tenth of a metre of the edge, the lowest of the 64 suns does shine in under the gap.
        for x in [-0.9, -0.5, 0.0, 0.31, 0.9] {
            let point = here.point_at(DVec3::new(x, 0.0, 0.3), FLOOR);
            let from = here.start(&point);
            let under = |edge_m: f64| (f64::from(gap_m) - from.y).atan2(edge_m) / std::f64::consts::PI;
            let shines_in = under(1.0 - from.x) + under(1.0 + from.x);
            let expected = if gap_m > 0.0 { [0.0, shines_in] } else { [1.0; 2] };
            for ((lit, _), expected) in here.lit_by_both(&path, 64, &point).iter().zip(expected) {
                let off = (lit.lit_length() - expected).abs();
                assert!(off <= 1e-7, "{x} m from the middle under {gap_m} m: {lit:?}, not {expected}");
            }
        }
    }
}

/// B8.
#[test]
fn a_single_sided_quad_casts_from_both_sides() {
    for roof in
        [floor(Vec2::splat(-1.0), Vec2::splat(1.0), 1.0), flipped(&floor(Vec2::splat(-1.0), Vec2::splat(1.0), 1.0))]
    {
        let here = Traced::new(SceneBuilder::new().soup(&a_floor()).soup(&roof).build());
        for (lit, _) in here.lit_by_both(&standing(DVec3::Y), 4, &here.point_at(DVec3::new(0.3, 0.0, 0.2), FLOOR)) {
            assert_eq!(lit.lit_length(), 0.0);
        }
    }
}

/// B8: an open box is no solid: light falls in through the missing lid and nowhere else.
#[test]
fn an_open_box_lets_light_in_by_its_lid_only() {
    let without_lid: Vec<_> = block(Vec3::new(-1.0, 0.0, -1.0), Vec3::new(1.0, 2.0, 1.0))
        .into_iter()
        .filter(|t| t.iter().any(|v| v.y < 1.0))
        .collect();
    assert_eq!(without_lid.len(), 10);
    let here = Traced::new(SceneBuilder::new().soup(&a_floor()).soup(&flipped(&without_lid)).build());
    let bottom = 2 + without_lid.iter().position(|t| t.iter().all(|v| v.y == 0.0)).expect("a box has a bottom");
    let point = here.point_at(DVec3::ZERO, bottom);
    let from = here.start(&point);
    let opening = |edge_m: f64| (2.0 - from.y).atan2(edge_m) / std::f64::consts::PI;
    for (lit, off_t) in here.lit_by_both(&over_the_top(DVec3::X), 4096, &point) {
        let expected = [opening(1.0 - from.x), 1.0 - opening(1.0 + from.x)];
        assert_eq!(lit.as_slice().len(), 1);
        assert!((0..2).all(|i| (lit.as_slice()[0][i] - expected[i]).abs() <= off_t), "{lit:?}, not {expected:?}");
    }
}

/// B8: on a convex solid nothing shades anything: each facet is lit while the sun is in front of its plane.
#[test]
fn a_sphere_of_80_facets_has_a_clean_terminator() {
    const STEPS: usize = 512;
    let sphere = icosphere(1);
    let here = Traced::new(SceneBuilder::new().soup(&sphere).build());
    let path = over_the_top(DVec3::new(0.6, 0.0, -0.8));
    for triangle in 0..sphere.len() {
        for barycentric in [[0.01, 0.01], [0.98, 0.01], [0.01, 0.98], [1.0 / 3.0, 1.0 / 3.0], [0.5, 0.0], [0.0, 0.5]] {
            let point = here.point(triangle, barycentric);
            for ((lit, _), step) in
                here.lit_by_both(&path, STEPS, &point).iter().flat_map(|lit| (0..STEPS).map(move |step| (lit, step)))
            {
                let t = (step as f64 + 0.5) / STEPS as f64;
                let sun = path.direction(t);
                assert_eq!(lit.contains(t), sun.dot(point.normal) > 0.0 && sun.y > 0.0, "facet {triangle} at {t}");
            }
        }
    }
}

/// B10: a point buried where two boxes overlap, or exactly on an edge or corner they share, is dark.
#[test]
fn buried_points_and_points_on_shared_edges_are_dark() {
    let boxes = [block(Vec3::ZERO, Vec3::ONE), block(Vec3::new(1.0, 0.0, 0.0), Vec3::new(2.0, 1.0, 1.0))];
    let here = Traced::new(SceneBuilder::new().soup(&boxes[0]).soup(&boxes[1]).build());
    let path = over_the_top(DVec3::Z);
    for triangle in 0..24 {
        let inner = here.geometry.triangles[triangle]
            .iter()
            .all(|v| (f64::from(v.x) + here.scene.centre_m.x - 1.0).abs() < 1e-6);
        if !inner {
            continue;
        }
        for barycentric in [[0.0, 0.0], [0.5, 0.0], [0.5, 0.5], [0.3, 0.3], [1.0, 0.0]] {
            let point = here.point(triangle, barycentric);
            let on_top = (point.position_m.y + here.scene.centre_m.y - 1.0).abs() < 1e-9;
            for (lit, _) in here.lit_by_both(&path, 128, &point) {
                assert!(on_top || lit.lit_length() == 0.0, "triangle {triangle} at {barycentric:?}: {lit:?}");
                assert!(lit.lit_length().is_finite());
            }
        }
    }
}

/// A double-sided sheet sees the sun from whichever side it stands on; a single-sided one from its front alone.
#[test]
fn a_double_sided_sheet_is_lit_from_either_side() {
    let wall: Vec<_> = a_floor().iter().map(|t| t.map(|v| Vec3::new(0.0, v.x, v.z))).collect();
    let path = over_the_top(DVec3::X);
    for (material, expected) in [(opaque(), 0.5), (Material { is_double_sided: true, ..opaque() }, 1.0)] {
        let here = Traced::new(SceneBuilder::new().soup_of(&wall, material).build());
        for (lit, _) in here.lit_by_both(&path, 128, &here.point(0, [0.3, 0.3])) {
            assert!((lit.lit_length() - expected).abs() <= 1e-9, "{lit:?}");
        }
    }
}
