//! HARD_CASES B3 to B11 and B13 for ambient occlusion, and what buried texels, cards and closed rooms show.

use glam::{DMat4, DVec2, DVec3, Mat3, Quat, Vec2, Vec3};
use std::path::Path;
use sunbake::ambient::AmbientPoint;
use sunbake::atlas::Density;
use sunbake::disk::read::BakedSet;
use sunbake::maps::AmbientSide;
use sunbake::scene::{Alpha, Material, Mesh, Scene, TextureRef, Wrap};
use sunbake::settings::{AmbientRequest, BakeSettings};
use sunbake::testing::{SceneBuilder, block, cut, floor, icosphere, opaque};
use sunbake::texels::{Texel, draw};
use sunbake_tests::ambient::{ambient_at, flat, openness, rays, share_of_polygon};
use sunbake_tests::{Traced, bake_scene, flipped, quick};

fn settings() -> BakeSettings {
    BakeSettings { bakes_intervals: false, ambient: Some(AmbientRequest::with_rays(256)), ..quick() }
}

fn baked(scene: &Scene, settings: &BakeSettings, folder: &Path) -> (BakedSet, Vec<Texel>) {
    let set = bake_scene(scene, settings, folder, "set");
    let texels = draw(&set, usize::MAX, 0).expect("the set's scene");
    (set, texels)
}

fn bake(scene: &Scene, settings: &BakeSettings) -> (BakedSet, Vec<Texel>) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    baked(scene, settings, folder.path())
}

fn front(set: &BakedSet) -> &AmbientSide {
    &set.pages[0].ambient.as_ref().expect("ambient light").front
}

fn open(texel: &Texel) -> f64 {
    texel.ao.expect("ambient occlusion")
}

fn ground(half: f32) -> Vec<[Vec3; 3]> {
    floor(Vec2::splat(-half), Vec2::splat(half), 0.0)
}

/// A ball of `20 * 4^level` facets with the normals of a round one.
fn ball(level: u32) -> Mesh {
    let positions: Vec<Vec3> = icosphere(level).iter().flatten().copied().collect();
    let indices = (0..positions.len() as u32).collect();
    Mesh { indices, normals: Some(positions.clone()), positions, ..Mesh::default() }
}

/// A post, a slab and a stone on a floor.
fn still_life(matrix: DMat4) -> Scene {
    let soup: Vec<[Vec3; 3]> = [
        ground(3.0),
        block(Vec3::new(-1.0, 0.0, -1.0), Vec3::new(-0.6, 1.7, -0.5)),
        block(Vec3::new(0.2, 0.9, -0.8), Vec3::new(1.8, 1.0, 0.9)),
        icosphere(2).iter().map(|t| t.map(|v| v * 0.4 + Vec3::new(-0.4, 0.2, 1.0))).collect(),
    ]
    .concat();
    let positions: Vec<Vec3> = soup.iter().flatten().copied().collect();
    let mesh = Mesh { indices: (0..positions.len() as u32).collect(), positions, ..Mesh::default() };
    SceneBuilder::new().mesh_of(mesh, opaque(), &[matrix]).build()
}

/// Most that the openness of two bakes differs, and where they lie.
fn worst_difference(one: &Scene, other: &Scene) -> f64 {
    let [one, other] = [one, other].map(|scene| bake(scene, &settings()).1);
    assert_eq!(one.len(), other.len());
    one.iter().zip(&other).map(|(a, b)| (open(a) - open(b)).abs()).fold(0.0, f64::max)
}

#[test]
fn b3_a_scene_moved_by_a_million_metres_bakes_the_same_map() {
    let here = still_life(DMat4::IDENTITY);
    let there = still_life(DMat4::from_translation(DVec3::new(1e6, -3e6, 2e6)));
    assert_eq!(worst_difference(&here, &there), 0.0);
}

#[test]
fn b4_a_scene_of_any_size_bakes_the_same_map() {
    let scene = still_life(DMat4::IDENTITY);
    for scale in [1.0 / 8192.0, 8192.0] {
        assert_eq!(worst_difference(&scene, &still_life(DMat4::from_scale(DVec3::splat(scale)))), 0.0, "{scale}");
    }
    // No power of two: corners round otherwise, so that a ray that grazes one may go either way.
    for scale in [1e-4, 1e4] {
        let worst = worst_difference(&scene, &still_life(DMat4::from_scale(DVec3::splat(scale))));
        assert!(worst <= 2.0 / 256.0, "{scale}: {worst}");
    }
}

