//! B5 and B6: doubled faces, faces on the ground, walls on a floor, closed rooms.

use crate::{ao, bake, ground, settings};
use glam::{DVec3, Vec2, Vec3};
use sunbake::ambient::{AmbientPoint, AmbientSettings};
use sunbake::settings::{AmbientRequest, BakeSettings};
use sunbake::testing::{SceneBuilder, block, floor};
use sunbake_tests::ambient::{ambient_visibility, flat, rays};
use sunbake_tests::{Traced, flipped};

#[test]
fn b5_coincident_faces_do_not_speckle() {
    for other in [ground(2.0), flipped(&ground(2.0))] {
        let (_, texels) = bake(&SceneBuilder::new().soup(&ground(2.0)).soup(&other).build(), &settings());
        assert!(texels.len() > 1000 && texels.iter().all(|texel| ao(texel) == 1.0));
    }
    // A room whose walls are doubled, both ways round, is dark and not taken for the inside of a solid.
    let room = block(-Vec3::ONE, Vec3::ONE);
    let scene = SceneBuilder::new().soup(&room).soup(&flipped(&room)).build();
    let request = AmbientRequest::with_rays(64);
    let near = AmbientRequest { estimate: AmbientSettings { distance_m: Some(0.5), ..request.estimate }, ..request };
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
            assert_eq!(ao(texel), 0.0, "at {x}, {z}");
        } else if outside > 0.0 {
            open_ground += 1;
            assert!(ao(texel) > 0.99, "{} at {x}, {z}", ao(texel));
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
        let mean = ambient_visibility(&traced, &points, rays(1024)).iter().sum::<f64>() / 64.0;
        assert!((mean - 0.5).abs() < 0.01, "{mean} at {off} m");
    }
    let (_, texels) = bake(&SceneBuilder::new().soup(&flipped(&block(-Vec3::ONE, Vec3::ONE))).build(), &settings());
    assert!(texels.len() > 500 && texels.iter().all(|texel| ao(texel) == 0.0));
}
