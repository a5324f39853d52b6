// A material without a texture.
fn texture_color(varyings: Varyings, ray: vec3<f32>) -> vec4<f32> {
    return vec4<f32>(1.0);
}
