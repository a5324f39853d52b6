// Colour from the mesh.
fn vertex_color(varyings: Varyings) -> vec4<f32> {
    return varyings.color;
}
