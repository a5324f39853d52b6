// A mesh without colours.
fn vertex_color(varyings: Varyings) -> vec4<f32> {
    return vec4<f32>(1.0);
}
