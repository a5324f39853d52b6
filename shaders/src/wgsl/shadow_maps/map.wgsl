// A shadow map's matrix, about an origin of its own: see runtime/src/shadow_maps/projection.rs.
struct ShadowMap {
    clip_from_point: mat4x4<f32>,
    origin_m: vec3<f32>,
    z_per_metre: f32,
    eye_from_origin_m: vec3<f32>,
    ground_height_m: f32,
}
