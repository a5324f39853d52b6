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
//!
//! # A tour
//!
//! Bake a scene in memory, look at what came of it, and write the set:
//!
//! ```no_run
//! use std::path::Path;
//! use sunbake::progress::Silent;
//! use sunbake::scene::{LoadLimits, load};
//! use sunbake::settings::{BakeSettings, SunRequest};
//! use sunbake::sun::DayRequest;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let scene = load(Path::new("scene.glb"), &LoadLimits::default())?;
//! let day = DayRequest::new(Some([48.2, 16.4]), Some("2026-06-21".parse()?))?;
//! let bake = sunbake::bake_scene(&scene, &BakeSettings::draft(SunRequest::Day(day)), &Silent)?;
//! println!("{} texels on {} pages", bake.manifest.stats.texels, bake.pages.len());
//! bake.write(Path::new("baked"), false)?;
//! # Ok(())
//! # }
//! ```
//!
//! Read a set, and ask one texel how much of the sun it sees at noon of the path:
//!
//! ```no_run
//! use std::path::Path;
//! use sunbake::disk::read::read;
//! use sunbake::maps::soft_visibility;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let set = read(Path::new("baked"))?;
//! let path = set.path.as_ref().ok_or("this set holds no sun")?;
//! let (texel, t) = (0, 0.5);
//! let layers = &set.pages[0].lanes[0].layers;
//! let seen = soft_visibility(layers, texel, set.bits, t as f32, path.width_t(t) as f32);
//! assert!((0.0..=1.0).contains(&seen));
//! # Ok(())
//! # }
//! ```
//!
//! `examples/bake_and_query.rs` asks the exact engine about a spot; `examples/read_set.rs` evaluates every texel.

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
pub mod tracks;
pub mod visibility;
mod warning;
pub mod words;

pub use bake::{Bake, BakeError, BakeReport, Prepared, bake, bake_scene, prepare, sun_path};
pub use error::{ErrorClass, Explain};
pub use remedy::{Remedy, Setting};
pub use warning::{Light, Warning};
