//! Plays sunbake maps back, beside live shadow volumes, shadow maps and a ray-traced truth.
//!
//! A [`Stage`] is a baked set with its scene, or a scene alone. A [`Shot`] is the stage through a camera, a
//! [`Moment`] is where the sun stands and what light that makes. A [`technique::Technique`] answers, for a shot at a
//! moment, how much of the sun each pixel's surface sees; all answer with the same kind of image, so that all are
//! compared alike. A [`DrawPlan`] says what a picture calls for, and why. The modules read in that order:
//!
//! ```text
//! stage -> camera -> light -> technique (baked on GPU or CPU | volumes | shadow maps | truth) -> shade -> image
//!                                        gpu                playback                                       compare
//! ```
//!
//! # A tour
//!
//! Pictures on the CPU, which need no GPU. `baked` is what `sunbake bake` wrote:
//!
//! ```no_run
//! use std::path::Path;
//! use sunbake_runtime::technique::{BakedCpu, Technique};
//! use sunbake_runtime::{Camera, Filter, Shot, Stage, View};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let stage = Stage::read(Path::new("baked"))?;
//! let size = [640, 360];
//! let camera = Camera::default_of(&stage, 640.0 / 360.0);
//! let shot = Shot::new(&stage, View::new(&camera, size, &stage.scene));
//! // Path time runs from 0 at sunrise to 1 at sunset.
//! let moment = stage.moment(0.5);
//! let visibility = BakedCpu::new(&stage, Filter::Bilinear).visibility(&shot, &moment)?;
//! assert_eq!(visibility.pixels.len(), 640 * 360);
//! # Ok(())
//! # }
//! ```
//!
//! Frames of your own renderer, with your device, encoder and texture:
//!
//! ```no_run
//! use sunbake_runtime::gpu::{BakedRenderer, Gpu, Output, PictureTarget};
//! use sunbake_runtime::{Filter, Stage, View, wgpu};
//!
//! # fn draw(
//! #     device: wgpu::Device, queue: wgpu::Queue, stage: &Stage, view: &View, frame: &wgpu::TextureView,
//! # ) -> Result<(), Box<dyn std::error::Error>> {
//! // Once. Ask for `Gpu::WANTED_FEATURES` when you request the device, as far as the adapter has them.
//! let gpu = Gpu::from_device(device, queue);
//! let mut renderer = BakedRenderer::new(&gpu, stage, Filter::Bilinear)?;
//! // Per frame.
//! let mut encoder = gpu.device.create_command_encoder(&Default::default());
//! let target = PictureTarget { view: frame, format: wgpu::TextureFormat::Bgra8UnormSrgb };
//! renderer.draw_into(&mut encoder, target, Output::Lit, view, &stage.moment(0.5))?;
//! gpu.queue.submit([encoder.finish()]);
//! # Ok(())
//! # }
//! ```
//!
//! `examples/own_device.rs` is the whole of it: it bakes a box in memory, draws it and writes a PNG.

pub mod camera;
#[cfg(feature = "report")]
pub mod compare;
pub mod drawn_sides;
mod error;
pub mod gpu;
pub mod image;
pub mod light;
pub mod plan;
pub mod playback;
pub mod shade;
pub mod shadow_maps;
pub mod sheet;
pub mod shot;
pub mod stage;
pub mod technique;
#[cfg(any(test, feature = "testing"))]
#[doc(hidden)]
pub mod testing;
pub mod texture;
pub mod volumes;

pub use camera::{Camera, View};
pub use image::Raster;
pub use light::Moment;
pub use plan::DrawPlan;
pub use shot::Shot;
pub use stage::Stage;
pub use sunbake_shaders::{AmbientModel, Filter};
pub use {glam, wgpu};
