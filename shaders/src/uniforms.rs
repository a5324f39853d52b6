//! Structs that Rust and WGSL share. Tests compare every offset with the layout in WGSL.

use bytemuck::{Pod, Zeroable};

/// [`MaterialUniform::wrap_u`]: tile.
pub const WRAP_REPEAT: u32 = 0;
/// Tile, and mirror every second tile.
pub const WRAP_MIRROR: u32 = 1;
/// The texel at the border is repeated.
pub const WRAP_CLAMP: u32 = 2;

/// Uniforms of a frame. `Frame` in `frame/frame.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct FrameUniform {
    /// Columns of the matrix from eye space (bake's axes, the camera at the origin) to clip space.
    pub clip_from_eye: [[f32; 4]; 4],
    /// The camera in bake space, metres.
    pub eye_m: [f32; 3],
    /// Angle between neighbouring pixels at the picture's centre, radians.
    pub pixel_angle_rad: f32,
    /// Ray through the upper left corner of the picture; its component along the camera's axis is 1.
    pub ray_first: [f32; 3],
    /// Path time, from 0 to 1.
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
    pub inverse_angular_diameter: f32,
    /// Irradiance of the sun on a surface that faces it, linear RGB; 1 is white on a white surface.
    pub sun_light: [f32; 3],
    #[doc(hidden)]
    pub pad_0: f32,
    /// The same of the sky on a surface that faces up.
    pub sky_light: [f32; 3],
    #[doc(hidden)]
    pub pad_1: f32,
    /// The same of the ground on a surface that faces down.
    pub ground_light: [f32; 3],
    #[doc(hidden)]
    pub pad_2: f32,
    /// Radiance of the sky overhead, linear RGB.
    pub zenith: [f32; 3],
    #[doc(hidden)]
    pub pad_3: f32,
    /// Radiance of the sky at the horizon.
    pub horizon: [f32; 3],
    #[doc(hidden)]
    pub pad_4: f32,
    /// Radiance that is added around the sun.
    pub glow: [f32; 3],
    #[doc(hidden)]
    pub pad_5: f32,
    /// Radiance below the horizon.
    pub haze: [f32; 3],
    #[doc(hidden)]
    pub pad_6: f32,
}

/// A lamp in the scene. `Lamp` in `lamp/lamp.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct LampUniform {
    /// Its centre in bake space, metres.
    pub position_m: [f32; 3],
    /// The middle of its window, as path time from 0 to 1.
    pub t: f32,
    /// Irradiance on a surface that faces it from one metre away, linear RGB.
    pub light: [f32; 3],
    /// Length of its window, as path time.
    pub width_t: f32,
    /// Its radius, metres.
    pub radius_m: f32,
    /// One over its diameter; very large for a point.
    pub inverse_diameter_per_m: f32,
    /// Its range, metres; very large where it has none.
    pub range_m: f32,
    #[doc(hidden)]
    pub pad: f32,
}

/// The sky at a moment, in spherical harmonics. `Sky` in `ambient/sky.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct SkyUniform {
    /// Red, green and blue of each coefficient, in the order of [`AmbientModel::Sky`](crate::AmbientModel::Sky)'s maps.
    pub coefficients: [[f32; 4]; 9],
}

/// Most shadow maps of a view.
pub const MOST_SHADOW_MAPS: usize = 6;

/// A shadow map's matrix. `ShadowMap` in `shadow_maps/map.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct ShadowMapUniform {
    /// Columns of the matrix from a point, relative to the origin, to the map's clip space. Depth is 0 nearest to the
    /// sun.
    pub clip_from_point: [[f32; 4]; 4],
    /// The origin in bake space, metres.
    pub origin_m: [f32; 3],
    /// What one metre towards the sun adds to z; negative.
    pub z_per_metre: f32,
    /// The eye relative to the origin, metres.
    pub eye_from_origin_m: [f32; 3],
    /// Height of the ground in bake space, metres.
    pub ground_height_m: f32,
}

/// A view's shadow maps. `ShadowMaps` in `shadow_maps/maps.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct ShadowMapsUniform {
    /// Matrix and origin of each map; those from `count` on are not read.
    pub maps: [ShadowMapUniform; MOST_SHADOW_MAPS],
    /// How many there are.
    pub count: u32,
    #[doc(hidden)]
    pub pad: [u32; 3],
}

/// A material. `Material` in `frame/frame.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct MaterialUniform {
    /// Linear RGB and alpha.
    pub base_color: [f32; 4],
    /// Linear RGB.
    pub emissive: [f32; 3],
    /// 1 where the base colour is shown without lighting, else 0.
    pub is_unlit: f32,
    /// Alpha below which the mask hides the surface; 0 without a mask.
    pub cutoff: f32,
    /// How the texture repeats along u.
    pub wrap_u: u32,
    /// How the texture repeats along v.
    pub wrap_v: u32,
    /// Metal, 0 to 1; multiplied with the texture's blue.
    pub metallic: f32,
    /// Roughness, 0 to 1; multiplied with the texture's green.
    pub roughness: f32,
    /// Scale of the normal map's x and y.
    pub normal_scale: f32,
    /// Share of the light behind that is let through, 0 to 1; only of blended surfaces.
    pub transmission: f32,
    #[doc(hidden)]
    pub pad: f32,
}
