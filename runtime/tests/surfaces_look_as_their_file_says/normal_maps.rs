//! Normal maps of one texel against the tilted normal in closed form, however the texture and the square lie.

use super::{middle, square, squares, sun_alone};
use glam::{DMat4, DQuat, DVec3, Vec2, Vec3};
use sunbake::scene::looks::Look;
use sunbake::scene::{Material, Mesh};
use sunbake_runtime::testing::looks::{flat_image, named, texture, with_looks};
use sunbake_runtime::testing::masks::gpu;

/// A texel that leans to +x (right) and a little to +y (up).
const TEXEL: [u8; 3] = [178, 140, 240];

/// What it means in tangent space, scaled.
fn tilt(scale: f64) -> DVec3 {
    let [x, y, z] = TEXEL.map(|code| f64::from(code) / 255.0 * 2.0 - 1.0);
    DVec3::new(x * scale, y * scale, z).normalize()
}

fn with_uvs(change: impl Fn(Vec2) -> Vec2) -> Mesh {
    let mesh = square();
    let uvs = mesh.texcoord_set(0).unwrap().iter().map(|uv| change(*uv)).collect();
    Mesh { texcoords: vec![Some(uvs)], ..mesh }
}

/// A5: whatever lies how, right of the texture is where u grows, up is where v falls, and the normal is the front's.
#[test]
fn a_texel_tilts_the_normal_along_the_texture() {
    let gpu = gpu();
    let turn = |uv: Vec2| Vec2::new(-uv.y, uv.x);
    let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
    let mirrored = DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    let stretched = DMat4::from_scale(DVec3::new(2.0, 1.0, 0.5));
    let turned = DMat4::from_quat(DQuat::from_rotation_y(0.7));
    let quarter = DQuat::from_rotation_y(0.7);
    // Mesh, matrix, and where the texture's right and up lie in the world.
    let cases: [(&str, Mesh, DMat4, [DVec3; 2]); 8] = [
        ("upright", with_uvs(|uv| uv), DMat4::IDENTITY, [x, -z]),
        ("mirrored u", with_uvs(|uv| Vec2::new(-uv.x, uv.y)), DMat4::IDENTITY, [-x, -z]),
        ("mirrored v", with_uvs(|uv| Vec2::new(uv.x, -uv.y)), DMat4::IDENTITY, [x, z]),
        // u = -z, so right is -z; v = x, so up is -x.
        ("turned texture", with_uvs(turn), DMat4::IDENTITY, [-z, -x]),
        ("mirrored instance", with_uvs(|uv| uv), mirrored, [-x, -z]),
        ("mirrored twice", with_uvs(|uv| Vec2::new(-uv.x, uv.y)), mirrored, [x, -z]),
        ("stretched", with_uvs(|uv| uv), stretched, [x, -z]),
        ("turned", with_uvs(|uv| uv), turned, [quarter * x, quarter * -z]),
    ];
    for (name, mesh, matrix, [right, up]) in cases {
        for scale in [1.0, 0.5] {
            let look = Look { normal_texture: Some(texture(0)), normal_scale: scale, ..Look::PLAIN };
            let stage = squares(&[(mesh.clone(), named("it"), matrix)]);
            let stage = with_looks(stage, vec![flat_image(TEXEL)], |_| look);
            let moment = sun_alone(&stage);
            let found = middle(&gpu, &stage, DVec3::new(-0.7, 3.0, 0.9), &moment).x / moment.daylight.sun_light.x;
            let tilted = tilt(scale.into());
            let normal = right * tilted.x + up * tilted.y + y * tilted.z;
            let expected = 0.5 * normal.dot(moment.sun_direction.as_dvec3());
            assert!((f64::from(found) - expected).abs() < 1e-3, "{name}, scale {scale}: {found}, not {expected}");
        }
    }
}

/// A5: seen from behind, the tilted normal of a double-sided surface is reversed as a whole.
#[test]
fn the_back_of_a_double_sided_surface_has_the_reversed_normal() {
    let gpu = gpu();
    // Upside down, so that the sun shines on its back.
    let flipped = DMat4::from_quat(DQuat::from_rotation_x(std::f64::consts::PI));
    let look = Look { normal_texture: Some(texture(0)), ..Look::PLAIN };
    let material = Material { is_double_sided: true, ..named("it") };
    let stage = with_looks(squares(&[(square(), material, flipped)]), vec![flat_image(TEXEL)], |_| look);
    let moment = sun_alone(&stage);
    let found = middle(&gpu, &stage, DVec3::new(-0.7, 3.0, 0.9), &moment).x / moment.daylight.sun_light.x;
    let tilted = tilt(1.0);
    // The front's right is +x and its up +z; the front is -y.
    let front = DVec3::X * tilted.x + DVec3::Z * tilted.y - DVec3::Y * tilted.z;
    let expected = 0.5 * (-front).dot(moment.sun_direction.as_dvec3());
    assert!((f64::from(found) - expected).abs() < 1e-3, "{found}, not {expected}");
}

/// A5: a texture without extent has no directions, and tilts nothing.
#[test]
fn a_normal_map_on_coordinates_without_extent_changes_nothing() {
    let gpu = gpu();
    let look = Look { normal_texture: Some(texture(0)), ..Look::PLAIN };
    let plain = squares(&[(with_uvs(|_| Vec2::splat(0.5)), named("it"), DMat4::IDENTITY)]);
    let moment = sun_alone(&plain);
    let eye = DVec3::new(-0.7, 3.0, 0.9);
    let before = middle(&gpu, &plain, eye, &moment);
    let after = middle(&gpu, &with_looks(plain, vec![flat_image(TEXEL)], |_| look), eye, &moment);
    assert!((before - after).abs().max_element() < 1e-4 && before != Vec3::ZERO, "{before} {after}");
}
