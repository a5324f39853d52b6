//! What an atlas promises, on scenes built by code.

use super::scenes::{cuboid, hills, lit_quad, once, scene, sphere, triangles};
use crate::atlas::{Atlas, AtlasError, AtlasSettings, Density, LayoutOrigin, Misfit, Placement, build};
use crate::scene::{Mesh, Scene};
use crate::testing::atlas::{bake, bake_and_check};
use glam::{DMat4, DQuat, DVec3, Vec2, Vec3};

fn settings(density: Density, page_size_texels: u32) -> AtlasSettings {
    AtlasSettings { density, page_size_texels, ..AtlasSettings::default() }
}

fn village() -> Scene {
    let turned = |i: usize| {
        let at = DVec3::new(i as f64 * 3.0, 0.0, (i % 7) as f64);
        DMat4::from_scale_rotation_translation(
            DVec3::splat(0.5 + 0.1 * (i % 9) as f64),
            DQuat::from_rotation_y(i as f64),
            at,
        )
    };
    scene(vec![
        (hills(24, 0.8), once()),
        (cuboid(Vec3::new(4.0, 3.0, 5.0)), (0..20).map(turned).collect()),
        (sphere(12), (0..40).map(turned).collect()),
        (cuboid(Vec3::new(0.02, 9.0, 0.02)), (0..15).map(turned).collect()),
    ])
}

#[test]
fn every_texel_has_one_owner_and_every_triangle_reads_its_own() {
    for padding_texels in [2, 3, 4] {
        for density in [Density::Pages(1), Density::Pages(3), Density::TexelsPerMetre(6.0)] {
            bake_and_check(&village(), &AtlasSettings { padding_texels, ..settings(density, 512) });
        }
    }
}

/// B17.
#[test]
fn the_same_scene_gives_the_same_bytes_at_any_thread_count() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let baked = pool.install(|| bake(&village(), &settings(Density::Pages(2), 256)));
        (format!("{:?}", baked.atlas), format!("{:?}", baked.pages), baked.shown)
    };
    let once = run(1);
    assert!(once == run(1) && once == run(2) && once == run(5));
}

#[test]
fn a_density_in_texels_a_metre_is_kept_on_as_many_pages_as_it_takes() {
    for (asked, pages) in [(2.0, 1..=1), (8.0, 2..=12)] {
        let atlas = bake_and_check(&village(), &settings(Density::TexelsPerMetre(asked), 256)).atlas;
        // Small instances of a mesh may be shown larger, when that makes its layout cheaper.
        let ratio = atlas.texels_per_metre / asked;
        assert!((0.97..1.25).contains(&ratio), "{} instead of {asked}", atlas.texels_per_metre);
        assert!(pages.contains(&atlas.pages.len()), "{} pages", atlas.pages.len());
        assert!(atlas.warnings.is_empty(), "{:?}", atlas.warnings);
    }
}

#[test]
fn a_mesh_larger_than_a_page_gets_less_density_and_a_warning() {
    let scene = scene(vec![(hills(40, 0.0), once()), (cuboid(Vec3::ONE), once())]);
    let atlas = bake_and_check(&scene, &settings(Density::TexelsPerMetre(16.0), 256)).atlas;
    assert_eq!(atlas.warnings.len(), 1, "{:?}", atlas.warnings);
    let side = |instance: usize| {
        let layout = &atlas.layouts[instance];
        let page = atlas.pages[atlas.placements[instance].page as usize];
        let ends = layout.uvs.iter().map(|&uv| atlas.texel(instance, uv, page).x);
        ends.clone().fold(f64::MIN, f64::max) - ends.fold(f64::MAX, f64::min)
    };
    assert!(side(0) > 200.0 && side(0) < 256.0, "the ground is {} texels wide", side(0));
    assert!(side(1) > 15.0, "the box is {} texels wide", side(1));
}

#[test]
fn a_chart_longer_than_the_page_is_fitted_into_it() {
    let pole = scene(vec![(cuboid(Vec3::new(0.1, 300.0, 0.1)), once()), (cuboid(Vec3::splat(20.0)), once())]);
    for density in [Density::Pages(1), Density::TexelsPerMetre(4.0)] {
        bake_and_check(&pole, &settings(density, 256));
    }
}

