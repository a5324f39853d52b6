// The texel that holds a page coordinate, unfiltered.
fn page_lamp_visibility(page_uv: vec2<f32>) -> f32 {
    let last = vec2<i32>(textureDimensions(lamp_rise_map)) - 1;
    let texel = vec2<i32>(floor(page_uv * vec2<f32>(last + 1)));
    return lamp_soft_visibility(clamp(texel, vec2<i32>(0), last));
}
