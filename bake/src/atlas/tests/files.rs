//! The same claims on real scenes, where they are present: in the folder that `SUNBAKE_SHARED` names, else in `../shared`
//! beside the repository. A test that finds no scene says so.

use super::check::bake_and_check;
use crate::atlas::{AtlasSettings, Density, LayoutOrigin, build};
use crate::scene::{LoadLimits, Scene, load};
use std::path::PathBuf;

fn open(name: &str) -> Option<Scene> {
    let beside = || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared"));
    let path = std::env::var_os("SUNBAKE_SHARED").map_or_else(beside, PathBuf::from).join("scenes").join(name);
    if !path.exists() {
        println!("skipped: no {}", path.display());
        return None;
    }
    Some(load(&path, &LoadLimits::default()).unwrap())
}

fn settings(page_size_texels: u32) -> AtlasSettings {
    AtlasSettings { density: Density::Pages(1), page_size_texels, ..AtlasSettings::default() }
}

#[test]
fn real_scenes_have_unique_texels_for_every_triangle() {
    for (name, side) in [
        ("two_cylinder_engine/2CylinderEngine.glb", 1024),
        ("littlest_tokyo/littlest_tokyo.glb", 1024),
        ("osrf_city/osrf_city.glb", 2048),
        ("delft_3d/delft_raw.glb", 512),
        ("truck_town/truck_town.glb", 1024),
        ("japanese_bridge_garden/japanese_bridge_garden.glb", 512),
        ("gazebo_thin/tower_crane.glb", 512),
        ("mixed_lighting/MixedLightingExample.gltf", 512),
        ("box_textured/BoxTextured.glb", 128),
    ] {
        if let Some(scene) = open(name) {
            println!("{name}");
            bake_and_check(&scene, &settings(side));
        }
    }
}

#[test]
fn cornell_box_keeps_its_own_coordinates() {
    let Some(scene) = open("box_textured/CornellBox.glb") else { return };
    let atlas = bake_and_check(&scene, &settings(1024)).atlas;
    for (layout, mesh) in atlas.layouts.iter().zip(&scene.meshes) {
        assert_eq!(layout.origin, LayoutOrigin::File, "{:?}", mesh.name);
        assert_eq!(Some(&layout.uvs), mesh.texcoords[1].as_ref());
    }
}

/// Its `TEXCOORD_1` was made for light maps, but two islands lie on top of others: 1.4 % of the area of one mesh.
#[test]
fn pc_house_overlaps_and_is_unwrapped_anew() {
    let Some(scene) = open("pc_house/house.glb") else { return };
    let atlas = bake_and_check(&scene, &settings(1024)).atlas;
    assert!(atlas.layouts.iter().all(|l| l.origin == LayoutOrigin::Unwrapped));
    assert_eq!(atlas.warnings.len(), 1, "{:?}", atlas.warnings);
}

#[test]
fn meshes_under_many_nodes_are_unwrapped_once() {
    let Some(scene) = open("osrf_city/osrf_city.glb") else { return };
    let atlas = build(&scene, &settings(2048), &|_| true).unwrap();
    assert_eq!(atlas.layouts.len(), scene.meshes.len());
    assert!(scene.instances.len() > 3 * scene.meshes.len());
}
