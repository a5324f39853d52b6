// Four texels evaluated, then blended. Times themselves must never be blended: a texel that is lit in the morning and
// one that is lit in the evening do not make one that is lit at noon.
fn page_visibility(page_uv: vec2<f32>) -> f32 {
    let last = vec2<i32>(textureDimensions(rise_map)) - 1;
    let place = page_uv * vec2<f32>(last + 1) - 0.5;
    let base = floor(place);
    let weight = place - base;
    let low = clamp(vec2<i32>(base), vec2<i32>(0), last);
    let high = clamp(vec2<i32>(base) + 1, vec2<i32>(0), last);
    let top = mix(disc_visibility(low), disc_visibility(vec2<i32>(high.x, low.y)), weight.x);
    let bottom = mix(disc_visibility(vec2<i32>(low.x, high.y)), disc_visibility(high), weight.x);
    return mix(top, bottom, weight.y);
}
