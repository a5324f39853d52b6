//! B13 to B15 for the interval query: alpha-masked leaves, many intervals, the path's ends.

use glam::{DMat4, DVec3, Vec2, Vec3};
use sunbake::scene::{Mesh, TextureRef, Wrap};
use sunbake::sun::SunArc;
use sunbake::testing::{SceneBuilder, alpha_masked, block, floor};
use sunbake::visibility::{BisectEngine, IntervalTable, Intervals, lit_at};
use sunbake_tests::engines::{ALL, BISECT, Candidate, EXACT, RAYS, SUNS, all_must_agree};
use sunbake_tests::paths::{Random, day_at, keyed};
use sunbake_tests::{Oracle, Traced, over_the_top, path_of};

const FLOOR: usize = 0;

fn a_floor() -> Vec<[Vec3; 3]> {
    floor(Vec2::splat(-10.0), Vec2::splat(10.0), 0.0)
}

/// A leaf of 8 by 8 texels, solid or hole at random, level, two metres wide, tiled a little, a metre above the floor.
fn under_a_leaf(seed: u64, wrap: Wrap) -> Traced {
    let mut random = Random::new(seed);
    let texels = (0..64).map(|_| [90, 160, 60, if random.index(2) == 0 { 0 } else { 255 }]).collect();
    let (builder, image) = SceneBuilder::new().soup(&a_floor()).image(8, 8, texels);
    let corners = [[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0f32]];
    let leaf = Mesh {
        positions: corners.iter().map(|[x, z]| Vec3::new(*x, 1.0, *z)).collect(),
        texcoords: vec![Some(corners.iter().map(|[x, z]| Vec2::new(0.7 * x, 0.6 * z + 0.1)).collect())],
        indices: vec![0, 1, 2, 0, 2, 3],
        ..Mesh::default()
    };
    let texture =
        TextureRef { image, texcoord: 0, image_from_texcoord: glam::Mat3::IDENTITY, wrap: [wrap, Wrap::Repeat] };
    Traced::new(builder.mesh_of(leaf, alpha_masked(texture), &[DMat4::IDENTITY]).build())
}

/// B13: edges lie where the mask's texels end.
#[test]
fn a_leaf_casts_its_cut_out() {
    let mut edges = 0;
    for (seed, wrap) in [(1, Wrap::Repeat), (2, Wrap::Clamp), (3, Wrap::Mirror)] {
        let here = under_a_leaf(seed, wrap);
        let mut random = Random::new(seed);
        let mut points: Vec<_> = (0..30)
            .map(|_| here.point_at(DVec3::new(random.range(-1.5, 1.5), 0.0, random.range(-1.5, 1.5)), FLOOR))
            .collect();
        // Points of the leaf itself, which is seen from both sides.
        points
            .extend((0..10).map(|_| here.point(2 + random.index(2), [random.range(0.0, 0.5), random.range(0.0, 0.5)])));
        for path in [over_the_top(DVec3::X), day_at(10.0, "2026-03-20"), keyed()] {
            all_must_agree("a leaf", &here, &path, &points);
            edges += points.iter().map(|p| EXACT.lit(&here, &path, p).as_slice().len()).sum::<usize>();
        }
    }
    assert!(edges > 700, "the leaf has hardly any holes: {edges}");
}

/// What hid the sun from a neighbour is tried first, so that leaves are followed along other stretches than from a
/// point that is asked alone: the answer is the same, to the last bit.
#[test]
fn neighbours_change_no_answer_under_a_leaf() {
    for (seed, wrap) in [(5, Wrap::Repeat), (6, Wrap::Clamp), (7, Wrap::Mirror)] {
        let here = under_a_leaf(seed, wrap);
        let path = day_at(40.0, "2026-03-20");
        let at = |i: i32| DVec3::new(0.05 * f64::from(i % 30) - 0.7, 0.0, 0.05 * f64::from(i / 30) - 0.7);
        let points: Vec<_> = (0..900).map(|i| here.point_at(at(i), FLOOR)).collect();
        let engine = (EXACT.make)(&here.tracer, std::slice::from_ref(&path));
        let mut together = IntervalTable::default();
        engine.session().lit(&points, &mut together);
        let alone: Vec<Intervals> = points.iter().map(|point| lit_at(engine.as_ref(), point).swap_remove(0)).collect();
        assert!(alone.iter().map(|lit| lit.as_slice().len()).sum::<usize>() > 1500, "the leaf has hardly any holes");
        assert_eq!(together.iter().collect::<Vec<_>>(), alone);
    }
}

/// B14: a fence of 50 pales between the point and the sun.
#[test]
fn every_gap_of_a_fence_is_found() {
    let pales: Vec<[Vec3; 3]> = (0..50)
        .flat_map(|i| {
            let x = (i as f32 - 24.5) * 0.1;
            block(Vec3::new(x - 0.025, 0.0, 2.0), Vec3::new(x + 0.025, 9.0, 2.001))
        })
        .collect();
    let here = Traced::new(SceneBuilder::new().soup(&a_floor()).soup(&pales).build());
    let point = here.point_at(DVec3::ZERO, FLOOR);
    let path = path_of(SunArc {
        axis: -DVec3::Y,
        zero: DVec3::Z,
        declination_rad: -0.5,
        hour_angle_rad: [-1.0, 1.0],
        t: [0.0, 1.0],
    });
    all_must_agree("a fence", &here, &path, &[point]);
    // 49 gaps, and what is left and right of the fence.
    assert_eq!(EXACT.lit(&here, &path, &point).as_slice().len(), 51);
    assert_eq!(RAYS.lit(&here, &path, &point).as_slice().len(), 51);
}

