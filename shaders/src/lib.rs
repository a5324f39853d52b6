//! Every WGSL shader of sunbake, with the Rust structs that mirror their uniforms.
//!
//! A shader is a plain concatenation of short files from `wgsl/`, one stage or one question a file. Where a scene does
//! not call for something (a texture, holes, a sun), the file that answers is replaced by one that answers with a
//! constant, so that what is not called for is not in the program at all: see [`SurfaceVariant`] and [`PageVariant`].
//! Numbers that Rust and WGSL share are written once, in Rust, and put before the files as constants.
//!
//! Per scene: one program per variant that occurs in it. Per frame: one [`FrameUniform`].

mod compose;
mod shadow_maps;
mod uniforms;
mod vertex;
mod volumes;

pub use compose::{
    AmbientModel, Filter, LaneVariant, PageVariant, SurfaceVariant, depth_shader, lamp_visibility_shader, lit_shader,
    sky_shader, visibility_shader,
};
pub use shadow_maps::{
    ShadowBias, ShadowFilter, ShadowSource, ShadowTap, ShadowViews, blur_shader, mapped_lit_shader,
    mapped_visibility_shader, shadow_depth_shader, shadow_mask_shader, shadow_probe_shader,
};
pub use uniforms::{
    FrameUniform, LampUniform, MOST_SHADOW_VIEWS, MaterialUniform, ShadowMapsUniform, ShadowViewUniform, SkyUniform,
    WRAP_CLAMP, WRAP_MIRROR, WRAP_REPEAT,
};
pub use vertex::{Attribute, ColorVertex, Format, PositionVertex, Stream, SurfaceVertex, TextureVertex, attributes};
pub use volumes::{
    HardLight, VolumeCorners, VolumeLight, VolumeUse, background_shader, hard_light_shader, screen_shader,
    volume_shader,
};

/// How an engine of one's own evaluates a map, in WGSL.
pub const ENGINE_WGSL: &str = include_str!("engine/soft_visibility.wgsl");
/// How an engine of one's own evaluates a map, in GLSL.
pub const ENGINE_GLSL: &str = include_str!("engine/soft_visibility.glsl");