#[test]
fn b5_coincident_faces_do_not_speckle() {
    for other in [ground(2.0), flipped(&ground(2.0))] {
        let (_, texels) = bake(&SceneBuilder::new().soup(&ground(2.0)).soup(&other).build(), &settings());
        assert!(texels.len() > 1000 && texels.iter().all(|texel| open(texel) == 1.0));
    }
    // A room whose walls are doubled, both ways round, is dark and not taken for the inside of a solid.
    let room = block(-Vec3::ONE, Vec3::ONE);
    let scene = SceneBuilder::new().soup(&room).soup(&flipped(&room)).build();
    let request = AmbientRequest::with_rays(64);
    let near = AmbientRequest {
        estimate: sunbake::ambient::AmbientSettings { distance_m: Some(0.5), ..request.estimate },
        ..request
    };
    let (set, _) = bake(&scene, &BakeSettings { ambient: Some(near), ..settings() });
    assert_eq!(set.manifest.ambient.as_ref().unwrap().buried_texels, 0);
}

#[test]
fn b5_a_face_on_the_ground_covers_it_and_does_not_leak() {
    let lid = floor(Vec2::splat(-1.0), Vec2::splat(1.0), 1e-4);
    let (_, texels) = bake(&SceneBuilder::new().soup(&ground(3.0)).soup(&lid).build(), &settings());
    let on_ground = texels.iter().filter(|t| t.position[1].abs() < 5e-5);
    let texel_m = 6.0 / 60.0;
    let (mut covered, mut open_ground) = (0, 0);
    for texel in on_ground {
        let [x, _, z] = texel.position;
        let outside = x.abs().max(z.abs()) - 1.0;
        if outside < -1.5 * texel_m {
            covered += 1;
            assert_eq!(open(texel), 0.0, "at {x}, {z}");
        } else if outside > 0.0 {
            open_ground += 1;
            assert!(open(texel) > 0.99, "{} at {x}, {z}", open(texel));
        }
    }
    assert!(covered > 50 && open_ground > 200, "{covered} {open_ground}");
}

#[test]
fn b6_no_light_comes_under_a_wall_or_through_a_roofs_corners() {
    let wall = block(Vec3::new(-0.1, 0.0, -50.0), Vec3::new(0.1, 50.0, 50.0));
    let traced = Traced::new(SceneBuilder::new().soup(&ground(50.0)).soup(&wall).build());
    for off in [1e-4, 1e-3, 1e-2, 0.1, 0.3] {
        let points: Vec<AmbientPoint> =
            (0..64).map(|i| flat(traced.point_at(DVec3::new(0.1 + off, 0.0, 0.01 * f64::from(i)), 0))).collect();
        let mean = openness(&traced, &points, rays(1024)).iter().sum::<f64>() / 64.0;
        assert!((mean - 0.5).abs() < 0.01, "{mean} at {off} m");
    }
    let (_, texels) = bake(&SceneBuilder::new().soup(&flipped(&block(-Vec3::ONE, Vec3::ONE))).build(), &settings());
    assert!(texels.len() > 500 && texels.iter().all(|texel| open(texel) == 0.0));
}

#[test]
fn b7_needles_and_broken_triangles_leave_their_neighbours_alone() {
    let far = Vec3::new(1e5, 0.0, 0.0);
    let needles = [[Vec3::Y * 5.0, far + Vec3::Y * 5.0, far + Vec3::new(0.0, 5.0, 1.0)], [Vec3::ZERO; 3]];
    let traced = Traced::new(SceneBuilder::new().soup(&ground(3.0)).soup(&needles).build());
    let points: Vec<AmbientPoint> =
        (0..256).map(|i| flat(traced.point_at(DVec3::new(-2.0, 0.0, 0.01 * f64::from(i)), 0))).collect();
    let found = openness(&traced, &points, rays(256));
    assert!(found.iter().all(|open| *open > 0.98 && *open <= 1.0));
}

