// Four texels evaluated and blended, and then the edge between them drawn where the blended distance in time says.
fn lane_visibility(at: Footprint, layers: vec2<i32>, t: f32, width_t: f32) -> f32 {
    let a = edge_sample(rise_map, fall_map, texel_of(at, 0), layers, t, width_t);
    let b = edge_sample(rise_map, fall_map, texel_of(at, 1), layers, t, width_t);
    let c = edge_sample(rise_map, fall_map, texel_of(at, 2), layers, t, width_t);
    let d = edge_sample(rise_map, fall_map, texel_of(at, 3), layers, t, width_t);
    return sharpened(blended_colors(at, a, b, c, d));
}
