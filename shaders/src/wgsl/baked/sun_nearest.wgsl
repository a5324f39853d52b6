// The texel that holds a page coordinate, unfiltered: blocky.
fn page_visibility(page_uv: vec2<f32>) -> f32 {
    return disc_visibility(texel_at(page_uv, textureDimensions(rise_map)));
}
