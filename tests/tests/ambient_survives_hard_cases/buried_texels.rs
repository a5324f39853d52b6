//! B10: surfaces inside solids are dark, and do not darken what lies beside them.

use crate::{ao, bake, settings};
use glam::Vec3;
use sunbake::ambient::AmbientPoint;
use sunbake::scene::{Material, Scene};
use sunbake::settings::{AmbientRequest, BakeSettings};
use sunbake::testing::{SceneBuilder, block, opaque};
use sunbake_tests::Traced;
use sunbake_tests::ambient::{ambient_at, flat, rays};

#[test]
fn b10_buried_texels_are_dark_and_do_not_bleed() {
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
            assert_eq!(ao(texel), 0.0, "buried at {x}, {z}");
        } else if is_top && outside > -0.95 * texel_m && outside < 1.5 * texel_m {
            // Beside the stone, on both sides of its border, the ground's own value shows, never the dark beneath the
            // stone.
            assert!(ao(texel) > 0.4, "{} at {x}, {z}, {outside} outside", ao(texel));
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
        assert!(estimate.visibility.is_finite() && estimate.bent.is_finite());
        let is_between = (point.surface.position_m.x + traced.scene.centre_m.x - 1.0).abs() < 1e-6
            && point.surface.normal.x.abs() > 0.9;
        assert_eq!(estimate.visibility, if is_between { 0.0 } else { 1.0 }, "{point:?}");
    }
}
