//! Hard cases of ambient occlusion: B3 to B11, B13 and B17, and the texels of buried surfaces, cards and closed rooms.

mod buried_texels;
mod cards_and_rooms;
mod coincident_faces_and_walls;
mod place_and_size;
mod seams_and_grates;
mod triangles_and_solids;

use glam::{Vec2, Vec3};
use std::path::Path;
use sunbake::disk::read::BakedSet;
use sunbake::maps::AmbientSide;
use sunbake::scene::{Mesh, Scene};
use sunbake::settings::{AmbientRequest, BakeSettings};
use sunbake::testing::{floor, icosphere};
use sunbake::texels::{Texel, draw};
use sunbake_tests::{bake_scene, quick};

fn settings() -> BakeSettings {
    BakeSettings { bakes_intervals: false, ambient: Some(AmbientRequest::with_rays(256)), ..quick() }
}

fn baked(scene: &Scene, settings: &BakeSettings, folder: &Path) -> (BakedSet, Vec<Texel>) {
    let set = bake_scene(scene, settings, folder, "set");
    let texels = draw(&set, usize::MAX, 0).expect("the set's scene");
    (set, texels)
}

fn bake(scene: &Scene, settings: &BakeSettings) -> (BakedSet, Vec<Texel>) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    baked(scene, settings, folder.path())
}

fn front(set: &BakedSet) -> &AmbientSide {
    &set.pages[0].ambient.as_ref().expect("ambient light").front
}

fn ao(texel: &Texel) -> f64 {
    texel.ao.expect("ambient occlusion")
}

fn ground(half: f32) -> Vec<[Vec3; 3]> {
    floor(Vec2::splat(-half), Vec2::splat(half), 0.0)
}

/// A ball of `20 * 4^level` facets with the normals of a round one.
fn ball(level: u32) -> Mesh {
    let positions: Vec<Vec3> = icosphere(level).iter().flatten().copied().collect();
    let indices = (0..positions.len() as u32).collect();
    Mesh { indices, normals: Some(positions.clone()), positions, ..Mesh::default() }
}
