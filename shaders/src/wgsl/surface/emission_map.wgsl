// Light that the material emits, times a texture.
@group(2) @binding(6) var emissive_texture: texture_2d<f32>;
@group(2) @binding(7) var emissive_sampler: sampler;

fn emitted_light(varyings: Varyings, ray: vec3<f32>, material: Material) -> vec3<f32> {
    let level = texture_level(varyings, ray, varyings.emissive_place.z);
    let texel = textureSampleLevel(emissive_texture, emissive_sampler, varyings.emissive_place.xy, level);
    return material.emissive * texel.rgb;
}
