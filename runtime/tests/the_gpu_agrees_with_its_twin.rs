//! Playback on the GPU against the same frames on the CPU. These tests need an adapter, and fail without one.

use glam::{DMat4, DVec3, Mat3, Vec2, Vec3, Vec4};
use sunbake::atlas::PageSize;
use sunbake::maps::{AmbientMaps, AmbientSide, Bits};
use sunbake::scene::{Alpha, Material, Mesh, Scene, TextureRef, Wrap};
use sunbake::testing::{SceneBuilder, alpha_masked, block, floor, icosphere, opaque, pseudo_random};
use sunbake::tracks::{FoundSpan, FoundSpans, Linked, MERGED, PageTracks, number_tracks};
use sunbake_runtime::compare::Agreement;
use sunbake_runtime::gpu::Gpu;
use sunbake_runtime::technique::{BakedCpu, BakedGpu};
use sunbake_runtime::testing::masks::gpu;
use sunbake_runtime::testing::{bake, bake_lanes, equinox, table_line, twins, view};
use sunbake_runtime::{AmbientModel, Filter, Shot, Stage};

/// Prints the table and returns what it holds.
fn compare(name: &str, gpu: &Gpu, stage: &Stage, eye: DVec3, target: DVec3, filter: Filter) -> Vec<Agreement> {
    let shot = Shot::new(stage, view(stage, eye, target, [192, 128]));
    let mut on_gpu = BakedGpu::new(gpu, stage, filter).unwrap();
    let mut on_cpu = BakedCpu::new(stage, filter);
    let mut found = Vec::new();
    for t in (0..8).map(|i| (f64::from(i) + 0.5) / 8.0) {
        for (what, agreement) in twins(&mut on_gpu, &mut on_cpu, &shot, t).unwrap() {
            println!("{}", table_line(name, t, what, &agreement));
            found.push(agreement);
        }
    }
    found
}

fn assert_agreement(found: &[Agreement]) {
    for agreement in found {
        assert!(agreement.share_within() >= 0.999 && agreement.unexplained == 0, "{agreement:?}");
        assert!(!agreement.worst.is_nan());
    }
}

fn posts() -> Scene {
    let mut builder = SceneBuilder::new().soup(&floor(Vec2::splat(-6.0), Vec2::splat(6.0), 0.0));
    for i in -2..=2 {
        let x = i as f32 * 2.0;
        builder = builder.block(Vec3::new(x, 0.0, -0.2), Vec3::new(x + 0.3, 2.5, 0.2));
    }
    let sphere: Vec<_> = icosphere(1).iter().map(|t| t.map(|v| v * 0.8 + Vec3::new(1.0, 0.9, 2.5))).collect();
    builder.soup(&sphere).build()
}

fn checker(wrap: Wrap) -> (SceneBuilder, TextureRef) {
    let texel = |i: u32| if (i % 16 + i / 16).is_multiple_of(2) { [230, 200, 160, 255] } else { [60, 80, 120, 60] };
    let (builder, image) = SceneBuilder::new().image(16, 16, (0..256).map(texel).collect());
    let texture = TextureRef {
        image,
        texcoord: 0,
        image_from_texcoord: Mat3::from_scale(Vec2::new(2.5, 1.5)),
        wrap: [wrap, wrap],
    };
    (builder, texture)
}

/// Soup with texture coordinates and colours.
fn dressed(triangles: &[[Vec3; 3]]) -> Mesh {
    let positions: Vec<Vec3> = triangles.iter().flatten().copied().collect();
    let uvs = positions.iter().map(|p| Vec2::new(p.x * 0.2 + p.y * 0.3, p.z * 0.2 - p.y * 0.1)).collect();
    let colors = positions.iter().map(|p| Vec4::new(0.5 + 0.05 * p.x, 0.8, 0.6 - 0.05 * p.z, 1.0)).collect();
    let indices = (0..positions.len() as u32).collect();
    Mesh { positions, texcoords: vec![Some(uvs)], colors: Some(colors), indices, ..Mesh::default() }
}

