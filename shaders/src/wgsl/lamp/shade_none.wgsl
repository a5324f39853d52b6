// No lamp.
fn lamp_shade(
    material: Material,
    base_color: vec3<f32>,
    normal: vec3<f32>,
    to_lamp_m: vec3<f32>,
    visibility: f32,
) -> vec3<f32> {
    return vec3<f32>(0.0);
}
