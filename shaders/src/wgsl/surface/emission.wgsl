// Light that the material emits everywhere.
fn emitted_light(varyings: Varyings, ray: vec3<f32>, material: Material) -> vec3<f32> {
    return material.emissive;
}