fn everything(wrap: Wrap) -> Scene {
    let (builder, texture) = checker(wrap);
    let textured = Material { base_color_texture: Some(texture), ..opaque() };
    let lamp = Material { emissive: Vec3::new(0.4, 0.2, 0.1), is_unlit: true, ..opaque() };
    let glass = Material { alpha: Alpha::Invisible, ..opaque() };
    let wall: Vec<_> = floor(Vec2::splat(-1.5), Vec2::splat(1.5), 0.0)
        .iter()
        .map(|t| t.map(|v| Vec3::new(v.x, v.z + 1.7, 0.4)))
        .collect();
    builder
        .mesh_of(dressed(&floor(Vec2::splat(-5.0), Vec2::splat(5.0), 0.0)), textured, &[DMat4::IDENTITY])
        .mesh_of(
            dressed(&wall),
            alpha_masked(texture),
            &[DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0)), DMat4::from_translation(DVec3::new(2.0, 0.0, 1.2))],
        )
        .mesh_of(
            dressed(&block(Vec3::ZERO, Vec3::ONE)),
            opaque(),
            &[
                DMat4::from_translation(DVec3::new(-3.5, 0.0, 2.0)),
                DMat4::from_scale_rotation_translation(
                    DVec3::new(-1.0, 2.0, 0.5),
                    glam::DQuat::from_rotation_y(0.5),
                    DVec3::new(3.0, 0.0, -2.0),
                ),
            ],
        )
        .soup_of(&block(Vec3::new(-2.0, 0.0, -2.0), Vec3::new(-1.0, 0.5, -1.0)), lamp)
        .soup_of(&block(Vec3::new(-1.0, 0.5, 3.0), Vec3::new(1.0, 1.5, 4.0)), glass)
        .build()
}

#[test]
fn posts_on_a_floor() {
    let gpu = gpu();
    let stage = bake(posts(), Some(equinox(35.0)), 20, Bits::Sixteen);
    for filter in [Filter::Bilinear, Filter::Sharp, Filter::Nearest] {
        let name = &format!("posts {filter:?}");
        assert_agreement(&compare(name, &gpu, &stage, DVec3::new(5.0, 4.0, 9.0), DVec3::new(0.0, 0.8, 0.0), filter));
    }
}

/// Maps of ambient light full of noise, of one side or two.
fn noisy_ambient(stage: &Stage, sides: usize) -> AmbientMaps {
    let texels = stage.pages[0].width as usize * stage.pages[0].height as usize;
    let mut state = 11;
    let mut code = || (pseudo_random(&mut state) * 65_535.0) as u16;
    let mut side = || AmbientSide {
        visibility: (0..texels).map(|_| code()).collect(),
        bent: Some((0..texels).map(|_| [0; 3].map(|_: u16| code())).collect()),
        sky: Some((0..texels).map(|_| [0; 9].map(|_: u16| code())).collect()),
    };
    AmbientMaps { front: side(), back: (sides > 1).then(side) }
}

#[test]
fn every_model_of_ambient_light() {
    let gpu = gpu();
    for (sides, model) in [1, 2].into_iter().flat_map(|sides| {
        [AmbientModel::Hemisphere, AmbientModel::Occlusion, AmbientModel::Bent, AmbientModel::Sky].map(|m| (sides, m))
    }) {
        let mut stage = bake(everything(Wrap::Repeat), Some(equinox(35.0)), 24, Bits::Eight);
        stage.pages[0].ambient = Some(noisy_ambient(&stage, sides));
        let stage = stage.with_ambient(model);
        assert_eq!(stage.best_ambient(), model);
        let name = format!("{model:?}, {sides} side(s)");
        let eye = DVec3::new(4.0, 3.5, -7.0);
        assert_agreement(&compare(&name, &gpu, &stage, eye, DVec3::new(0.0, 0.8, 0.0), Filter::Bilinear));
    }
}

