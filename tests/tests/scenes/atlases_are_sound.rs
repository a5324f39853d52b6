//! Atlases of real scenes: each triangle has texels that no other instance touches, and reads only those.

use libtest_mimic::Trial;
use std::path::Path;
use sunbake::atlas::{AtlasSettings, Density, LayoutOrigin, build};
use sunbake::scene::{LoadLimits, Scene, load};
use sunbake::testing::atlas::{CheckedAtlas, bake_and_check};
use sunbake_tests::needs::of_scene;

fn open(file: &Path) -> Scene {
    load(file, &LoadLimits::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn settings(page_size_texels: u32) -> AtlasSettings {
    AtlasSettings { density: Density::Pages(1), page_size_texels, ..AtlasSettings::default() }
}

fn every_triangle_has_texels_of_its_own(file: &Path, page_size_texels: u32) {
    bake_and_check(&open(file), &settings(page_size_texels));
}

fn valid_coordinates_of_the_file_are_kept(file: &Path) {
    let scene = open(file);
    let CheckedAtlas { atlas, .. } = bake_and_check(&scene, &settings(1024));
    for (layout, mesh) in atlas.layouts.iter().zip(&scene.meshes) {
        assert_eq!(layout.origin, LayoutOrigin::File, "{:?}", mesh.name);
        assert_eq!(Some(&layout.uvs), mesh.texcoords[1].as_ref());
    }
}

/// B16: the house's `TEXCOORD_1` was made for light maps, but two islands lie on top of others: 1.4 % of the area of
/// one mesh.
fn overlapping_coordinates_are_replaced(file: &Path) {
    let CheckedAtlas { atlas, .. } = bake_and_check(&open(file), &settings(1024));
    assert!(atlas.layouts.iter().all(|l| l.origin == LayoutOrigin::Unwrapped));
    assert_eq!(atlas.warnings.len(), 1, "{:?}", atlas.warnings);
}

/// B12.
fn meshes_under_many_nodes_are_unwrapped_once(file: &Path) {
    let scene = open(file);
    let atlas = build(&scene, &settings(2048), &|_| true).unwrap();
    assert_eq!(atlas.layouts.len(), scene.meshes.len());
    assert!(scene.instances.len() > 3 * scene.meshes.len());
}

/// Scenes, with the edge of a page in texels that they fit on.
const SHARED: [(&str, u32); 9] = [
    ("two_cylinder_engine/2CylinderEngine.glb", 1024),
    ("littlest_tokyo/littlest_tokyo.glb", 1024),
    ("osrf_city/osrf_city.glb", 2048),
    ("delft_3d/delft_raw.glb", 512),
    ("truck_town/truck_town.glb", 1024),
    ("japanese_bridge_garden/japanese_bridge_garden.glb", 512),
    ("gazebo_thin/tower_crane.glb", 512),
    ("mixed_lighting/MixedLightingExample.gltf", 512),
    ("box_textured/BoxTextured.glb", 128),
];

/// A claim, the scene that it is made of, and the check.
type NamedCheck = (&'static str, &'static str, fn(&Path));

pub fn trials() -> Vec<Trial> {
    let every = |(scene, page)| {
        of_scene("every_triangle_has_texels_of_its_own", scene, move |file| {
            every_triangle_has_texels_of_its_own(file, page);
        })
    };
    let others: [NamedCheck; 3] = [
        (
            "valid_coordinates_of_the_file_are_kept",
            "box_textured/CornellBox.glb",
            valid_coordinates_of_the_file_are_kept,
        ),
        ("overlapping_coordinates_are_replaced", "pc_house/house.glb", overlapping_coordinates_are_replaced),
        (
            "meshes_under_many_nodes_are_unwrapped_once",
            "osrf_city/osrf_city.glb",
            meshes_under_many_nodes_are_unwrapped_once,
        ),
    ];
    let others = others.map(|(claim, scene, test)| of_scene(claim, scene, test));
    SHARED.map(every).into_iter().chain(others).collect()
}
