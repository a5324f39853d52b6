// The front's shading normal, between those of the corners.
fn shading_normal(varyings: Varyings, ray: vec3<f32>, material: Material) -> vec3<f32> {
    return normalize(varyings.shading_normal.xyz);
}
