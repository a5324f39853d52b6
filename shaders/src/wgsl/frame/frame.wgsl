// Uniforms of the frame, and the materials of the scene.
//
// Spaces: "bake" is the world with the scene's centre as its origin; "eye" has the same axes and the camera as its
// origin.

struct Frame {
    clip_from_eye: mat4x4<f32>,
    eye_m: vec3<f32>,
    pixel_angle_rad: f32,
    ray_first: vec3<f32>,
    t: f32,
    ray_per_column: vec3<f32>,
    width_t: f32,
    ray_per_row: vec3<f32>,
    sun_cos_radius: f32,
    sun_direction: vec3<f32>,
    inverse_angular_diameter: f32,
    sun_light: vec3<f32>,
    sky_light: vec3<f32>,
    ground_light: vec3<f32>,
    zenith: vec3<f32>,
    horizon: vec3<f32>,
    glow: vec3<f32>,
    haze: vec3<f32>,
}

struct Material {
    base_color: vec4<f32>,
    emissive: vec3<f32>,
    is_unlit: f32,
    cutoff: f32,
    wrap_u: u32,
    wrap_v: u32,
    metallic: f32,
    roughness: f32,
    normal_scale: f32,
    transmission: f32,
}

@group(0) @binding(0) var<uniform> frame: Frame;
@group(0) @binding(1) var<storage, read> materials: array<Material>;

// The ray through a pixel's centre. Its component along the camera's axis is 1, so that depth times ray is the surface.
fn view_ray(pixel: vec2<f32>) -> vec3<f32> {
    return frame.ray_first + frame.ray_per_column * pixel.x + frame.ray_per_row * pixel.y;
}
