//! B3, B4 and B17: the same scene elsewhere, at another size and on other numbers of threads bakes the same map.

use crate::{ao, bake, baked, ground, settings};
use glam::{DMat4, DVec3, Quat, Vec3};
use sunbake::ambient::AmbientSettings;
use sunbake::scene::{Mesh, Scene};
use sunbake::settings::{AmbientRequest, BakeSettings, VertexAttribute};
use sunbake::testing::{SceneBuilder, block, icosphere, opaque};

/// A post, a slab and a stone on a floor.
fn still_life(matrix: DMat4) -> Scene {
    let soup: Vec<[Vec3; 3]> = [
        ground(3.0),
        block(Vec3::new(-1.0, 0.0, -1.0), Vec3::new(-0.6, 1.7, -0.5)),
        block(Vec3::new(0.2, 0.9, -0.8), Vec3::new(1.8, 1.0, 0.9)),
        icosphere(2).iter().map(|t| t.map(|v| v * 0.4 + Vec3::new(-0.4, 0.2, 1.0))).collect(),
    ]
    .concat();
    let positions: Vec<Vec3> = soup.iter().flatten().copied().collect();
    let mesh = Mesh { indices: (0..positions.len() as u32).collect(), positions, ..Mesh::default() };
    SceneBuilder::new().mesh_of(mesh, opaque(), &[matrix]).build()
}

/// The largest difference in ambient occlusion between two bakes.
fn worst_difference(one: &Scene, other: &Scene) -> f64 {
    let [one, other] = [one, other].map(|scene| bake(scene, &settings()).1);
    assert_eq!(one.len(), other.len());
    one.iter().zip(&other).map(|(a, b)| (ao(a) - ao(b)).abs()).fold(0.0, f64::max)
}

#[test]
fn b3_a_scene_moved_by_a_million_metres_bakes_the_same_map() {
    let here = still_life(DMat4::IDENTITY);
    let there = still_life(DMat4::from_translation(DVec3::new(1e6, -3e6, 2e6)));
    assert_eq!(worst_difference(&here, &there), 0.0);
}

#[test]
fn b4_a_scene_of_any_size_bakes_the_same_map() {
    let scene = still_life(DMat4::IDENTITY);
    for scale in [1.0 / 8192.0, 8192.0] {
        assert_eq!(worst_difference(&scene, &still_life(DMat4::from_scale(DVec3::splat(scale)))), 0.0, "{scale}");
    }
    // No power of two: corners round otherwise, so that a ray that grazes one may go either way.
    for scale in [1e-4, 1e4] {
        let worst = worst_difference(&scene, &still_life(DMat4::from_scale(DVec3::splat(scale))));
        assert!(worst <= 2.0 / 256.0, "{scale}: {worst}");
    }
}

/// B17.
#[test]
fn the_same_bake_is_the_same_bytes_on_any_number_of_threads() {
    let scene = still_life(DMat4::from_rotation_translation(Quat::from_rotation_y(0.3).as_dquat(), DVec3::X));
    let request = AmbientRequest::with_rays(64);
    let all = AmbientRequest {
        estimate: AmbientSettings { wants_bent: true, wants_sky: true, error: Some(0.02), ..request.estimate },
        supersample: 2,
        exr: true,
        vertices: Some(VertexAttribute::Ao),
        ..request
    };
    let files = |threads: usize| {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let (set, _) = baked(&scene, &BakeSettings { threads, ambient: Some(all), ..settings() }, folder.path());
        let mut names: Vec<_> = std::fs::read_dir(&set.folder).unwrap().map(|entry| entry.unwrap().path()).collect();
        names.retain(|name| name.extension().is_some_and(|extension| extension != "json"));
        names.sort();
        assert_eq!(names.len(), 9, "{names:?}");
        names.iter().map(|name| std::fs::read(name).unwrap()).collect::<Vec<_>>()
    };
    let one = files(1);
    assert!([2, 2, 3, 7].into_iter().all(|threads| files(threads) == one));
}
