//! V1 to V13, V17 and V18: shadow volumes where they are known to break. Every way of drawing them gives the same
//! mask, bit for bit, and it equals hard truth. These tests need a GPU adapter, and fail without one.

use glam::{DMat4, DVec3, Vec2, Vec3};
use sunbake::scene::{Material, Mesh, Scene};
use sunbake::testing::{SceneBuilder, block, floor, icosphere, opaque};
use sunbake_runtime::gpu::VolumeSettings;
use sunbake_runtime::technique::{LightKind, Technique, Volumes};
use sunbake_runtime::testing::masks::{OBLIQUE_SUN, assert_right, gpu, ground, mask, oblique_view, under_sun};
use sunbake_runtime::testing::view;
use sunbake_runtime::volumes::{Casters, Mode};
use sunbake_runtime::{Shot, View};

const SIZE: [u32; 2] = [128, 128];

fn flipped(triangles: &[[Vec3; 3]]) -> Vec<[Vec3; 3]> {
    triangles.iter().map(|&[a, b, c]| [a, c, b]).collect()
}

fn moved(triangles: &[[Vec3; 3]], by: Vec3) -> Vec<[Vec3; 3]> {
    triangles.iter().map(|t| t.map(|corner| corner + by)).collect()
}

/// Every way of drawing a scene under a sun is right, from aside and from below the ground's edge.
fn assert_sun(name: &str, scene: Scene, towards: DVec3) {
    let stage = under_sun(scene, towards);
    let views = [oblique_view(&stage), view(&stage, DVec3::new(-5.2, 0.8, -4.9), DVec3::new(0.0, 0.5, 0.0), SIZE)];
    let moment = stage.moment(0.5);
    assert_right(&gpu(), name, &stage, &views, &moment, LightKind::Sun);
}

#[test]
fn v1_the_eye_is_inside_a_volume() {
    let gpu = gpu();
    let roof = block(Vec3::new(-3.0, 2.0, -3.0), Vec3::new(3.0, 2.3, 3.0));
    let stage = under_sun(ground().soup(&roof).block(Vec3::splat(-0.4), Vec3::splat(0.4)).build(), DVec3::Y);
    let inside = view(&stage, DVec3::new(2.0, 1.0, 2.2), DVec3::new(-0.5, 0.2, -0.3), SIZE);
    let looking_out = view(&stage, DVec3::new(0.0, 1.0, 0.0), DVec3::new(6.0, 0.0, 1.0), SIZE);
    let moment = stage.moment(0.5);
    assert_right(&gpu, "v1", &stage, &[inside, looking_out], &moment, LightKind::Sun);
    // By default the plan counts the roof by z-fail; where z-pass is requested, it says that it did not use it.
    let shot = Shot::new(&stage, inside);
    for mode in [Mode::Planned, Mode::ZPass] {
        let mut volumes = Volumes::new(&gpu, &stage, VolumeSettings { mode, ..VolumeSettings::default() }).unwrap();
        mask(&mut volumes, &shot, &moment, LightKind::Sun);
        let plan = volumes.report().lights[0].plan;
        assert!(plan.z_fail >= 1 && (plan.replaced >= 1) == (mode == Mode::ZPass), "{mode}: {plan:?}");
        assert_eq!(volumes.notes().iter().any(|line| line.contains("z-pass would be wrong")), mode == Mode::ZPass);
    }
}

