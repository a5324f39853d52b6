// How much of the four texels around a place is lit, as the sampler filters them.
@group(3) @binding(2) var shadow_sampler: sampler_comparison;

fn shadow_tap(at: Receiver, offset_texels: vec2<f32>) -> f32 {
    let uv = at.uv + offset_texels / f32(textureDimensions(shadow_depths).x);
    return textureSampleCompareLevel(shadow_depths, shadow_sampler, uv, at.map, depth_at(at, uv));
}