#[test]
fn instances_of_very_different_scale_share_a_layout_without_wasting_the_page() {
    let scales = [0.01, 0.02, 0.3, 1.0, 1.0, 8.0];
    let matrices = scales.iter().map(|&s| DMat4::from_scale(DVec3::splat(s))).collect();
    let scene = scene(vec![(cuboid(Vec3::new(1.0, 2.0, 3.0)), matrices)]);
    let baked = bake_and_check(&scene, &settings(Density::Pages(1), 512));
    let covered: usize = baked.pages.iter().map(|p| p.samples.len()).sum();
    let share = covered as f64 / baked.atlas.texel_count() as f64;
    assert!(share > 0.4, "only {share:.3} of the page is covered");
}

#[test]
fn an_instance_gets_texels_for_the_area_it_has_in_the_scene() {
    let flat = DMat4::from_scale(DVec3::new(4.0, 4.0, 1e-6));
    let scene = scene(vec![(cuboid(Vec3::ONE), vec![DMat4::IDENTITY, flat])]);
    let atlas = bake_and_check(&scene, &settings(Density::Pages(1), 512)).atlas;
    let ratio = atlas.placements[1].scale.x / atlas.placements[0].scale.x;
    // 6 square metres against 32.
    assert!((f64::from(ratio) - (32.0f64 / 6.0).sqrt()).abs() < 0.05, "{ratio}");
}

#[test]
fn invisible_surfaces_have_no_texels() {
    let mut haze = cuboid(Vec3::ONE);
    haze.material = 1;
    let scene = scene(vec![(haze, once()), (cuboid(Vec3::ONE), once())]);
    let baked = bake_and_check(&scene, &settings(Density::Pages(1), 128));
    assert!(baked.atlas.placements[0].is_empty() && !baked.atlas.placements[1].is_empty());
    assert_eq!(baked.atlas.layouts[0].indices, scene.meshes[0].indices);
    assert!(baked.pages[0].samples.iter().all(|s| baked.geometry.instance[s.triangle as usize] == 1));
}

#[test]
fn an_empty_scene_gives_an_atlas_without_pages() {
    for scene in [scene(Vec::new()), scene(vec![(Mesh::default(), once())])] {
        let atlas = build(&scene, &AtlasSettings::default(), &|_| true).unwrap();
        assert!(atlas.pages.is_empty());
    }
}

#[test]
fn progress_grows_and_can_stop_the_build() {
    let last = std::sync::Mutex::new(0.0);
    let grows = |fraction: f64| {
        let mut last = last.lock().unwrap();
        assert!((*last..=1.0).contains(&fraction), "{fraction} after {last}");
        *last = fraction;
        true
    };
    build(&village(), &settings(Density::Pages(1), 512), &grows).unwrap();
    for stop in [0.0, 0.4, 0.75] {
        let result = build(&village(), &settings(Density::Pages(1), 512), &|fraction| fraction < stop);
        assert_eq!(result.err(), Some(AtlasError::Cancelled), "at {stop}");
    }
}

#[test]
fn settings_out_of_range_are_refused() {
    let fine = AtlasSettings::default();
    for bad in [
        AtlasSettings { page_size_texels: 8, ..fine },
        AtlasSettings { page_size_texels: 1 << 20, ..fine },
        AtlasSettings { padding_texels: 0, ..fine },
        AtlasSettings { padding_texels: 1000, ..fine },
        AtlasSettings { density: Density::Pages(0), ..fine },
        AtlasSettings { density: Density::TexelsPerMetre(f64::NAN), ..fine },
        AtlasSettings { density: Density::TexelsPerMetre(-1.0), ..fine },
    ] {
        let refused = build(&village(), &bad, &|_| true);
        assert!(matches!(refused, Err(AtlasError::BadSetting { .. })), "{bad:?}");
    }
    let dense = build(&village(), &settings(Density::TexelsPerMetre(1e6), 4096), &|_| true);
    assert!(matches!(dense, Err(AtlasError::TooDense { .. })));
    let crowd: Vec<_> =
        (0..5000).map(|i| [Vec3::X, Vec3::Y, Vec3::Z].map(|p| p + Vec3::splat(2.0 * i as f32))).collect();
    let small = build(&scene(vec![(triangles(&crowd), once())]), &settings(Density::Pages(1), 64), &|_| true);
    let crowded = Misfit::Charts { instance: 0, charts: 5000 };
    assert!(matches!(small, Err(AtlasError::PageTooSmall { misfit, .. }) if misfit == crowded), "{small:?}");
    let mut dense = village();
    dense.instances[1].role.texels_per_metre = Some(1000.0);
    let roomy = AtlasSettings { most_texels: u64::MAX, ..settings(Density::Pages(1), 64) };
    let large = build(&dense, &roomy, &|_| true);
    let by_density = Misfit::Density { instance: 1 };
    assert!(matches!(large, Err(AtlasError::PageTooSmall { misfit, .. }) if misfit == by_density), "{large:?}");
}

