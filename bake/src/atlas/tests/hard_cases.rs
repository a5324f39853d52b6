//! The hard cases of baking that the atlas decides: B3, B4, B7, B9, B11, B12, B16, B22.

use super::scenes::{cuboid, hills, lit_quad, mesh, once, scene, sphere, triangles};
use crate::atlas::{AtlasSettings, Density, LayoutOrigin, surface_point};
use crate::scene::{Mesh, Scene};
use crate::testing::atlas::{CheckedAtlas, bake, bake_and_check};
use glam::{DMat4, DQuat, DVec3, Vec2, Vec3};
use std::collections::HashSet;

fn settings(page_size_texels: u32) -> AtlasSettings {
    AtlasSettings { density: Density::Pages(1), page_size_texels, ..AtlasSettings::default() }
}

fn covered(baked: &CheckedAtlas) -> usize {
    baked.pages.iter().map(|p| p.samples.len()).sum()
}

fn moved(mut mesh: Mesh, scale: f32, by: Vec3) -> Mesh {
    mesh.positions.iter_mut().for_each(|p| *p = *p * scale + by);
    mesh
}

#[test]
fn b3_vertices_in_map_coordinates_unwrap_like_those_at_the_origin() {
    let far = Vec3::new(450_000.0, 0.0, 5_000_000.0);
    let near = bake_and_check(&scene(vec![(cuboid(Vec3::splat(16.0)), once())]), &settings(256));
    let away = bake_and_check(&scene(vec![(moved(cuboid(Vec3::splat(16.0)), 1.0, far), once())]), &settings(256));
    assert_eq!(near.atlas.chart_count, away.atlas.chart_count);
    assert_eq!(covered(&near), covered(&away));
}

#[test]
fn b4_scale_of_a_node_or_of_vertices_changes_nothing() {
    let parts = |scale: f32, node: f64| {
        let matrix = |x: f64| DMat4::from_scale(DVec3::splat(node)) * DMat4::from_translation(DVec3::X * x);
        let grown = |mesh| moved(mesh, scale, Vec3::ZERO);
        scene(vec![
            (grown(hills(20, 0.5)), vec![matrix(0.0)]),
            (grown(sphere(10)), (0..5).map(|i| matrix(f64::from(i))).collect()),
            (grown(cuboid(Vec3::new(1.0, 0.001, 2.0))), vec![matrix(0.0)]),
        ])
    };
    let plain = bake_and_check(&parts(1.0, 1.0), &settings(256));
    let large = bake_and_check(&parts(1.0, 1.0), &settings(1024));
    for factor in [1e-4, 1e4] {
        let by_node = bake(&parts(1.0, factor), &settings(256));
        assert_eq!(
            format!("{:?}", by_node.atlas.layouts),
            format!("{:?}", plain.atlas.layouts),
            "node scaled by {factor}"
        );
        assert_eq!(by_node.pages[0].samples, plain.pages[0].samples, "node scaled by {factor}");
        // Charts are rounded to whole texels, which matters less the more they have.
        let by_vertex = bake_and_check(&parts(factor as f32, 1.0), &settings(1024));
        // Vertices times 10,000 are rounded, so a sphere, all ties, may be cut elsewhere.
        let charts = by_vertex.atlas.chart_count.abs_diff(large.atlas.chart_count);
        assert!(charts <= 2, "{charts} charts more or less, vertices scaled by {factor}");
        let ratio = by_vertex.atlas.texels_per_metre * factor / large.atlas.texels_per_metre;
        assert!((ratio - 1.0).abs() < 0.03, "density is off by {ratio}, vertices scaled by {factor}");
    }
}

#[test]
fn b7_needles_slivers_and_flat_triangles_have_texels_and_do_not_fail() {
    let needle = |length: f32, width: f32| [Vec3::ZERO, Vec3::X * length, Vec3::new(length, width, 0.0)];
    let mut all = vec![needle(1e5, 1.0), needle(1.0, 1e-5), needle(1.0, 1e-9), needle(1e-6, 1e-6)];
    all.push([Vec3::ZERO, Vec3::X, Vec3::X * 2.0]);
    bake_and_check(&scene(vec![(triangles(&all[..4]), once())]), &settings(128));
    for only in all {
        bake(&scene(vec![(triangles(&[only]), once())]), &settings(64));
    }
    bake(&scene(vec![(triangles(&[[Vec3::ONE; 3]]), once()), (cuboid(Vec3::ONE), once())]), &settings(64));
}

