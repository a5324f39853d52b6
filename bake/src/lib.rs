//! sunbake: bakes when every texel of a static scene sees the sun.
//!
//! The method is chapter 13 of *GPU Gems*, "Interactive Visibility with Occlusion Interval Maps" (Donnelly and Demers,
//! 2004). Data flows one way, and the modules read in that order; [`bake`] is the flow itself:
//!
//! ```text
//! scene -> atlas -> visibility, ambient -> maps -> disk
//!                        ^
//!                sun, lamp, trace
//! ```
//!
//! A module imports only what lies below it, in this order: `scene`, `sun` and `lamp`; `trace`; `atlas`; `visibility`
//! and `ambient`; `maps`; `settings`; `disk` and `glb`; `bake` with `plan`; `cost` and `cli`. [`intervals`] lies below
//! them all.

pub mod ambient;
pub mod atlas;
mod bake;
#[cfg(feature = "cli")]
pub mod console;
#[cfg(feature = "report")]
pub mod cost;
pub mod disk;
mod error;
pub mod glb;
pub mod heat;
pub mod intervals;
pub mod lamp;
mod loss;
pub mod loss_map;
pub mod maps;
pub mod plan;
pub mod progress;
mod remedy;
#[cfg(feature = "report")]
pub mod report;
pub mod scene;
pub mod settings;
pub mod statistics;
pub mod sun;
#[cfg(any(test, feature = "testing"))]
#[doc(hidden)]
pub mod testing;
pub mod texels;
pub mod trace;
pub mod visibility;
mod warning;

pub use bake::{Bake, BakeError, BakeReport, Prepared, bake, bake_scene, prepare, sun_path};
pub use error::{ErrorClass, Explain};
pub use remedy::{Remedy, Setting};
pub use warning::{Light, Warning};
