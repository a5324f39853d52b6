//! B13, B14 and B6: alpha-masked leaves, a fence with more intervals than a layer holds, a wall on a floor.

use crate::{all_texels, temporary};
use glam::{DMat4, Vec2, Vec3};
use sunbake::atlas::Density;
use sunbake::scene::{Alpha, Material, Mesh, Scene, TextureRef, Wrap};
use sunbake::settings::{BakeSettings, SunRequest};
use sunbake::testing::{SceneBuilder, alpha_masked, block, floor};
use sunbake_tests::{CODE_STEP_T, bake_scene, june_day, quick};

/// A card over a floor, its left half transparent, its right half opaque at 200 of 255, under a sun at the zenith.
fn leaf_over_floor(cutoff: f32) -> Scene {
    let (builder, image) = SceneBuilder::new().image(2, 1, vec![[255, 255, 255, 0], [255, 255, 255, 200]]);
    let texture = TextureRef { image, texcoord: 0, image_from_texcoord: glam::Mat3::IDENTITY, wrap: [Wrap::Clamp; 2] };
    let triangles = floor(Vec2::splat(-1.0), Vec2::splat(1.0), 1.0);
    let positions: Vec<Vec3> = triangles.into_iter().flatten().collect();
    let uvs = positions.iter().map(|p| Vec2::new(p.x * 0.5 + 0.5, 0.5)).collect();
    let mesh = Mesh {
        indices: (0..positions.len() as u32).collect(),
        positions,
        texcoords: vec![Some(uvs)],
        ..Mesh::default()
    };
    builder
        .soup(&floor(Vec2::splat(-2.0), Vec2::splat(2.0), 0.0))
        .mesh_of(mesh, Material { alpha: Alpha::Mask { cutoff }, ..alpha_masked(texture) }, &[DMat4::IDENTITY])
        .build()
}

/// B13: a leaf casts its cut-out. At cutoff 0 all of it is solid, at cutoff 1 what is not fully opaque is air.
#[test]
fn a_leaf_casts_its_cut_out_and_not_its_card() {
    let folder = temporary();
    let overhead =
        r#"{"keys": [{"azimuth_deg": 90, "elevation_deg": 89.99}, {"azimuth_deg": 270, "elevation_deg": 89.99}]}"#;
    let sun = SunRequest::Keyed { json: overhead.into(), north_deg: 0.0 };
    let settings = BakeSettings { sun, density: Density::Pages(1), ..quick() };
    for (cutoff, casts) in [(0.5, [false, true]), (0.0, [true, true]), (1.0, [false, false])] {
        let set = bake_scene(&leaf_over_floor(cutoff), &settings, folder.path(), "leaf");
        let mut seen = [0, 0];
        for texel in all_texels(&set).iter().filter(|t| t.instance == 0) {
            let [x, _, z] = texel.position;
            if !(0.1..0.9).contains(&x.abs()) || z.abs() > 0.9 {
                continue;
            }
            let side = usize::from(x > 0.0);
            seen[side] += 1;
            assert_eq!(texel.lit.is_empty(), casts[side], "cutoff {cutoff}: {texel:?}");
        }
        assert!(seen[0] > 50 && seen[1] > 50, "{seen:?}");
    }
}

/// B14: behind a picket fence texels flicker more often than one layer can say. The loss is reported, and more layers
/// remove it.
#[test]
fn a_picket_fence_reports_what_one_layer_loses() {
    let folder = temporary();
    let mut builder = SceneBuilder::new().soup(&floor(Vec2::splat(-5.0), Vec2::splat(5.0), 0.0));
    for i in 0..24 {
        let x = -5.0 + i as f32 * 0.4;
        builder = builder.block(Vec3::new(x, 0.0, 0.0), Vec3::new(x + 0.2, 6.0, 0.05));
    }
    let scene = builder.build();
    let day = june_day();
    let winter = sunbake::sun::DayRequest { date: "2026-12-21".parse().expect("a date"), ..day };
    let bake = |layer_cap| {
        let settings = BakeSettings { sun: SunRequest::Day(winter.clone()), layer_cap, ..quick() };
        bake_scene(&scene, &settings, folder.path(), "fence").manifest
    };
    let one = bake(1);
    assert_eq!(one.atlases[0].lanes[0].layers.len(), 1);
    assert!(one.error.merged_texels > 100 && one.error.merge_min.worst > 1.0, "{:?}", one.error);
    let enough = bake(16);
    assert_eq!(enough.error.merged_texels, 0);
    assert!(enough.atlases[0].lanes[0].layers.len() as u64 == enough.stats.most_intervals.div_ceil(4));
}

/// B6: the sun rises behind a wall that stands on a floor. No texel in front of it is lit earlier than the wall's
/// height allows, at any density of texels.
#[test]
fn no_texel_before_a_wall_is_lit_too_early_at_any_density() {
    let folder = temporary();
    let keys = r#"{"keys": [{"azimuth_deg": 270, "elevation_deg": 0}, {"azimuth_deg": 0, "elevation_deg": 90},
        {"azimuth_deg": 90, "elevation_deg": 0}]}"#;
    let height = 2.0;
    for (kind, thickness) in [("block", 0.2), ("sheet", 0.0f32)] {
        let wall = match thickness > 0.0 {
            true => block(Vec3::new(-thickness, 0.0, -4.0), Vec3::new(0.0, height, 4.0)),
            false => floor(Vec2::new(0.0, -4.0), Vec2::new(height, 4.0), 0.0)
                .iter()
                .map(|t| t.map(|v| Vec3::new(0.0, v.x, v.z)))
                .collect(),
        };
        let scene = SceneBuilder::new().soup(&floor(Vec2::splat(-4.0), Vec2::splat(4.0), 0.0)).soup(&wall).build();
        for texels_per_metre in [0.7, 3.0, 17.0] {
            let settings = BakeSettings {
                sun: SunRequest::Keyed { json: keys.into(), north_deg: 0.0 },
                density: Density::TexelsPerMetre(texels_per_metre),
                page_size_texels: 1024,
                ..quick()
            };
            let set = bake_scene(&scene, &settings, folder.path(), kind);
            let texels = all_texels(&set);
            let shaded = texels.iter().filter(|t| t.instance == 0 && t.position[0] > 1e-3);
            let mut count = 0;
            for texel in shaded {
                count += 1;
                let near = f64::from(height).atan2(texel.position[0]);
                let far = f64::from(height).atan2(texel.position[0] + f64::from(thickness));
                let earliest = near.max(far) / std::f64::consts::PI - CODE_STEP_T;
                let start = texel.lit.first().map_or(1.0, |lit| lit[0]);
                assert!(start >= earliest, "{kind} at {texels_per_metre} texels/m: {texel:?} before {earliest}");
            }
            assert!(count >= 8, "{kind} at {texels_per_metre} texels/m has {count} texels in front of the wall");
        }
    }
}