#[test]
fn v2_the_near_plane_passes_through_a_volumes_wall() {
    let gpu = gpu();
    let stage = under_sun(ground().block(Vec3::new(-1.0, 2.0, -1.0), Vec3::new(1.0, 2.2, 1.0)).build(), DVec3::Y);
    let moment = stage.moment(0.5);
    let mut volumes = Volumes::new(&gpu, &stage, VolumeSettings::default()).unwrap();
    // The wall stands at x = 1; the near rectangle is some millionths wide.
    for step in 0..64 {
        let x = 1.0 + (f64::from(step) - 31.5) * 4e-7;
        let shot = Shot::new(&stage, view(&stage, DVec3::new(x, 1.0, 0.2), DVec3::new(x - 3.0, 0.0, -2.0), [48, 48]));
        let found = sunbake_runtime::testing::masks::agreement(&mut volumes, &shot, &moment, LightKind::Sun);
        assert!(found.unexplained.is_empty() && found.at_fine_edges <= 4, "step {step}: {}", found.sentence());
        let lit = mask(&mut volumes, &shot, &moment, LightKind::Sun).pixels.iter().filter(|&&v| v == 1.0).count();
        assert!((300..2200).contains(&lit), "step {step} flashes: {lit} of 2304 pixels are lit");
    }
}

#[test]
fn v3_the_near_plane_passes_through_the_caster() {
    let stage = under_sun(ground().block(Vec3::new(-1.0, 1.0, -1.0), Vec3::new(1.0, 2.0, 1.0)).build(), OBLIQUE_SUN);
    let views: Vec<View> = (0..24)
        .map(|step| {
            let y = 0.9 + f64::from(step) * 0.05 + 1e-7;
            view(&stage, DVec3::new(0.3, y, 0.2), DVec3::new(3.0, 0.0, -2.5), [64, 64])
        })
        .collect();
    assert_right(&gpu(), "v3", &stage, &views, &stage.moment(0.5), LightKind::Sun);
}

#[test]
fn v4_the_sun_lies_in_the_plane_of_silhouette_triangles() {
    let scene = || {
        ground()
            .block(Vec3::new(-1.0, 0.0, -1.0), Vec3::new(0.0, 1.5, 0.5))
            .block(Vec3::new(0.8, 0.6, 0.2), Vec3::new(1.6, 1.1, 0.9))
            .build()
    };
    let diagonal = DVec3::new(1.0, 1.0, 0.0);
    for (i, towards) in [DVec3::Y, diagonal, DVec3::new(0.0, 1.0, 1.0), DVec3::ONE].into_iter().enumerate() {
        assert_sun(&format!("v4, sun {i}"), scene(), towards);
    }
    // The plane of a face, turned by the smallest angle that an f32 resolves.
    assert_sun("v4, turned", scene(), DVec3::new(1e-7, 1.0, 0.0));
}

#[test]
fn v5_255_256_and_257_casters_lie_in_a_stack() {
    let gpu = gpu();
    // Where the two triangles of a square meet, both may count: some stacks that would fit are cut all the same.
    for (count, runs) in [(127, 1..=1), (255, 1..=9), (256, 3..=9), (257, 3..=9), (512, 5..=18)] {
        let sheet = |i: usize| {
            let y = 1.0 + 0.01 * i as f32;
            block(Vec3::new(-1.0, y, -1.0), Vec3::new(1.0, y + 0.004, 1.0))
        };
        let stage = under_sun(
            ground().soup(&(0..count).flat_map(sheet).collect::<Vec<_>>()).build(),
            DVec3::new(0.1, 1.0, 0.05),
        );
        let shot = Shot::new(&stage, oblique_view(&stage));
        let moment = stage.moment(0.5);
        assert_right(&gpu, &format!("v5, {count}"), &stage, &[shot.view], &moment, LightKind::Sun);
        // Counted without a stencil, the darkest pixels lie in as many prisms as there are casters. A stencil of 8
        // bits would wrap to 0 at 256.
        let mode = Mode::ZFail;
        let mut volumes = Volumes::new(&gpu, &stage, VolumeSettings { mode, ..VolumeSettings::default() }).unwrap();
        let counts = volumes.renderer().counts(&shot.view, &moment, false).unwrap();
        let most = counts.iter().copied().fold(0.0, f32::max);
        assert_eq!(most as usize, count);
        let seen = mask(&mut volumes, &shot, &moment, LightKind::Sun);
        let shown = |i: usize| shot.hits()[i].is_some();
        let differ = (0..counts.len()).filter(|&i| shown(i) && counts[i] > 0.0 && seen.pixels[i] != 0.0).count();
        assert_eq!(differ, 0, "{count}");
        let found = volumes.report().lights[0].runs;
        assert!(runs.contains(&found), "{count}: {found} runs");
    }
}

