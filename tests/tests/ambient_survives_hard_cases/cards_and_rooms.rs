//! B13, cards with two sides, and rooms without windows.

use crate::{ao, bake, baked, front, ground, settings};
use glam::{DMat4, DVec3, Mat3, Vec2, Vec3};
use sunbake::ambient::AmbientSettings;
use sunbake::atlas::Density;
use sunbake::scene::{Alpha, Material, Mesh, TextureRef, Wrap};
use sunbake::settings::{AmbientRequest, BakeSettings};
use sunbake::testing::{SceneBuilder, alpha_masked, block, floor, opaque};
use sunbake::texels::Texel;
use sunbake_tests::ambient::{ambient_visibility, flat, rays, share_of_polygon};
use sunbake_tests::{Traced, flipped};

/// A level card a metre up whose texture is solid on its right half (or everywhere, or nowhere, by the cutoff).
fn leaf(cutoff: f32) -> Traced {
    let (builder, image) =
        SceneBuilder::new().soup(&ground(9.0)).image(2, 1, vec![[90, 120, 60, 64], [90, 120, 60, 255]]);
    let texture = TextureRef { image, texcoord: 0, image_from_texcoord: Mat3::IDENTITY, wrap: [Wrap::Clamp; 2] };
    let positions: Vec<Vec3> = floor(Vec2::splat(-1.0), Vec2::splat(1.0), 1.0).into_iter().flatten().collect();
    let uvs = positions.iter().map(|p| Vec2::new(0.5 * (p.x + 1.0), 0.5 * (p.z + 1.0))).collect();
    let mesh = Mesh { indices: (0..6).collect(), positions, texcoords: vec![Some(uvs)], ..Mesh::default() };
    let material = Material { alpha: Alpha::Mask { cutoff }, ..alpha_masked(texture) };
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
        let mean = ambient_visibility(&traced, &[point; 64], rays(1024)).iter().sum::<f64>() / 64.0;
        assert!((mean - 1.0 + hidden).abs() < 0.004, "cutoff {cutoff}: {mean}, not {}", 1.0 - hidden);
    }
}

#[test]
fn two_sided_cards_store_both_sides() {
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
        let (front, back) = (ao(texel), texel.ao_back.unwrap());
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
    // Except the table's underside, which lies in the floor and faces out of the room.
    assert!(texels.iter().all(|texel| ao(texel) == 0.0 || (texel.position[1] == 0.0 && texel.normal[1] < 0.0)));
    // The floor under the table and the table's foot are inside a solid. No wall is.
    let buried = set.manifest.ambient.unwrap().buried_texels as f64 / texels.len() as f64;
    let request = AmbientRequest::with_rays(256);
    let near = AmbientRequest { estimate: AmbientSettings { distance_m: Some(0.5), ..request.estimate }, ..request };
    let (set, texels) = bake(&scene, &BakeSettings { ambient: Some(near), ..settings() });
    assert!(buried < 0.05, "{buried} of the texels are taken to be buried");
    for texel in &texels {
        let [x, y, z] = texel.position;
        let is_floor = y < 1e-4 && texel.normal[1] > 0.9;
        let in_the_open = is_floor && x.abs() < 2.4 && z.abs() < 1.4 && (x.abs() > 1.1 || z.abs() > 1.0);
        if in_the_open {
            assert_eq!(ao(texel), 1.0, "at {x}, {z}");
        } else if is_floor && x.abs() > 2.97 && z.abs() < 1.4 {
            assert!(ao(texel) < 0.75, "{} in the corner at {x}, {z}", ao(texel));
        }
    }
    assert!(front(&set).visibility.contains(&65_535));
}
