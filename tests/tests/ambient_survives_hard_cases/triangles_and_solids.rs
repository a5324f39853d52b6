//! B7, B8, B9 and B11: needles and broken triangles, open and faceted solids, triangles smaller than a texel, mirrors.

use crate::{ao, bake, ball, ground, settings};
use glam::{DMat4, DVec3, Vec2, Vec3};
use sunbake::ambient::AmbientPoint;
use sunbake::testing::{SceneBuilder, block, floor, opaque};
use sunbake_tests::ambient::{ambient_visibility, flat, rays, share_of_polygon};
use sunbake_tests::{Traced, flipped};

#[test]
fn b7_needles_and_broken_triangles_leave_their_neighbours_alone() {
    let far = Vec3::new(1e5, 0.0, 0.0);
    let needles = [[Vec3::Y * 5.0, far + Vec3::Y * 5.0, far + Vec3::new(0.0, 5.0, 1.0)], [Vec3::ZERO; 3]];
    let traced = Traced::new(SceneBuilder::new().soup(&ground(3.0)).soup(&needles).build());
    let points: Vec<AmbientPoint> =
        (0..256).map(|i| flat(traced.point_at(DVec3::new(-2.0, 0.0, 0.01 * f64::from(i)), 0))).collect();
    let found = ambient_visibility(&traced, &points, rays(256));
    assert!(found.iter().all(|open| *open > 0.98 && *open <= 1.0));
}

#[test]
fn b8_single_sided_faces_occlude_from_both_sides_and_an_open_box_is_no_solid() {
    // The same card, facing down and facing up, hides as much.
    let card = floor(Vec2::splat(-1.0), Vec2::splat(1.0), 1.0);
    let corners = [[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]].map(|[x, z]| DVec3::new(x, 1.0, z));
    let expected = 1.0 - share_of_polygon(DVec3::ZERO, DVec3::Y, &corners);
    for card in [card.clone(), flipped(&card)] {
        let traced = Traced::new(SceneBuilder::new().soup(&ground(9.0)).soup(&card).build());
        let found = ambient_visibility(&traced, &[flat(traced.point_at(DVec3::ZERO, 0)); 64], rays(1024));
        assert!((found.iter().sum::<f64>() / 64.0 - expected).abs() < 0.004);
    }
    // A box without a lid: its floor, seen from above through single-sided walls that face outwards.
    let without_lid = &block(-Vec3::ONE, Vec3::ONE)[..];
    let lid = |t: &&[Vec3; 3]| t.iter().all(|v| v.y > 0.5);
    let open_box: Vec<[Vec3; 3]> = without_lid
        .iter()
        .filter(|t| !lid(t))
        .copied()
        .chain(floor(Vec2::splat(-0.9), Vec2::splat(0.9), -0.9))
        .collect();
    let (set, texels) = bake(&SceneBuilder::new().soup(&open_box).build(), &settings());
    let inner = texels.iter().filter(|t| (t.position[1] + 0.9).abs() < 1e-3 && t.normal[1] > 0.9);
    let opens: Vec<f64> = inner.map(ao).collect();
    assert!(
        opens.len() > 100 && opens.iter().all(|&open| open > 0.1 && open < 0.6),
        "{set:?}",
        set = set.manifest.ambient
    );
}

#[test]
fn b8_a_ball_of_80_facets_has_no_terminator() {
    let up = DMat4::from_translation(DVec3::Y * 1.02);
    let scene = SceneBuilder::new().mesh_of(ball(1), opaque(), &[up]).soup(&ground(2000.0)).build();
    let traced = Traced::new(scene);
    let normals = sunbake::scene::ShadingNormals::new(&traced.scene);
    let point = |i: usize| {
        let (triangle, weights) = (i % 80, [0.02 + 0.03 * (i / 80 % 16) as f64, 0.02 + 0.03 * (i / 1280) as f64]);
        let shading_normal = normals.at(&traced.scene, &traced.geometry, triangle, weights);
        AmbientPoint { surface: traced.point(triangle, weights), shading_normal }
    };
    let points: Vec<AmbientPoint> = (0..80 * 64).map(point).collect();
    let found = ambient_visibility(&traced, &points, rays(256));
    // On endless ground the visibility of a convex solid depends on its normal alone. The error of facets is least
    // where they are level, and is bounded by a facet's tilt.
    for (point, open) in points.iter().zip(found) {
        let expected = (1.0 + point.shading_normal.y) / 2.0;
        assert!((open - expected).abs() < 0.06, "{open} for {expected}");
    }
}

#[test]
fn b9_every_covered_texel_of_an_open_scene_is_open() {
    // A card, slivers thinner than a texel and specks smaller than one, all level and far apart.
    let mut soup = ground(2.0);
    for i in 0..12 {
        let (x, z) = (3.0 + 0.3 * i as f32, 0.2 * i as f32);
        soup.extend(floor(Vec2::new(x, z), Vec2::new(x + 0.002, z + 2.0), 0.0));
        soup.extend(floor(Vec2::new(-x, z), Vec2::new(-x + 0.004, z + 0.004), 0.0));
    }
    let (set, texels) = bake(&SceneBuilder::new().soup(&soup).build(), &settings());
    assert!(texels.iter().all(|texel| ao(texel) == 1.0));
    assert!(set.manifest.ambient.unwrap().buried_texels == 0);
}

#[test]
fn b11_mirrored_stretched_and_sheared_solids_alone_read_one() {
    let shear =
        DMat4::from_cols_array(&[1.0, 0.3, 0.0, 0.0, 0.5, 1.0, 0.0, 0.0, 0.0, 0.2, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
    let matrices = [DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0)), DMat4::from_scale(DVec3::new(1.0, 4.0, 0.2)), shear];
    for matrix in matrices {
        let (set, texels) = bake(&SceneBuilder::new().mesh_of(ball(1), opaque(), &[matrix]).build(), &settings());
        assert!(texels.len() > 1000 && texels.iter().all(|texel| ao(texel) == 1.0), "{matrix}");
        assert_eq!(set.manifest.ambient.unwrap().buried_texels, 0);
    }
}