#[test]
fn v6_casters_that_cross_and_nest_are_right_in_any_order() {
    let gpu = gpu();
    let blocks = [
        block(Vec3::new(-1.0, 0.5, -1.0), Vec3::new(1.0, 1.5, 1.0)),
        block(Vec3::new(-0.5, 0.7, -0.5), Vec3::new(0.5, 1.3, 0.5)),
        block(Vec3::new(0.2, 1.0, 0.1), Vec3::new(1.7, 2.2, 0.8)),
        moved(&icosphere(2), Vec3::new(-0.9, 1.4, 0.3)),
    ];
    let mut first = None;
    for order in [[0, 1, 2, 3], [3, 2, 1, 0], [2, 0, 3, 1]] {
        let builder = order.iter().fold(ground(), |builder, &i| builder.soup(&blocks[i]));
        let stage = under_sun(builder.build(), OBLIQUE_SUN);
        let (view, moment) = (oblique_view(&stage), stage.moment(0.5));
        assert_right(&gpu, "v6", &stage, &[view], &moment, LightKind::Sun);
        let mut volumes = Volumes::new(&gpu, &stage, VolumeSettings::default()).unwrap();
        let seen = mask(&mut volumes, &Shot::new(&stage, view), &moment, LightKind::Sun).pixels;
        assert!(*first.get_or_insert_with(|| seen.clone()) == seen, "{order:?}");
    }
}

#[test]
fn v7_open_meshes_cast_from_either_winding() {
    let quad = floor(Vec2::new(-1.0, -0.7), Vec2::new(0.9, 1.1), 1.2);
    let open_box = block(Vec3::new(-0.8, 0.3, -0.9), Vec3::new(0.9, 1.4, 0.7))[2..].to_vec();
    for (name, triangles) in [("quad", quad), ("box without a lid", open_box)] {
        for triangles in [triangles.clone(), flipped(&triangles)] {
            let two_sided = Material { is_double_sided: true, ..opaque() };
            assert_sun(&format!("v7, {name}"), ground().soup(&triangles).build(), OBLIQUE_SUN);
            assert_sun(&format!("v7, {name}, two-sided"), ground().soup_of(&triangles, two_sided).build(), OBLIQUE_SUN);
        }
    }
}

#[test]
fn v8_edges_of_three_and_four_triangles_and_a_moebius_strip() {
    let (a, b) = (Vec3::new(0.0, 0.4, -1.0), Vec3::new(0.0, 1.6, 1.0));
    let fan = |count: usize| -> Vec<[Vec3; 3]> {
        let leaf = |i: usize| {
            let (sin, cos) = (i as f32 * 2.2 + 0.3).sin_cos();
            [a, b, Vec3::new(1.3 * cos, 1.0 + 0.9 * sin, 0.1)]
        };
        (0..count).map(leaf).collect()
    };
    assert_sun("v8, three", ground().soup(&fan(3)).build(), OBLIQUE_SUN);
    assert_sun("v8, four", ground().soup(&fan(4)).build(), OBLIQUE_SUN);
    let cubes = [
        block(Vec3::new(-1.0, 0.2, -1.0), Vec3::new(0.0, 1.2, 0.0)),
        block(Vec3::new(0.0, 0.2, 0.0), Vec3::new(1.0, 1.2, 1.0)),
    ];
    assert_sun("v8, cubes on an edge", ground().soup(&cubes.concat()).build(), OBLIQUE_SUN);
    let strip = |i: u32, side: f32| {
        let around = i as f32 * std::f32::consts::TAU / 24.0;
        let across =
            Vec3::new((around / 2.0).cos() * around.cos(), (around / 2.0).sin(), (around / 2.0).cos() * around.sin());
        Vec3::new(1.2 * around.cos(), 1.3, 1.2 * around.sin()) + across * 0.5 * side
    };
    // After a whole turn the strip's sides have changed places.
    let corner = |i: u32, side: f32| if i < 24 { strip(i, side) } else { strip(0, -side) };
    let moebius: Vec<[Vec3; 3]> = (0..24)
        .flat_map(|i| {
            let [p, q, r, s] = [corner(i, -1.0), corner(i, 1.0), corner(i + 1, 1.0), corner(i + 1, -1.0)];
            [[p, q, r], [p, r, s]]
        })
        .collect();
    let stage =
        under_sun(ground().soup_of(&moebius, Material { is_double_sided: true, ..opaque() }).build(), OBLIQUE_SUN);
    assert_right(&gpu(), "v8, moebius", &stage, &[oblique_view(&stage)], &stage.moment(0.5), LightKind::Sun);
    let counts = Casters::new(&stage).counts;
    assert_eq!((counts.solid_bodies, counts.open_bodies), (0, 2), "a strip with one side bounds nothing");
}