/// B15: light all day, never, from the first moment and up to the last.
#[test]
fn the_paths_ends_are_exact() {
    let wall = |x: f32| block(Vec3::new(x - 0.5, 0.0, -9.0), Vec3::new(x + 0.5, 3.0, 9.0));
    let path = over_the_top(DVec3::X);
    let lit = |triangles: &[[Vec3; 3]]| {
        let here = Traced::new(SceneBuilder::new().soup(&a_floor()).soup(triangles).build());
        ALL.map(|engine| engine.lit(&here, &path, &here.point_at(DVec3::ZERO, FLOOR)))
    };
    assert_eq!(lit(&[]), [(); 3].map(|()| Intervals::always()));
    assert_eq!(
        lit(&block(Vec3::new(-1.0, -1.0, -1.0), Vec3::new(1.0, 1.0, 1.0))),
        [(); 3].map(|()| Intervals::never())
    );
    for found in lit(&wall(4.0)) {
        let [[start, end]] = *found.as_slice() else { panic!("{found:?}") };
        assert!(start > 0.1 && end == 1.0, "{found:?}");
    }
    for found in lit(&wall(-4.0)) {
        let [[start, end]] = *found.as_slice() else { panic!("{found:?}") };
        assert!(start == 0.0 && end < 0.9, "{found:?}");
    }
}

/// The checks above can fail: they catch coarse bisection that claims to be fine, and rays that claim to bisect.
#[test]
fn an_engine_that_claims_too_much_is_caught() {
    let here = under_a_leaf(4, Wrap::Repeat);
    let point = here.point_at(DVec3::new(0.3, 0.0, 0.2), FLOOR);
    let path = over_the_top(DVec3::X);
    let truth = Oracle::new(&here, &path, SUNS).lit(&point);
    let coarse = Candidate { make: |tracer, lanes| Box::new(BisectEngine::new(tracer, lanes, 64, 60.0)), ..BISECT };
    let boasting = [coarse, Candidate { make: RAYS.make, ..BISECT }, Candidate { make: RAYS.make, ..EXACT }];
    for (index, engine) in boasting.iter().enumerate() {
        assert!(engine.disagreement(&here, &path, &point, &truth).is_some(), "{index}");
    }
    for honest in ALL {
        assert_eq!(honest.disagreement(&here, &path, &point, &truth), None);
    }
}

/// B13: the ray's way over a wide leaf clips the corner of a single solid texel for a tenth of a second of the day.
#[test]
fn a_clipped_corner_of_a_masks_texel_is_found() {
    // A leaf of 8 by 8 texels, one of them solid, turned by 45 degrees: its corner points to -Z, at x = 0.3.
    let texels = (0..64).map(|i| [90, 160, 60, if i == 4 * 8 + 4 { 255 } else { 0 }]).collect();
    let (builder, image) = SceneBuilder::new().soup(&a_floor()).image(8, 8, texels);
    let corners = [[-8.0, -8.0], [-8.0, 8.0], [8.0, 8.0], [8.0, -8.0f32]];
    let uv = |[x, z]: [f32; 2]| Vec2::new((x - 0.3) + z, z - (x - 0.3)) / 8.0 + 0.5;
    let leaf = Mesh {
        positions: corners.iter().map(|[x, z]| Vec3::new(*x, 1.0, *z)).collect(),
        texcoords: vec![Some(corners.iter().map(|corner| uv(*corner)).collect())],
        indices: vec![0, 1, 2, 0, 2, 3],
        ..Mesh::default()
    };
    let texture = TextureRef { image, texcoord: 0, image_from_texcoord: glam::Mat3::IDENTITY, wrap: [Wrap::Clamp; 2] };
    let here = Traced::new(builder.mesh_of(leaf, alpha_masked(texture), &[DMat4::IDENTITY]).build());
    let path = over_the_top(DVec3::X);
    for into_m in [1e-2, 1e-3, 1e-4, 1e-5] {
        let mut point = here.point_at(DVec3::new(0.0, 0.0, into_m), FLOOR);
        // From just there, wherever shadow rays start.
        point.position_m += DVec3::new(0.0, 0.0, into_m) - here.start(&point).with_x(0.0).with_y(0.0);
        let dark_t = 1.0 - EXACT.lit(&here, &path, &point).lit_length();
        // Twice as wide as deep, seen at a slant of 0.3 to 1.
        let expected_t = 2.0 * into_m / 1.09 / std::f64::consts::PI;
        assert!((dark_t / expected_t - 1.0).abs() < 0.1, "{into_m} m into the corner: {dark_t}, not {expected_t}");
    }
}
