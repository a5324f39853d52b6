//! Playback on the GPU, without a window.
//!
//! Built once per stage (`scene.rs`): vertex streams, one texture pair a page, base colour textures; and one pipeline per variant
//! that occurs (`program.rs`). Per frame: one uniform buffer is written; a depth pass, then one pass that lights (or that tells
//! visibility). Depth is reversed and infinite, `Depth32Float`; the second pass draws where depths are equal, so that
//! each pixel is lit once. `volumes` puts passes between, and a stencil beside the depths.
//!
//! What the scene does not call for is not built. What it does is decided before anything is (`needs.rs`, and each technique's own
//! `needs.rs` or `baked_plan.rs`), by the same keys that pipelines are built by; [`Census`] counts what was built, and tests
//! hold the one against the other.

mod baked_plan;
mod batch;
mod buffers;
mod census;
mod device;
mod effects;
mod maps;
mod needs;
mod program;
mod readback;
mod renderer;
mod scene;
mod shadow_maps;
mod stopwatch;
mod target;
mod textures;
mod volumes;

pub use baked_plan::baked_plan;
pub use census::Census;
pub use device::{Gpu, GpuError};
pub(crate) use effects::of_maps_alone;
pub use renderer::{Output, Renderer};
pub use shadow_maps::{MapRenderer, MapReport, maps_plan};
pub use stopwatch::FrameTimes;
pub use volumes::{FrameReport, LightReport, VolumeRenderer, VolumeSettings, volumes_plan};
