// A page without a lamp.
fn lamp_shade(material: Material, base_color: vec3<f32>, normal: vec3<f32>, way_m: vec3<f32>, seen: f32) -> vec3<f32> {
    return vec3<f32>(0.0);
}
