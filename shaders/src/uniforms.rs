//! Structs that both Rust and WGSL know; tests compare every offset with what naga lays out.

use bytemuck::{Pod, Zeroable};

/// [`MaterialUniform::wrap_u`]: tile.
pub const WRAP_REPEAT: u32 = 0;
/// Tile, every second one mirrored.
pub const WRAP_MIRROR: u32 = 1;
/// The border's texel goes on for ever.
pub const WRAP_CLAMP: u32 = 2;

/// What every stage knows about the frame. `Frame` in `frame.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct FrameUniform {
    /// Columns of the matrix from eye space (bake's axes, the camera at the origin) to clip space.
    pub clip_from_eye: [[f32; 4]; 4],
    /// The camera in bake space.
    pub eye_m: [f32; 3],
    /// Angle between neighbouring pixels at the picture's centre.
    pub pixel_angle_rad: f32,
    /// Ray through the upper left corner of the picture, one deep.
    pub ray_first: [f32; 3],
    /// Path time.
    pub t: f32,
    /// What a step of one pixel to the right adds to the ray.
    pub ray_per_column: [f32; 3],
    /// The sun's width in path time.
    pub width_t: f32,
    /// What a step of one pixel down adds to the ray.
    pub ray_per_row: [f32; 3],
    /// Cosine of the sun's angular radius; above 1 where there is no disc to draw.
    pub sun_cos_radius: f32,
    /// Unit vector towards the sun.
    pub sun_direction: [f32; 3],
    /// One over the sun's angular diameter; very large for a point.
    pub discs_per_radian: f32,
    /// The sun on a surface that faces it.
    pub sun_light: [f32; 3],
    #[doc(hidden)]
    pub pad_0: f32,
    /// The sky on a surface that looks up.
    pub sky_light: [f32; 3],
    #[doc(hidden)]
    pub pad_1: f32,
    /// The ground on a surface that looks down.
    pub ground_light: [f32; 3],
    #[doc(hidden)]
    pub pad_2: f32,
    /// The sky's colour overhead.
    pub zenith: [f32; 3],
    #[doc(hidden)]
    pub pad_3: f32,
    /// The sky's colour at the horizon.
    pub horizon: [f32; 3],
    #[doc(hidden)]
    pub pad_4: f32,
    /// What the sky has more of around the sun.
    pub glow: [f32; 3],
    #[doc(hidden)]
    pub pad_5: f32,
    /// What is seen below the horizon where there is no ground.
    pub haze: [f32; 3],
    #[doc(hidden)]
    pub pad_6: f32,
}

/// A lamp in the scene. `Lamp` in `lamp.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct LampUniform {
    /// Where it is, bake space.
    pub position_m: [f32; 3],
    /// The middle of its window, path time.
    pub t: f32,
    /// Its light on a surface that faces it from a metre away.
    pub light: [f32; 3],
    /// Length of its window, path time.
    pub width_t: f32,
    /// Its radius.
    pub radius_m: f32,
    /// One over its diameter; very large for a point.
    pub balls_per_metre: f32,
    /// How far its light goes; very large where it goes on for ever.
    pub range_m: f32,
    #[doc(hidden)]
    pub pad: f32,
}

/// The sky at a moment, in spherical harmonics. `Sky` in `ambient_sky.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct SkyUniform {
    /// Red, green and blue of each coefficient, in the order of [`AmbientModel::Sky`](crate::AmbientModel::Sky)'s maps.
    pub coefficients: [[f32; 4]; 9],
}

/// Most shadow maps of a view.
pub const MOST_SHADOW_VIEWS: usize = 6;

/// A shadow map's matrix. `ShadowView` in `shadow_view.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct ShadowViewUniform {
    /// Columns of the matrix from a point less the origin to the map's clip space; depth is 0 nearest to the sun.
    pub clip_from_point: [[f32; 4]; 4],
    /// The origin, bake space.
    pub origin_m: [f32; 3],
    /// What a metre towards the sun adds to z; negative.
    pub z_per_metre: f32,
    /// The eye less the origin.
    pub eye_from_origin_m: [f32; 3],
    /// Height of the ground, bake space.
    pub ground_height_m: f32,
}

/// A view's shadow maps. `ShadowMaps` in `shadow_maps.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct ShadowMapsUniform {
    /// Their matrices.
    pub views: [ShadowViewUniform; MOST_SHADOW_VIEWS],
    /// How many there are.
    pub count: u32,
    #[doc(hidden)]
    pub pad: [u32; 3],
}

/// A material. `Material` in `frame.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct MaterialUniform {
    /// Linear RGB and alpha.
    pub base_color: [f32; 4],
    /// Linear RGB.
    pub emissive: [f32; 3],
    /// 1 where the base colour is drawn as it is.
    pub is_unlit: f32,
    /// Alpha below which there is a hole.
    pub cutoff: f32,
    /// How the texture goes on to the left and right.
    pub wrap_u: u32,
    /// How the texture goes on above and below.
    pub wrap_v: u32,
    #[doc(hidden)]
    pub pad: f32,
}
