//! A baked set on disk: `sunbake.json`, `scene.glb` and the maps. Only [`mod@write`] writes one; only [`mod@read`]
//! reads one.

mod atlas;
mod exr_file;
pub mod folder;
pub mod manifest;
mod page;
mod png_file;
pub mod read;
mod tracks;
pub mod write;
mod write_ambient;
mod write_loss;

pub use exr_file::write_exr;
pub use page::BakedPage;
