// Share of the lamp that a texel sees.
fn lamp_texel_visibility(texel: vec2<i32>) -> f32 {
    let layers = vec2<i32>(0, i32(textureNumLayers(lamp_rise_map)));
    return soft_visibility(lamp_rise_map, lamp_fall_map, texel, layers, lamp.t, lamp.width_t);
}
