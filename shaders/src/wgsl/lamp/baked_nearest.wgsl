// The texel that holds a page coordinate, unfiltered.
fn page_lamp_visibility(page_uv: vec2<f32>) -> f32 {
    return lamp_texel_visibility(texel_at(page_uv, textureDimensions(lamp_rise_map)));
}
