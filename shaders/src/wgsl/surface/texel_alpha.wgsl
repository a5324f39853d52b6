// Alpha of the texture at the nearest texel of its first level, wrapped as the material says.
fn texel_alpha(varyings: Varyings, material: Material) -> f32 {
    let size = vec2<i32>(textureDimensions(base_texture));
    let index = vec2<i32>(floor(varyings.image_uv * vec2<f32>(size)));
    let texel = vec2<i32>(wrap_texel(index.x, size.x, material.wrap_u), wrap_texel(index.y, size.y, material.wrap_v));
    return textureLoad(base_texture, texel, 0).a;
}