/// Spans without any order, of up to a handful of occluders a texel.
fn noisy_tracks(stage: &Stage) -> PageTracks {
    let page = &stage.pages[0];
    let mut state = 17;
    let mut random = |n: f64| (pseudo_random(&mut state) * n) as u32;
    let mut found = FoundSpans::default();
    for _ in 0..page.width * page.height {
        let part = if random(4.0) == 0 { MERGED } else { random(3.0) };
        let spans = (0..random(7.0)).map(|i| {
            let start = 0.14 * f64::from(i) + 0.0001 * f64::from(random(600.0));
            FoundSpan::new(part, [start, start + 0.0001 * f64::from(random(800.0))])
        });
        found.push(spans.collect::<Vec<_>>());
    }
    let source: Vec<u32> = (0..page.width * page.height).collect();
    let size = PageSize { width: page.width, height: page.height };
    number_tracks(&found, &Linked { size, source: &source, is_open: &|texel, _| texel % 7 > 0 })
}

#[test]
fn shadow_tracks_with_and_without_walls() {
    let gpu = gpu();
    let mut stage = bake(posts(), Some(equinox(35.0)), 20, Bits::Sixteen);
    stage.pages[0].tracks = Some(noisy_tracks(&stage));
    let compared = |stage: &Stage, name: &str| {
        let (eye, target) = (DVec3::new(5.0, 4.0, 9.0), DVec3::new(0.0, 0.8, 0.0));
        assert_agreement(&compare(name, &gpu, stage, eye, target, Filter::Tracks));
    };
    compared(&stage, "tracks");
    let mut state = 3;
    let mut code = || (pseudo_random(&mut state) * 256.0) as u8;
    let walls = (0..stage.pages[0].width * stage.pages[0].height).map(|_| [code(), code()]).collect();
    stage.pages[0].walls = Some(walls);
    compared(&stage, "tracks among walls");
}

#[test]
fn posts_under_a_sun_without_width() {
    let gpu = gpu();
    let mut point = equinox(35.0);
    point.angular_radius_rad = 0.0;
    let stage = bake(posts(), Some(point), 20, Bits::Sixteen);
    for filter in [Filter::Bilinear, Filter::Sharp, Filter::Nearest] {
        let name = &format!("point sun {filter:?}");
        assert_agreement(&compare(name, &gpu, &stage, DVec3::new(5.0, 4.0, 9.0), DVec3::new(0.0, 0.8, 0.0), filter));
    }
}

#[test]
fn posts_under_a_disc_of_lanes() {
    let gpu = gpu();
    for lane_count in [3, 5] {
        let mut wide = equinox(35.0);
        wide.angular_radius_rad = 0.03;
        let stage = bake_lanes(posts(), Some(wide), 16, Bits::Sixteen, lane_count);
        assert_eq!(stage.pages[0].lanes.len(), lane_count);
        let eye = DVec3::new(5.0, 4.0, 9.0);
        for filter in [Filter::Bilinear, Filter::Sharp] {
            let name = format!("posts, {lane_count} lanes, {filter:?}");
            assert_agreement(&compare(&name, &gpu, &stage, eye, DVec3::new(0.0, 0.8, 0.0), filter));
        }
    }
}

#[test]
fn textures_alpha_masks_mirrors_colours_and_lamps() {
    let gpu = gpu();
    for wrap in [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp] {
        let stage = bake(everything(wrap), Some(equinox(35.0)), 24, Bits::Eight);
        let name = format!("everything {wrap:?}");
        let eye = DVec3::new(4.0, 3.5, 7.0);
        assert_agreement(&compare(&name, &gpu, &stage, eye, DVec3::new(0.0, 0.8, 0.0), Filter::Bilinear));
    }
}
