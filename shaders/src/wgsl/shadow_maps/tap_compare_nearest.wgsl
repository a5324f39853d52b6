// Whether the texel some texels away is lit, by a comparison sampler that does not filter.
@group(3) @binding(2) var shadow_sampler: sampler_comparison;

fn shadow_tap(at: Receiver, offset_texels: vec2<f32>) -> f32 {
    let size = f32(textureDimensions(shadow_depths).x);
    let texel = clamp(floor(at.uv * size + offset_texels), vec2<f32>(0.0), vec2<f32>(size - 1.0));
    let uv = (texel + 0.5) / size;
    return textureSampleCompareLevel(shadow_depths, shadow_sampler, uv, at.map, depth_at(at, uv));
}