#[test]
fn b8_single_sides_hide_from_behind_and_an_open_box_is_no_solid() {
    // The same card, facing down and facing up, hides as much.
    let card = floor(Vec2::splat(-1.0), Vec2::splat(1.0), 1.0);
    let corners = [[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]].map(|[x, z]| DVec3::new(x, 1.0, z));
    let expected = 1.0 - share_of_polygon(DVec3::ZERO, DVec3::Y, &corners);
    for card in [card.clone(), flipped(&card)] {
        let traced = Traced::new(SceneBuilder::new().soup(&ground(9.0)).soup(&card).build());
        let found = openness(&traced, &[flat(traced.point_at(DVec3::ZERO, 0)); 64], rays(1024));
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
    let opens: Vec<f64> = inner.map(open).collect();
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
    let found = openness(&traced, &points, rays(256));
    // A convex thing on endless ground sees the sky by its normal alone. What facets leave out of the count is
    // least where they lie level, and within a facet's own tilt everywhere.
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
    assert!(texels.iter().all(|texel| open(texel) == 1.0));
    assert!(set.manifest.ambient.unwrap().buried_texels == 0);
}

#[test]
fn b10_what_is_buried_reads_nothing_and_does_not_bleed() {
    // A block that stands in the ground, which is a solid slab.
    let slab = block(Vec3::new(-3.0, -1.0, -3.0), Vec3::new(3.0, 0.0, 3.0));
    let stone = block(Vec3::new(-1.0, -0.5, -1.0), Vec3::new(1.0, 0.5, 1.0));
    let scene = SceneBuilder::new().soup(&slab).soup(&stone).build();
    for supersample in [1, 2, 4] {
        b10_around_a_stone(&scene, supersample);
    }
    // The same of stuff that has two sides throughout.
    let two_sided = Material { is_double_sided: true, ..opaque() };
    b10_around_a_stone(&SceneBuilder::new().soup_of(&slab, two_sided.clone()).soup_of(&stone, two_sided).build(), 1);
    b10_on_edges_and_between_boxes();
}

fn b10_around_a_stone(scene: &Scene, supersample: u32) {
    let request = AmbientRequest { supersample, ..AmbientRequest::with_rays(256) };
    let (set, texels) = bake(scene, &BakeSettings { ambient: Some(request), ..settings() });
    assert!(set.manifest.ambient.as_ref().unwrap().buried_texels > 100);
    let texel_m = 1.0 / set.manifest.scene.texels_per_metre;
    for texel in &texels {
        let [x, y, z] = texel.position;
        let is_top = (y.abs() < 1e-4) && texel.normal[1] > 0.9;
        let outside = x.abs().max(z.abs()) - 1.0;
        if is_top && outside < -1.5 * texel_m {
            assert_eq!(open(texel), 0.0, "buried at {x}, {z}");
        } else if is_top && outside > -0.95 * texel_m && outside < 1.5 * texel_m {
            // Beside the stone, on both sides of its border: what the ground there sees, never the dark beneath.
            assert!(open(texel) > 0.4, "{} at {x}, {z}, {outside} outside", open(texel));
        }
    }
}

fn b10_on_edges_and_between_boxes() {
    // Just on edges, on corners, and in the plane where two boxes touch.
    let touching =
        SceneBuilder::new().soup(&block(Vec3::ZERO, Vec3::ONE)).soup(&block(Vec3::X, Vec3::new(2.0, 1.0, 1.0))).build();
    let traced = Traced::new(touching);
    let points: Vec<AmbientPoint> = (0..24)
        .flat_map(|t| {
            [[0.0, 0.0], [1.0, 0.0], [0.5, 0.5], [0.5, 0.0], [1.0 / 3.0; 2]].map(|w| flat(traced.point(t, w)))
        })
        .collect();
    let (found, _) = ambient_at(&traced, &points, rays(256));
    for (point, estimate) in points.iter().zip(found) {
        assert!(estimate.open.is_finite() && estimate.bent.is_finite());
        let is_between = (point.surface.position_m.x + traced.scene.centre_m.x - 1.0).abs() < 1e-6
            && point.surface.normal.x.abs() > 0.9;
        assert_eq!(estimate.open, if is_between { 0.0 } else { 1.0 }, "{point:?}");
    }
}

#[test]
fn b11_mirrored_stretched_and_sheared_solids_alone_read_one() {
    let shear =
        DMat4::from_cols_array(&[1.0, 0.3, 0.0, 0.0, 0.5, 1.0, 0.0, 0.0, 0.0, 0.2, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
    let matrices = [DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0)), DMat4::from_scale(DVec3::new(1.0, 4.0, 0.2)), shear];
    for matrix in matrices {
        let (set, texels) = bake(&SceneBuilder::new().mesh_of(ball(1), opaque(), &[matrix]).build(), &settings());
        assert!(texels.len() > 1000 && texels.iter().all(|texel| open(texel) == 1.0), "{matrix}");
        assert_eq!(set.manifest.ambient.unwrap().buried_texels, 0);
    }
}

/// A level card a metre up whose texture is solid on its right half (or everywhere, or nowhere, by the cutoff).
fn leaf(cutoff: f32) -> Traced {
    let (builder, image) =
        SceneBuilder::new().soup(&ground(9.0)).image(2, 1, vec![[90, 120, 60, 64], [90, 120, 60, 255]]);
    let texture = TextureRef { image, texcoord: 0, image_from_texcoord: Mat3::IDENTITY, wrap: [Wrap::Clamp; 2] };
    let positions: Vec<Vec3> = floor(Vec2::splat(-1.0), Vec2::splat(1.0), 1.0).into_iter().flatten().collect();
    let uvs = positions.iter().map(|p| Vec2::new(0.5 * (p.x + 1.0), 0.5 * (p.z + 1.0))).collect();
    let mesh = Mesh { indices: (0..6).collect(), positions, texcoords: [Some(uvs), None], ..Mesh::default() };
    let material = Material { alpha: Alpha::Cut { cutoff }, ..cut(texture) };
    Traced::new(builder.mesh_of(mesh, material, &[DMat4::IDENTITY]).build())
}

#[test]
fn b13_a_leaf_hides_by_its_cut_out() {
    let share = |left: f64| {
        let corners = [[left, -1.0], [left, 1.0], [1.0, 1.0], [1.0, -1.0]].map(|[x, z]| DVec3::new(x, 1.0, z));
        share_of_polygon(DVec3::new(0.3, 0.0, 0.1), DVec3::Y, &corners)
    };
    for (cutoff, hidden) in [(0.5, share(0.0)), (0.0, share(-1.0)), (0.2, share(-1.0)), (1.0, share(0.0))] {
        let traced = leaf(cutoff);
        let point = flat(traced.point_at(DVec3::new(0.3, 0.0, 0.1), 0));
        let mean = openness(&traced, &[point; 64], rays(1024)).iter().sum::<f64>() / 64.0;
        assert!((mean - 1.0 + hidden).abs() < 0.004, "cutoff {cutoff}: {mean}, not {}", 1.0 - hidden);
    }
}

#[test]
fn cards_with_two_sides_hold_what_each_of_them_sees() {
    // A card just above endless ground: all of the sky above, nothing but ground below.
    let two_sided = Material { is_double_sided: true, ..opaque() };
    let card = floor(Vec2::splat(-1.0), Vec2::splat(1.0), 0.5);
    let scene = SceneBuilder::new().soup_of(&card, two_sided).soup(&ground(400.0)).build();
    let density = BakeSettings { density: Density::TexelsPerMetre(0.5), page_size_texels: 1024, ..settings() };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (set, texels) = baked(&scene, &density, folder.path());
    let of_card: Vec<&Texel> = texels.iter().filter(|texel| texel.double_sided).collect();
    assert!(!of_card.is_empty());
    for texel in of_card {
        let (front, back) = (open(texel), texel.ao_back.unwrap());
        let [up, down] = if texel.normal[1] > 0.0 { [front, back] } else { [back, front] };
        assert!(up == 1.0 && down < 0.02, "{up} above, {down} below");
    }
    // Viewers, which know of one number, get the greater: red, beside green for the front and blue for the back.
    let file = set.folder.join(set.manifest.atlases[0].ao.as_ref().unwrap());
    let picture = image::open(file).expect("a picture").into_rgb16();
    assert!(picture.pixels().all(|texel| texel.0[0] == texel.0[1].max(texel.0[2])));
    assert!(picture.pixels().any(|texel| texel.0[1] != texel.0[2]));
}

#[test]
fn a_windowless_room_is_black_and_with_a_distance_only_its_corners_are_dark() {
    let room = flipped(&block(Vec3::new(-3.0, 0.0, -2.0), Vec3::new(3.0, 2.5, 2.0)));
    let table = block(Vec3::new(-0.5, 0.0, -0.4), Vec3::new(0.5, 0.8, 0.4));
    let scene = SceneBuilder::new().soup(&room).soup(&table).build();
    let (set, texels) = bake(&scene, &settings());
    // But for the table's own underside, which lies in the floor and looks out of the house.
    assert!(texels.iter().all(|texel| open(texel) == 0.0 || (texel.position[1] == 0.0 && texel.normal[1] < 0.0)));
    // The floor under the table and the table's foot are inside a solid; no wall is taken to be.
    let buried = set.manifest.ambient.unwrap().buried_texels as f64 / texels.len() as f64;
    let request = AmbientRequest::with_rays(256);
    let near = AmbientRequest {
        estimate: sunbake::ambient::AmbientSettings { distance_m: Some(0.5), ..request.estimate },
        ..request
    };
    let (set, texels) = bake(&scene, &BakeSettings { ambient: Some(near), ..settings() });
    assert!(buried < 0.05, "{buried} of the texels are taken to be buried");
    for texel in &texels {
        let [x, y, z] = texel.position;
        let is_floor = y < 1e-4 && texel.normal[1] > 0.9;
        let in_the_open = is_floor && x.abs() < 2.4 && z.abs() < 1.4 && (x.abs() > 1.1 || z.abs() > 1.0);
        if in_the_open {
            assert_eq!(open(texel), 1.0, "at {x}, {z}");
        } else if is_floor && x.abs() > 2.97 && z.abs() < 1.4 {
            assert!(open(texel) < 0.75, "{} in the corner at {x}, {z}", open(texel));
        }
    }
    assert!(front(&set).open.contains(&65_535));
}

#[test]
fn the_same_bake_is_the_same_bytes_on_any_number_of_threads() {
    let scene = still_life(DMat4::from_rotation_translation(Quat::from_rotation_y(0.3).as_dquat(), DVec3::X));
    let request = AmbientRequest::with_rays(64);
    let all = AmbientRequest {
        estimate: sunbake::ambient::AmbientSettings {
            wants_bent: true,
            wants_sky: true,
            error: Some(0.02),
            ..request.estimate
        },
        supersample: 2,
        exr: true,
        vertices: Some(sunbake::settings::VertexAttribute::Ao),
        ..request
    };
    let files = |threads: usize| {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let (set, _) = baked(&scene, &BakeSettings { threads, ambient: Some(all), ..settings() }, folder.path());
        let mut names: Vec<_> = std::fs::read_dir(&set.folder).unwrap().map(|entry| entry.unwrap().path()).collect();
        names.retain(|name| name.extension().is_some_and(|extension| extension != "json"));
        names.sort();
        assert_eq!(names.len(), 8, "{names:?}");
        names.iter().map(|name| std::fs::read(name).unwrap()).collect::<Vec<_>>()
    };
    let one = files(1);
    assert!([2, 2, 3, 7].into_iter().all(|threads| files(threads) == one));
}

#[test]
fn texels_may_be_spread_over_points_of_their_surface() {
    // Beneath a grate much finer than texels, single points see bars or gaps by chance.
    let bars: Vec<[Vec3; 3]> = (-20..20)
        .flat_map(|i| floor(Vec2::new(i as f32 * 0.1, -2.0), Vec2::new(i as f32 * 0.1 + 0.05, 2.0), 0.02))
        .collect();
    let scene = SceneBuilder::new().soup(&ground(2.0)).soup(&bars).build();
    let spread = |supersample: u32| {
        let request = AmbientRequest { supersample, ..AmbientRequest::with_rays(1024) };
        let settings = BakeSettings { page_size_texels: 64, ambient: Some(request), ..settings() };
        let (_, texels) = bake(&scene, &settings);
        let opens: Vec<f64> = texels
            .iter()
            .filter(|t| {
                t.position[1].abs() < 1e-4 && t.normal[1] > 0.9 && t.position[0].abs().max(t.position[2].abs()) < 1.5
            })
            .map(open)
            .collect();
        let mean = opens.iter().sum::<f64>() / opens.len() as f64;
        (mean, (opens.iter().map(|o| (o - mean).powi(2)).sum::<f64>() / opens.len() as f64).sqrt())
    };
    let ((mean, one), (mean_of_more, four)) = (spread(1), spread(4));
    assert!((mean - mean_of_more).abs() < 0.05 && four < 0.6 * one, "{mean} {one}, {mean_of_more} {four}");
}

/// What a filter of two by two texels reads.
fn filtered(open: &[u16], [width, height]: [usize; 2], uv: Vec2) -> f64 {
    let place = uv.as_dvec2() * DVec2::new(width as f64, height as f64) - 0.5;
    let (low, share) = (place.floor(), place - place.floor());
    let texel = |dx: f64, dy: f64| {
        let x = (low.x + dx).clamp(0.0, width as f64 - 1.0) as usize;
        let y = (low.y + dy).clamp(0.0, height as f64 - 1.0) as usize;
        f64::from(open[y * width + x]) / 65_535.0
    };
    let row = |dy: f64| texel(0.0, dy) * (1.0 - share.x) + texel(1.0, dy) * share.x;
    row(0.0) * (1.0 - share.y) + row(1.0) * share.y
}

#[test]
fn no_seam_shows_where_charts_meet() {
    // A round stone of many charts, half in the shade of a slab, and a bent strip.
    let slab = block(Vec3::new(-2.0, 1.2, -0.5), Vec3::new(0.3, 1.4, 2.0));
    let scene =
        SceneBuilder::new().mesh_of(ball(3), opaque(), &[DMat4::IDENTITY]).soup(&slab).soup(&ground(3.0)).build();
    let request = AmbientRequest::with_rays(64);
    let settings = BakeSettings { page_size_texels: 256, ambient: Some(request), ..settings() };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (set, _) = baked(&scene, &settings, folder.path());
    let scene = sunbake::scene::load(&set.scene_file(), &sunbake::scene::LoadLimits::default()).unwrap();
    let page = &set.pages[0];
    let open = &front(&set).open;
    let mut edges: std::collections::HashMap<[[u32; 3]; 2], Vec<[Vec2; 2]>> = std::collections::HashMap::new();
    for mesh in scene.meshes.iter().filter(|mesh| mesh.normals.is_some()) {
        let uvs = mesh.texcoords[1].as_ref().unwrap();
        for triangle in mesh.indices.chunks_exact(3) {
            for k in 0..3 {
                let mut ends = [triangle[k], triangle[(k + 1) % 3]]
                    .map(|v| (mesh.positions[v as usize].to_array().map(|x| (x + 0.0).to_bits()), uvs[v as usize]));
                ends.sort_by_key(|end| end.0);
                edges.entry(ends.map(|end| end.0)).or_default().push(ends.map(|end| end.1));
            }
        }
    }
    let mut apart = Vec::new();
    for sides in edges.values().filter(|sides| sides.len() == 2 && sides[0] != sides[1]) {
        for step in 0..=8 {
            let at = |[a, b]: [Vec2; 2]| {
                filtered(open, [page.width as usize, page.height as usize], a.lerp(b, step as f32 / 8.0))
            };
            apart.push((at(sides[0]) - at(sides[1])).abs());
        }
    }
    apart.sort_by(f64::total_cmp);
    let (p99, worst) = (apart[apart.len() * 99 / 100], apart[apart.len() - 1]);
    println!("{} points on cuts: 99 % within {p99:.4}, worst {worst:.4}", apart.len());
    // Three codes of 8 bits, as an eye would have it, and five of noise at the very worst.
    assert!(apart.len() > 500 && p99 < 3.0 / 255.0 && worst < 8.0 / 255.0, "{} {p99} {worst}", apart.len());
    let told = &set.manifest.ambient.as_ref().unwrap().seams;
    assert!(told.mean < 0.5 * told.mean_before, "{told:?}");
}
