// Share of a light of some width that a texel sees at t, from the stored times of the sun or the lamp. Twin of
// bake/src/maps/evaluate.rs: same names, same order.
fn soft_visibility(
    rises: texture_2d_array<u32>,
    falls: texture_2d_array<u32>,
    texel: vec2<i32>,
    layers: vec2<i32>,
    t: f32,
    width_t: f32,
) -> f32 {
    let width_codes = max(width_t * MAX_CODE, 1.0);
    let window_start = t * MAX_CODE - 0.5 * width_codes;
    let window_end = t * MAX_CODE + 0.5 * width_codes;
    var lit_codes = 0.0;
    for (var layer = layers.x; layer < layers.y; layer++) {
        let rise = max(vec4<f32>(textureLoad(rises, texel, layer, 0)), vec4<f32>(window_start));
        let fall = min(vec4<f32>(textureLoad(falls, texel, layer, 0)), vec4<f32>(window_end));
        lit_codes += dot(max(fall - rise, vec4<f32>(0.0)), vec4<f32>(1.0));
    }
    return min(lit_codes / width_codes, 1.0);
}
