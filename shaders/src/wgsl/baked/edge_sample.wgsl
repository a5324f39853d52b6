// What the sharp filter blends of a texel: the share of the light that it sees, its signed distance in time from the
// nearest edge in widths of the light, counted from the deepest shade, and the share that this distance alone would
// mean. Twin of bake/src/maps/evaluate.rs, where it is explained: same names, same order.

fn edge_sample(
    rises: texture_2d_array<u32>,
    falls: texture_2d_array<u32>,
    texel: vec2<i32>,
    layers: vec2<i32>,
    t: f32,
    width_t: f32,
) -> vec3<f32> {
    let width_codes = max(width_t * MAX_CODE, 1.0);
    let now = t * MAX_CODE;
    let window_start = now - 0.5 * width_codes;
    let window_end = now + 0.5 * width_codes;
    let reach = SHARP_REACH * width_codes;
    var lit_codes = 0.0;
    var distance = -reach;
    for (var layer = layers.x; layer < layers.y; layer++) {
        let rise = vec4<f32>(textureLoad(rises, texel, layer, 0));
        let fall = vec4<f32>(textureLoad(falls, texel, layer, 0));
        let lit = min(fall, vec4<f32>(window_end)) - max(rise, vec4<f32>(window_start));
        lit_codes += dot(max(lit, vec4<f32>(0.0)), vec4<f32>(1.0));
        let after_rise = select(now - rise, vec4<f32>(reach), rise == vec4<f32>(0.0));
        let before_fall = select(fall - now, vec4<f32>(reach), fall == vec4<f32>(MAX_CODE));
        let inside = min(after_rise, before_fall);
        distance = max(distance, max(max(inside.x, inside.y), max(inside.z, inside.w)));
    }
    return edge_sample_of(min(lit_codes / width_codes, 1.0), min(distance, reach) / width_codes);
}