#[test]
fn b7_edges_with_three_triangles_and_reversed_copies_unwrap() {
    let corners = [Vec3::ZERO, Vec3::Y, Vec3::X, Vec3::Z, Vec3::NEG_X];
    let fin = mesh(corners.to_vec(), vec![0, 1, 2, 0, 1, 3, 0, 1, 4, 0, 2, 1, 0, 3, 1, 0, 1, 2]);
    bake_and_check(&scene(vec![(fin, once())]), &settings(64));
}

#[test]
fn b9_charts_thinner_than_a_texel_and_triangles_smaller_than_one_have_values() {
    let thin = cuboid(Vec3::new(0.001, 40.0, 0.001));
    let fine = sphere(60);
    let ground = hills(4, 0.0);
    let scene =
        scene(vec![(thin, once()), (moved(fine, 0.1, Vec3::ZERO), once()), (moved(ground, 10.0, Vec3::ZERO), once())]);
    bake_and_check(&scene, &settings(128));
}

/// A point of the surface never lies on the border of its triangle, where a neighbour lies as well.
#[test]
fn b10_samples_keep_off_the_borders_of_their_triangles() {
    let baked = bake(&scene(vec![(cuboid(Vec3::new(3.0, 1.0, 2.0)), once()), (hills(9, 0.3), once())]), &settings(256));
    for sample in &baked.pages[0].samples {
        let [u, v] = sample.barycentric;
        assert!(u > 1e-6 && v > 1e-6 && u + v < 1.0 - 1e-6, "{sample:?}");
    }
}

#[test]
fn b11_mirrored_and_sheared_nodes_keep_their_fronts() {
    let shear = DMat4::from_cols_array_2d(&[[1., 0., 0., 0.], [0.7, 1., 0., 0.], [0., 0.4, 2., 0.], [0., 0., 0., 1.]]);
    let mirror = DMat4::from_scale(DVec3::new(-1.0, 2.0, 0.5)) * DMat4::from_quat(DQuat::from_rotation_x(0.4));
    let scene = scene(vec![(sphere(8), vec![shear, mirror, mirror * shear])]);
    let baked = bake_and_check(&scene, &settings(256));
    for sample in &baked.pages[0].samples {
        let point = surface_point(&scene, &baked.geometry, sample);
        assert!(point.normal.dot(point.position_m) > 0.0, "the front of {point:?} looks inwards");
    }
}

#[test]
fn b12_each_of_160_instances_has_its_own_texels() {
    let matrices = (0..160).map(|i| DMat4::from_translation(DVec3::X * f64::from(i))).collect();
    let scene = scene(vec![(sphere(6), matrices)]);
    let baked = bake_and_check(&scene, &settings(512));
    let mut texels = vec![0; 160];
    for sample in &baked.pages[0].samples {
        texels[baked.geometry.instance[sample.triangle as usize] as usize] += 1;
    }
    let (least, most) = (texels.iter().min().unwrap(), texels.iter().max().unwrap());
    assert!(*least > 0 && least == most, "from {least} to {most} texels an instance");
}

#[test]
fn b16_coordinates_that_cannot_be_used_are_replaced() {
    let with = |uvs: Option<Vec<Vec2>>| {
        let mut two = triangles(&[[Vec3::ZERO, Vec3::X, Vec3::Y], [Vec3::Z, Vec3::Z + Vec3::Y, Vec3::Z + Vec3::X]]);
        two.texcoords = vec![uvs.clone(), uvs];
        origin_of(&scene(vec![(two, once())]))
    };
    let corner = [(0.1, 0.1), (0.4, 0.1), (0.1, 0.9)].map(Vec2::from);
    let other = corner.map(|uv| Vec2::new(1.0 - uv.x, uv.y));
    let both = |a: [Vec2; 3], b: [Vec2; 3]| Some([a, b].concat());
    assert_eq!(with(both(corner, other)), LayoutOrigin::File, "mirrored islands may stay");
    assert_eq!(with(None), LayoutOrigin::Unwrapped, "none");
    assert_eq!(with(both(corner, corner)), LayoutOrigin::Unwrapped, "overlapping");
    assert_eq!(
        with(both(corner, corner.map(|uv| Vec2::new(0.5 - uv.x, uv.y)))),
        LayoutOrigin::Unwrapped,
        "mirrored over"
    );
    assert_eq!(with(both(corner, other.map(|uv| uv + Vec2::X * 7.0))), LayoutOrigin::Unwrapped, "tiled far outside");
    assert_eq!(with(both(corner, [Vec2::splat(0.9); 3])), LayoutOrigin::Unwrapped, "without area");
    assert_eq!(with(both(corner, [Vec2::NAN; 3])), LayoutOrigin::Unwrapped, "not numbers");
    let specks = corner.map(|uv| uv * 0.01);
    assert_eq!(with(both(specks, specks.map(|uv| uv + 0.95))), LayoutOrigin::File, "small, and the whole scene's");
    let mut quad = lit_quad(Vec2::splat(0.1), Vec2::splat(0.9));
    quad.texcoords.swap(0, 1);
    assert_eq!(origin_of(&scene(vec![(quad, once())])), LayoutOrigin::Unwrapped, "TEXCOORD_0 is never trusted");
}

