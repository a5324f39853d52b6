// Four texels evaluated, then blended: filter_bilinear.wgsl, of the lamp's own maps.
fn page_lamp_visibility(page_uv: vec2<f32>) -> f32 {
    let last = vec2<i32>(textureDimensions(lamp_rise_map)) - 1;
    let place = page_uv * vec2<f32>(last + 1) - 0.5;
    let base = floor(place);
    let weight = place - base;
    let low = clamp(vec2<i32>(base), vec2<i32>(0), last);
    let high = clamp(vec2<i32>(base) + 1, vec2<i32>(0), last);
    let top = mix(lamp_soft_visibility(low), lamp_soft_visibility(vec2<i32>(high.x, low.y)), weight.x);
    let bottom = mix(lamp_soft_visibility(vec2<i32>(low.x, high.y)), lamp_soft_visibility(high), weight.x);
    return mix(top, bottom, weight.y);
}
