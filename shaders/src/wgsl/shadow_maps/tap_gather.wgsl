// How much of the four texels around a place is lit, each compared with the receiver's plane where it lies. A sampler
// compares all four with one depth, which takes a bias as large as the plane's rise over a texel; this takes none.
@group(3) @binding(2) var shadow_sampler: sampler;

fn shadow_tap(at: Receiver, offset_texels: vec2<f32>) -> f32 {
    let size = f32(textureDimensions(shadow_depths).x);
    let place = clamp(at.uv * size + offset_texels - 0.5, vec2<f32>(0.0), vec2<f32>(size - 1.0));
    let first = min(floor(place), vec2<f32>(size - 2.0));
    let weight = place - first;
    // Between the four, no rounding of a sampler's can choose others.
    let stored = textureGather(shadow_depths, shadow_sampler, (first + 1.0) / size, at.map);
    let step = at.depth_per_uv / size;
    let base = at.depth + dot(at.depth_per_uv, (first + 0.5) / size - at.uv);
    let depths = clamp(base + vec4<f32>(step.y, step.x + step.y, step.x, 0.0), vec4<f32>(LEAST_DEPTH), vec4<f32>(1.0));
    let lit = select(vec4<f32>(0.0), vec4<f32>(1.0), depths <= stored);
    return mix(mix(lit.w, lit.z, weight.x), mix(lit.x, lit.y, weight.x), weight.y);
}
