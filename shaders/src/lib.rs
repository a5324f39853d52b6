//! Every WGSL shader of sunbake, with the Rust structs that mirror its uniforms.
//!
//! A shader is a plain concatenation of short files from `wgsl/`, with one stage or one question per file, in a
//! folder per technique. Where a scene does not call for something (a texture, an alpha mask, a sun), the file that
//! answers is replaced by one that answers with a constant, so that unused code is not in the program at all: see
//! [`SurfaceVariant`] and [`PageVariant`]. Numbers that Rust and WGSL share are written once, in Rust, and emitted as
//! constants.
//!
//! Bind groups: 0 holds [`FrameUniform`], materials, [`LampUniform`] and [`SkyUniform`]; 1 the maps of an atlas page,
//! or the points of shadow volumes, or the matrix of a shadow map that is drawn; 2 a surface's textures; 3 shadow maps
//! that are read.
//!
//! ```
//! use sunbake_shaders::{Filter, LaneVariant, PageVariant, SurfaceVariant, attributes, lit_shader};
//!
//! // A page with one lane of two layers: up to eight intervals per texel, stored in 16 bits.
//! let page = PageVariant {
//!     max_code: 65_535,
//!     lanes: vec![LaneVariant { layer_count: 2, weight: 1.0, chord: 1.0 }],
//!     ..PageVariant::default()
//! };
//! let surface = SurfaceVariant { is_textured: true, ..SurfaceVariant::default() };
//! let wgsl = lit_shader(surface, &page, Filter::Bilinear);
//! assert!(wgsl.contains("fn surface_vertex") && wgsl.contains("fn lit_fragment"));
//! // The vertex buffers that it reads, attribute by attribute.
//! assert!(attributes(surface).iter().any(|attribute| attribute.name == "image_uv"));
//!
//! // Without times of the sun there is no code that reads them.
//! let dark = lit_shader(surface, &PageVariant::default(), Filter::Bilinear);
//! assert!(wgsl.contains("rise_map") && !dark.contains("rise_map"));
//! ```

mod compose;
mod shadow_maps;
mod uniforms;
mod vertex;
mod volumes;

pub use compose::{
    AmbientModel, Filter, LaneVariant, LookVariant, PageVariant, SurfaceVariant, depth_shader, lamp_visibility_shader,
    lit_shader, open_lit_shader, sky_shader, visibility_shader,
};
pub use shadow_maps::{
    ShadowBias, ShadowFilter, ShadowMapChoice, ShadowSource, ShadowTap, blur_shader, mapped_lit_shader,
    mapped_visibility_shader, shadow_depth_shader, shadow_mask_shader, shadow_probe_shader,
};
pub use uniforms::{
    FrameUniform, LampUniform, MOST_SHADOW_MAPS, MaterialUniform, ShadowMapUniform, ShadowMapsUniform, SkyUniform,
    WRAP_CLAMP, WRAP_MIRROR, WRAP_REPEAT,
};
pub use vertex::{
    Attribute, ColorVertex, Format, LiftVertex, NormalVertex, PositionVertex, Stream, SurfaceVertex, TextureVertex,
    attributes,
};
pub use volumes::{
    HardLight, VolumeCorners, VolumeLight, VolumeUse, background_shader, hard_light_shader, screen_shader,
    volume_shader,
};

/// How to evaluate a map in another engine, in WGSL.
pub const ENGINE_WGSL: &str = include_str!("engine/soft_visibility.wgsl");
/// How to evaluate a map in another engine, in GLSL.
pub const ENGINE_GLSL: &str = include_str!("engine/soft_visibility.glsl");
