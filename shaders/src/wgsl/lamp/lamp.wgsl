// Uniforms of a lamp.
struct Lamp {
    position_m: vec3<f32>,
    t: f32,
    light: vec3<f32>,
    width_t: f32,
    radius_m: f32,
    inverse_diameter_per_m: f32,
    range_m: f32,
}

@group(0) @binding(2) var<uniform> lamp: Lamp;