#[test]
fn v9_coincident_faces_do_not_shade_each_other() {
    let cube = block(Vec3::new(-1.0, 0.0, -1.0), Vec3::new(0.5, 1.2, 0.5));
    let twice = [cube.clone(), cube.clone()].concat();
    let both_ways = [cube.clone(), flipped(&cube)].concat();
    // A sheet on the ground, and a cube whose lid is cut otherwise than the one that lies on it.
    let sheet = floor(Vec2::new(-2.0, -1.3), Vec2::new(1.1, 2.2), 0.0);
    let fan: Vec<[Vec3; 3]> = (0..7)
        .map(|i| {
            let at = |k: u32| {
                let (sin, cos) = (k as f32 * std::f32::consts::TAU / 7.0).sin_cos();
                Vec3::new(-0.25 + 0.6 * cos, 1.2, -0.25 - 0.6 * sin)
            };
            [Vec3::new(-0.25, 1.2, -0.25), at(i), at(i + 1)]
        })
        .collect();
    for (name, triangles) in [
        ("twice", twice),
        ("both ways", both_ways),
        ("on the ground", [cube.clone(), sheet].concat()),
        ("on the lid", [cube, fan].concat()),
    ] {
        assert_sun(&format!("v9, {name}"), ground().soup(&triangles).build(), OBLIQUE_SUN);
    }
}

#[test]
fn v10_degenerate_triangles_cast_nothing_and_break_nothing() {
    let p = Vec3::new(0.3, 1.0, 0.2);
    let degenerate = [
        [p, p, p],
        [p, p + Vec3::X, p],
        [p, p + Vec3::X, p + Vec3::X * 2.0],
        [p, p + Vec3::X * 1e-20, p + Vec3::Z * 1e-20],
    ];
    let cube = block(Vec3::new(-1.0, 0.2, -1.0), Vec3::new(0.5, 1.2, 0.5));
    assert_sun("v10", ground().soup(&[cube.as_slice(), &degenerate].concat()).build(), OBLIQUE_SUN);
}

#[test]
fn v11_t_junctions_do_not_leak() {
    // A roof of one large quad beside three small ones: their common edge has corners on one side only.
    let large = floor(Vec2::new(-1.5, -1.0), Vec2::new(0.0, 1.0), 1.4);
    let small = (0..3).flat_map(|i| {
        let z = -1.0 + i as f32 * (2.0 / 3.0);
        floor(Vec2::new(0.0, z), Vec2::new(1.2, z + 2.0 / 3.0), 1.4)
    });
    let roof: Vec<_> = large.into_iter().chain(small).collect();
    let two_sided = Material { is_double_sided: true, ..opaque() };
    let stage = under_sun(ground().soup_of(&roof, two_sided).build(), OBLIQUE_SUN);
    let views = [oblique_view(&stage), view(&stage, DVec3::new(0.2, 0.6, 3.0), DVec3::new(0.0, 0.0, -1.0), [256, 256])];
    let found = assert_right(&gpu(), "v11", &stage, &views, &stage.moment(0.5), LightKind::Sun);
    // The corners lie on the edge here, and every prism is closed by itself: rounding leaves gaps in less than one
    // pixel in ten thousand.
    assert!(found.at_fine_edges + found.of_other_surfaces <= found.pixels / 10_000, "{}", found.sentence());
    assert!(Casters::new(&stage).counts.open_edges > 6);
}

