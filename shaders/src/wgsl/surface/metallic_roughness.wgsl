// Metal and roughness of the material alone.
fn metallic_roughness(varyings: Varyings, ray: vec3<f32>, material: Material) -> vec2<f32> {
    return vec2<f32>(material.metallic, material.roughness);
}
