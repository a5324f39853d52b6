//! Alpha-masked leaves, random triangles, and scenes of another size or place.

use crate::brute_force::{Here, agree};
use crate::{ground, wall};
use glam::{DVec3, Mat3, Vec2, Vec3};
use sunbake::scene::{Mesh, TextureRef, Wrap};
use sunbake::testing::{SceneBuilder, alpha_masked, block, opaque, pseudo_random};

/// A wall of leaves: a mask with gaps of one texel and of many.
fn leaf(builder: SceneBuilder, alpha: impl Fn(u32, u32) -> u8) -> SceneBuilder {
    const SIZE: u32 = 16;
    let (builder, image) =
        builder.image(SIZE, SIZE, (0..SIZE * SIZE).map(|i| [90, 120, 60, alpha(i % SIZE, i / SIZE)]).collect());
    let texture = TextureRef { image, texcoord: 0, image_from_texcoord: Mat3::IDENTITY, wrap: [Wrap::Repeat; 2] };
    let positions: Vec<Vec3> = wall([-2.0, 0.2], [2.0, 3.0], 0.5).into_iter().flatten().collect();
    let uvs = positions.iter().map(|p| Vec2::new(p.x * 0.4 + 0.03 * p.y, 0.37 * p.y)).collect();
    let indices = (0..positions.len() as u32).collect();
    let mesh = Mesh { positions, texcoords: vec![Some(uvs)], indices, ..Mesh::default() };
    builder.mesh_of(mesh, alpha_masked(texture), &[glam::DMat4::IDENTITY])
}

#[test]
fn leaves_are_followed_texel_by_texel() {
    let checker = |x: u32, y: u32| if (x + y).is_multiple_of(2) || x < 5 && y < 6 { 255 } else { 0 };
    let here = Here::new(leaf(SceneBuilder::new().soup(&ground()), checker));
    let lamp = here.lamp(&[[-3.0, 1.0, -1.5], [3.0, 1.7, -1.0], [0.5, 2.9, 3.0], [-1.0, 0.5, -0.7]]);
    let answers = agree("leaf", &here, &lamp, &here.points(4, 20, 7));
    assert!(answers.iter().any(|a| a.as_slice().len() > 12), "the leaf has holes");
    let solid = Here::new(leaf(SceneBuilder::new().soup(&ground()), |_, _| 255));
    let clear = Here::new(leaf(SceneBuilder::new().soup(&ground()), |_, _| 0));
    for (name, here) in [("solid", &solid), ("clear", &clear)] {
        agree(name, here, &here.lamp(&[[-3.0, 1.0, -1.5], [3.0, 1.7, -1.0]]), &here.points(2, 20, 8));
    }
}

#[test]
fn random_triangles_agree() {
    for seed in 1..=6 {
        let mut state = seed * 77;
        let mut random = |size: f64| (2.0 * pseudo_random(&mut state) - 1.0) * size;
        let mut vector = |size: f64| DVec3::new(random(size), random(size), random(size));
        let triangles: Vec<[Vec3; 3]> = (0..120)
            .map(|_| {
                let centre = vector(4.0);
                [0; 3].map(|_| (centre + vector(1.0)).as_vec3())
            })
            .collect();
        let places: Vec<[f64; 3]> = (0..4).map(|_| vector(5.0).to_array()).collect();
        let material = sunbake::scene::Material { is_double_sided: seed % 2 == 0, ..opaque() };
        let here = Here::new(SceneBuilder::new().soup_of(&triangles, material));
        agree(&format!("random {seed}"), &here, &here.lamp(&places), &here.points(120, 1, seed));
    }
}

/// B4: a block casts the same shadow wherever the scene lies.
#[test]
fn size_and_place_do_not_matter() {
    for scale in [1e-3f32, 1.0, 1e4] {
        let scaled = |triangles: Vec<[Vec3; 3]>| triangles.iter().map(|t| t.map(|v| v * scale)).collect::<Vec<_>>();
        let here = Here::new(
            SceneBuilder::new()
                .soup(&scaled(ground()))
                .soup(&scaled(block(Vec3::new(-1.0, 0.0, -1.0), Vec3::new(1.0, 2.0, 1.0)))),
        );
        let places = [[-3.0, 2.5, 0.2], [3.0, 1.0, 0.2], [0.0, 1.0, 3.0]].map(|p| p.map(|x: f64| x * f64::from(scale)));
        agree(&format!("scale {scale}"), &here, &here.lamp(&places), &here.points(14, 4, 11));
    }
}
