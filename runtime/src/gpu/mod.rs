//! Drawing on the GPU, with the caller's device or one opened here, and without a window.
//!
//! | module | what it holds |
//! |---|---|
//! | `device` | the GPU and its errors |
//! | `frame` | what all renderers share: the scene's buffers and textures, pipelines, targets, passes, readback |
//! | `plan` | what a scene calls for, counted before anything is built |
//! | `baked` | a renderer of baked maps |
//! | `volumes` | a renderer of stencil shadow volumes |
//! | `shadow_maps` | a renderer of shadow maps |
//!
//! Built once per stage: vertex streams, the textures of each atlas page, base colour textures. Built when first
//! needed: one pipeline per variant of surface, page and output. Per frame: uniforms are written; a depth pass; one
//! or more passes that light. Depth is reversed and infinite, `Depth32Float`: 1 at the near plane, 0 at infinity.
//! Later passes draw where depths are equal, so that each pixel is lit once.
//!
//! What a scene does not call for is not built. That is decided before anything is built (`plan`, and each renderer's
//! own `plan.rs`), by the same keys that pipelines are built by. [`Census`](crate::plan::Census) counts what was
//! built, and tests compare the two.
//!
//! Each renderer draws with `draw_into` into a texture view of the caller's, with the caller's encoder. `lit`,
//! `visibility` and `lamp_visibility` draw into a texture of the renderer's own and read it back.

mod baked;
mod device;
mod frame;
mod plan;
mod shadow_maps;
mod volumes;

pub use baked::{BakedRenderer, baked_plan};
pub use device::{Gpu, GpuError};
pub use frame::{FrameTimes, Output, PictureTarget};
pub(crate) use plan::of_maps_alone;
pub use shadow_maps::{MapRenderer, MapReport, maps_plan};
pub use volumes::{FrameReport, LightReport, VolumeRenderer, VolumeSettings, volumes_plan};