fn origin_of(scene: &Scene) -> LayoutOrigin {
    bake_and_check(scene, &settings(128)).atlas.layouts[0].origin
}

/// Triangles that lie apart from each other, each in a cube of this edge.
fn loose(count: usize, edge: f32) -> Mesh {
    let across = (count as f32).cbrt().ceil() as usize;
    let corner = |i: usize| {
        let at = [i % across, i / across % across, i / across / across].map(|k| 3.0 * edge * k as f32);
        [Vec3::ZERO, Vec3::X * edge, Vec3::Y * edge].map(|p| p + Vec3::from(at))
    };
    triangles(&(0..count).map(corner).collect::<Vec<_>>())
}

#[test]
fn b22_a_chart_within_a_texel_takes_one_and_a_narrow_one_a_row() {
    let planks: Vec<[Vec3; 3]> = (0..60)
        .map(|i| [Vec3::ZERO, Vec3::X * 20.0, Vec3::new(20.0, 0.0, 0.01)].map(|p| p + Vec3::Y * i as f32))
        .collect();
    let specks = || loose(400, 0.02);
    let scene = scene(vec![(specks(), once()), (triangles(&planks), once()), (hills(20, 0.2), once())]);
    let baked = bake_and_check(&scene, &settings(256));
    let mut texels = [0usize; 3];
    for sample in &baked.pages[0].samples {
        texels[baked.geometry.instance[sample.triangle as usize] as usize] += 1;
    }
    let density = baked.atlas.texels_per_metre_of(&scene, 2);
    assert!(density > 8.0, "{density}");
    assert_eq!(texels[0], 400);
    let row = (20.0 * density).round() as usize + 1;
    assert!((texels[1] / 60).abs_diff(row) <= 1, "{} texels a plank of {row}", texels[1] / 60);
}

#[test]
fn b22_a_speck_drawn_three_thousand_times_takes_as_many_texels() {
    let matrices = (0..3000).map(|i| DMat4::from_translation(DVec3::X * f64::from(i) * 0.01)).collect();
    let scene = scene(vec![(loose(1, 0.003), matrices), (hills(30, 0.1), once())]);
    let baked = bake_and_check(&scene, &settings(256));
    let of_specks = |sample: &&crate::atlas::Sample| baked.geometry.instance[sample.triangle as usize] < 3000;
    assert_eq!(baked.pages[0].samples.iter().filter(of_specks).count(), 3000);
    let density = baked.atlas.texels_per_metre_of(&scene, 3000);
    assert!(density > 6.5, "the ground has {density} texels a metre, of 7.9 if it were alone");
}

#[test]
fn b22_fifty_thousand_loose_triangles_fit_a_page_of_256() {
    let scene = scene(vec![(loose(50_000, 0.01), once())]);
    let baked = bake(&scene, &settings(256));
    let seen: HashSet<u32> = baked.pages[0].samples.iter().map(|sample| sample.triangle).collect();
    assert_eq!((baked.atlas.pages.len(), baked.atlas.chart_count, seen.len()), (1, 50_000, 50_000));
}

/// Twice the edge of a page gives close to twice the density, although four thousand charts are smaller than a texel:
/// with gutters they would take more than all of the smallest page.
#[test]
fn b22_densities_are_a_ladder() {
    let scene = scene(vec![(loose(4000, 0.05), once()), (hills(12, 0.3), once()), (sphere(20), once())]);
    let density = |edge: u32| bake(&scene, &settings(edge)).atlas.texels_per_metre_of(&scene, 1);
    let [small, middle, large] = [256, 512, 1024].map(density);
    for ratio in [middle / small, large / middle] {
        assert!((1.85..2.3).contains(&ratio), "{small} {middle} {large}");
    }
}
