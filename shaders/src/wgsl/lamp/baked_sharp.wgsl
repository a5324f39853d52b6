// Four texels evaluated and blended, and then the edge between them drawn where the blended distance in time says.
fn page_lamp_visibility(page_uv: vec2<f32>) -> f32 {
    let at = footprint(page_uv, textureDimensions(lamp_rise_map));
    let a = lamp_edge_sample(texel_of(at, 0));
    let b = lamp_edge_sample(texel_of(at, 1));
    let c = lamp_edge_sample(texel_of(at, 2));
    let d = lamp_edge_sample(texel_of(at, 3));
    return sharpened(blended_colors(at, a, b, c, d));
}

fn lamp_edge_sample(texel: vec2<i32>) -> vec3<f32> {
    let layers = vec2<i32>(0, i32(textureNumLayers(lamp_rise_map)));
    return edge_sample(lamp_rise_map, lamp_fall_map, texel, layers, lamp.t, lamp.width_t);
}
