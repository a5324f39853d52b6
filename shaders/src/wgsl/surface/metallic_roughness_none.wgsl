// A surface that only scatters light.
fn metallic_roughness(varyings: Varyings, ray: vec3<f32>, material: Material) -> vec2<f32> {
    return vec2<f32>(0.0, 1.0);
}
