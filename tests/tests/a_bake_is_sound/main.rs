//! Hard cases of whole bakes, from a file to the maps that are read back: B3, B4, B6, B9, B11 to B14, B17.

mod leaves_fences_and_walls;
mod place_size_and_threads;
mod stored_times;
mod triangles_and_instances;

use glam::{Vec2, Vec3};
use sunbake::disk::read::BakedSet;
use sunbake::scene::Material;
use sunbake::testing::{SceneBuilder, floor, opaque};
use sunbake::texels::{Texel, draw};

fn temporary() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

fn all_texels(set: &BakedSet) -> Vec<Texel> {
    draw(set, usize::MAX, 0).expect("the set's scene loads")
}

/// A courtyard: a floor, a block and a leaning sheet.
fn courtyard() -> SceneBuilder {
    let sheet = [Vec3::new(-3.0, 0.0, 1.0), Vec3::new(-1.0, 0.0, 2.0), Vec3::new(-2.5, 3.0, 0.5)];
    SceneBuilder::new()
        .soup(&floor(Vec2::splat(-6.0), Vec2::splat(6.0), 0.0))
        .block(Vec3::new(0.5, 0.0, -1.5), Vec3::new(2.0, 2.5, 1.0))
        .soup_of(&[sheet], Material { is_double_sided: true, ..opaque() })
}
