// Four texels evaluated, then blended.
fn page_lamp_visibility(page_uv: vec2<f32>) -> f32 {
    let at = footprint(page_uv, textureDimensions(lamp_rise_map));
    let top = vec2<f32>(lamp_texel_visibility(texel_of(at, 0)), lamp_texel_visibility(texel_of(at, 1)));
    let bottom = vec2<f32>(lamp_texel_visibility(texel_of(at, 2)), lamp_texel_visibility(texel_of(at, 3)));
    return blended(at, vec4<f32>(top, bottom));
}
