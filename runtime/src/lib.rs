//! Plays sunbake maps back, beside live shadow volumes and a ray-traced truth.
//!
//! A [`Stage`] is a baked set with its scene, or a scene alone, ready to be looked at. A [`Shot`] is the stage through
//! a camera, a [`Moment`] is where the sun stands and what light that makes. A [`technique::Technique`] answers, for a
//! shot at a moment, how much of the sun each pixel's surface sees; all answer with the same kind of image, so all are
//! compared alike. A [`DrawPlan`] says what that calls for, and why. The modules read in that order:
//!
//! ```text
//! stage -> camera -> light -> technique (baked on the GPU | on the CPU | volumes | truth) -> shade -> image
//!                                        gpu                playback     volumes            compare
//! ```

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
