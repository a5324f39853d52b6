// Metal and roughness of the material, times a texture: roughness in green, metal in blue.
@group(2) @binding(2) var metal_texture: texture_2d<f32>;
@group(2) @binding(3) var metal_sampler: sampler;

fn metallic_roughness(varyings: Varyings, ray: vec3<f32>, material: Material) -> vec2<f32> {
    let level = texture_level(varyings, ray, varyings.metal_place.z);
    let texel = textureSampleLevel(metal_texture, metal_sampler, varyings.metal_place.xy, level);
    return vec2<f32>(material.metallic, material.roughness) * texel.bg;
}
