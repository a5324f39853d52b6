// The texel that holds a page coordinate, unfiltered: the look of the chapter.
fn page_visibility(page_uv: vec2<f32>) -> f32 {
    let last = vec2<i32>(textureDimensions(rise_map)) - 1;
    let texel = vec2<i32>(floor(page_uv * vec2<f32>(last + 1)));
    return disc_visibility(clamp(texel, vec2<i32>(0), last));
}
