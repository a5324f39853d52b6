// The material's base colour texture.
@group(2) @binding(0) var base_texture: texture_2d<f32>;
@group(2) @binding(1) var base_sampler: sampler;

fn texture_color(varyings: Varyings, ray: vec3<f32>) -> vec4<f32> {
    let level = texture_level(varyings, ray, varyings.texels_per_metre);
    return textureSampleLevel(base_texture, base_sampler, varyings.image_uv, level);
}
