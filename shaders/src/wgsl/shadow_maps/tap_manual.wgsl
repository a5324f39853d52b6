// Whether the texel some texels away is lit.
fn shadow_tap(at: Receiver, offset_texels: vec2<f32>) -> f32 {
    let size = f32(textureDimensions(shadow_depths).x);
    let texel = clamp(floor(at.uv * size + offset_texels), vec2<f32>(0.0), vec2<f32>(size - 1.0));
    let stored = textureLoad(shadow_depths, vec2<i32>(texel), at.map, 0);
    return select(0.0, 1.0, depth_at(at, (texel + 0.5) / size) <= stored);
}
