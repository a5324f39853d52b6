//! B9, B11 and B12: triangles smaller than a texel, mirrored and sheared nodes, instances of one mesh.

use crate::{all_texels, temporary};
use glam::{DMat4, DQuat, DVec3, Vec2, Vec3};
use sunbake::scene::Mesh;
use sunbake::testing::{SceneBuilder, block, floor, opaque};
use sunbake_tests::{bake_scene, quick};

/// B9: slivers thinner than a texel, and specks smaller than one, in the open: none of their texels is black.
#[test]
fn no_texel_of_a_sliver_in_the_open_is_black() {
    let folder = temporary();
    let mut triangles = Vec::new();
    for i in 0..40 {
        let (x, width) = (i as f32 * 0.5, 0.4 * 0.5f32.powi(i / 4));
        let corner = |u: f32, v: f32| Vec3::new(x + u * width, 0.0, v);
        triangles.push([corner(0.0, 0.0), corner(0.0, 8.0), corner(1.0, 8.0)]);
        triangles.push([corner(0.0, -1.0), corner(0.0, -1.0 + width), corner(1.0, -1.0 + width)]);
    }
    let set = bake_scene(&SceneBuilder::new().soup(&triangles).build(), &quick(), folder.path(), "slivers");
    let texels = all_texels(&set);
    assert!(texels.len() > 500);
    for texel in &texels {
        let lit: f64 = texel.lit.iter().map(|[a, b]| b - a).sum();
        assert!(lit > 0.98, "{texel:?}");
    }
}

/// B11: under mirrors, shears and uneven scales the outside stays the outside.
#[test]
fn mirrored_and_sheared_boxes_keep_their_normals_outside() {
    let folder = temporary();
    let shear =
        DMat4::from_cols_array(&[1.0, 0.0, 0.0, 0.0, 0.6, 1.0, 0.0, 0.0, 0.0, 0.3, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
    let turn = DMat4::from_quat(DQuat::from_rotation_y(0.7));
    let matrices: Vec<DMat4> = [
        DMat4::IDENTITY,
        DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0)),
        DMat4::from_scale(DVec3::new(0.2, 3.0, -1.5)),
        DMat4::from_scale(DVec3::splat(-1.0)),
        turn * shear,
        turn * shear * DMat4::from_scale(DVec3::new(1.0, -2.0, 1.0)),
    ]
    .iter()
    .enumerate()
    .map(|(i, m)| DMat4::from_translation(DVec3::new(20.0 * i as f64, 0.0, 0.0)) * *m)
    .collect();
    let positions: Vec<Vec3> = block(Vec3::splat(-1.0), Vec3::splat(1.0)).into_iter().flatten().collect();
    let mesh = Mesh { indices: (0..positions.len() as u32).collect(), positions, ..Mesh::default() };
    let scene = SceneBuilder::new().mesh_of(mesh, opaque(), &matrices).build();
    let set = bake_scene(&scene, &quick(), folder.path(), "boxes");
    let texels = all_texels(&set);
    for (i, _) in matrices.iter().enumerate() {
        let own: Vec<_> = texels.iter().filter(|t| t.instance == i).collect();
        assert!(own.len() > 20, "box {i} has {} texels", own.len());
        let middle = DVec3::new(20.0 * i as f64, 0.0, 0.0);
        for texel in own {
            let outwards = (DVec3::from(texel.position) - middle).dot(DVec3::from(texel.normal));
            assert!(outwards > 0.0, "box {i}: {texel:?}");
            assert!(texel.normal[1] < 0.9 || !texel.lit.is_empty(), "the top of box {i} is dark: {texel:?}");
        }
    }
}

/// B12: instances of one mesh have texels of their own: the one in a box is dark, its twins are not.
#[test]
fn instances_of_one_mesh_keep_their_own_light() {
    let folder = temporary();
    let positions: Vec<Vec3> = floor(Vec2::splat(-1.0), Vec2::splat(1.0), 0.0).into_iter().flatten().collect();
    let mesh = Mesh { indices: (0..positions.len() as u32).collect(), positions, ..Mesh::default() };
    let places: Vec<DMat4> =
        (0..5).map(|i| DMat4::from_translation(DVec3::new(50.0 * f64::from(i), 0.0, 0.0))).collect();
    let scene = SceneBuilder::new()
        .mesh_of(mesh, opaque(), &places)
        .block(Vec3::new(98.0, -0.5, -2.0), Vec3::new(102.0, 1.0, 2.0))
        .build();
    let set = bake_scene(&scene, &quick(), folder.path(), "tiles");
    for texel in all_texels(&set) {
        match texel.instance {
            2 => assert!(texel.lit.is_empty(), "{texel:?}"),
            0 | 1 | 3 | 4 => assert!(!texel.lit.is_empty(), "{texel:?}"),
            _ => {}
        }
    }
}