#[test]
fn v12_a_cube_split_by_materials_and_seams_welds_to_twelve_edges() {
    // Each face is a primitive of a material of its own, under a node of its own, with corners of its own.
    let cube = block(Vec3::new(-1.0, 0.2, -1.0), Vec3::new(0.5, 1.2, 0.5));
    let split = cube.chunks(2).fold(SceneBuilder::new(), |builder, face| builder.soup_of(face, opaque()));
    let counts = Casters::new(&under_sun(split.build(), OBLIQUE_SUN)).counts;
    assert_eq!((counts.points, counts.open_edges, counts.nonmanifold_edges), (8, 0, 0));
    assert_eq!(counts.edges, 12 + 6, "twelve edges, and a diagonal in each of six faces");
    assert_eq!((counts.solid_bodies, counts.open_bodies), (1, 0));
    let split = cube.chunks(2).fold(ground(), |builder, face| builder.soup_of(face, opaque()));
    assert_sun("v12", split.build(), OBLIQUE_SUN);
}

#[test]
fn v13_needles_cast_what_they_should() {
    let needle = |i: u32| {
        let along = Vec3::new(0.7 - 0.13 * i as f32, 0.3, 1.0).normalize() * 4.0;
        let from = Vec3::new(-1.0 + 0.1 * i as f32, 0.2 + 0.2 * i as f32, -2.0);
        [from, from + along, from + along * 0.5 + Vec3::Y * 4e-5]
    };
    let needles: Vec<_> = (0..9).map(needle).collect();
    let wide = block(Vec3::new(-2.0, 1.0, 0.0), Vec3::new(2.0, 1.0001, 0.02));
    assert_sun("v13", ground().soup(&[needles, wide].concat()).build(), OBLIQUE_SUN);
}

#[test]
fn v17_a_sphere_of_eighty_facets_has_a_clean_terminator() {
    let sphere = moved(&icosphere(1), Vec3::new(0.0, 1.3, 0.0));
    assert_eq!(sphere.len(), 80);
    for towards in [OBLIQUE_SUN, DVec3::Y, DVec3::new(1.0, 0.2, 0.0)] {
        assert_sun("v17", ground().soup(&sphere).build(), towards);
    }
}

#[test]
fn v18_mirrored_nodes_cast_and_receive_like_others() {
    let triangles =
        [block(Vec3::new(0.3, 0.2, 0.1), Vec3::new(1.2, 1.4, 0.8)), moved(&icosphere(1), Vec3::new(2.0, 1.4, 1.0))]
            .concat();
    let positions: Vec<Vec3> = triangles.iter().flatten().copied().collect();
    let mesh = Mesh { indices: (0..positions.len() as u32).collect(), positions, ..Mesh::default() };
    let mirror = DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    let sheared =
        DMat4::from_cols_array(&[1.0, 0.0, 0.0, 0.0, 0.4, 1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, -0.5, 1.0]);
    let stage = under_sun(ground().mesh_of(mesh, opaque(), &[DMat4::IDENTITY, mirror, sheared]).build(), OBLIQUE_SUN);
    assert_right(&gpu(), "v18", &stage, &[oblique_view(&stage)], &stage.moment(0.5), LightKind::Sun);
    let counts = Casters::new(&stage).counts;
    assert_eq!((counts.solid_bodies, counts.inside_out_bodies), (6, 0), "mirrored bodies are not inside out");
}
