//! sunbake: bakes when every texel of a static scene sees the sun.
//!
//! The method is chapter 13 of *GPU Gems*, "Interactive Visibility with Occlusion Interval Maps" (Donnelly and Demers,
//! 2004). Data flows one way, and the modules read in that order:
//!
//! ```text
//! scene -> atlas -> visibility -> maps -> disk
//!             ^         ^
//!            sun      trace
//! ```

pub mod atlas;
pub mod glb;
pub mod scene;
pub mod sun;
pub mod visibility;
