// No lamp.
fn lamp_shade(at: Surface, to_lamp_m: vec3<f32>, visibility: f32) -> vec3<f32> {
    return vec3<f32>(0.0);
}