fn is_whole_page(atlas: &Atlas) -> bool {
    let whole = Placement { page: 0, scale: Vec2::ONE, offset: Vec2::ZERO };
    atlas.pages.len() == 1 && atlas.placements.iter().all(|p| *p == whole)
}

#[test]
fn a_layout_of_the_whole_scene_is_used_as_it_is() {
    let left = lit_quad(Vec2::new(0.02, 0.02), Vec2::new(0.48, 0.98));
    let right = lit_quad(Vec2::new(0.52, 0.02), Vec2::new(0.98, 0.98));
    let scene = scene(vec![(left, once()), (right, once())]);
    let atlas = bake_and_check(&scene, &settings(Density::Pages(1), 256)).atlas;
    assert!(is_whole_page(&atlas));
    for (layout, mesh) in atlas.layouts.iter().zip(&scene.meshes) {
        assert_eq!(layout.origin, LayoutOrigin::File);
        assert_eq!(Some(&layout.uvs), mesh.texcoords[1].as_ref());
        assert_eq!(layout.indices, mesh.indices);
    }
    let unwraps = AtlasSettings { keeps_existing: false, ..settings(Density::Pages(1), 256) };
    assert!(build(&scene, &unwraps, &|_| true).unwrap().layouts.iter().all(|l| l.origin == LayoutOrigin::Unwrapped));
}

#[test]
fn layouts_of_single_meshes_get_rectangles_beside_unwrapped_ones() {
    let quad = lit_quad(Vec2::new(0.1, 0.2), Vec2::new(0.9, 0.8));
    let twice = vec![DMat4::IDENTITY, DMat4::from_translation(DVec3::Y)];
    let scene = scene(vec![(quad.clone(), twice), (quad, once()), (cuboid(Vec3::ONE), once())]);
    let atlas = bake_and_check(&scene, &settings(Density::Pages(1), 256)).atlas;
    assert_eq!(atlas.layouts[0].origin, LayoutOrigin::File);
    assert_eq!(Some(&atlas.layouts[0].uvs), scene.meshes[0].texcoords[1].as_ref());
    assert_eq!(atlas.layouts[2].origin, LayoutOrigin::Unwrapped);
}

/// B16.
#[test]
fn islands_of_the_file_that_would_share_texels_are_unwrapped_again() {
    // Four hundred squares with a gap of a thousandth between them: fine at 4096 texels, not at 128.
    let mut tiles = Mesh { texcoords: vec![None, Some(Vec::new())], ..Mesh::default() };
    for k in 0..400u32 {
        let at = Vec2::new((k % 20) as f32, (k / 20) as f32) / 20.0;
        let mut quad = lit_quad(at, at + 0.049);
        let first = tiles.positions.len() as u32;
        tiles.positions.extend(quad.positions.iter().map(|p| *p + Vec3::splat(2.0 * k as f32)));
        tiles.indices.extend(quad.indices.iter().map(|i| first + i));
        tiles.texcoords[1].as_mut().unwrap().extend(quad.texcoords[1].take().unwrap());
    }
    let scene = scene(vec![(tiles, once())]);
    let origin = |side: u32| bake_and_check(&scene, &settings(Density::Pages(1), side)).atlas.layouts[0].origin;
    assert_eq!(origin(128), LayoutOrigin::Unwrapped);
    assert_eq!(origin(4096), LayoutOrigin::File);
}
