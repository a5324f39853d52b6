// Share of the lamp that a texel sees: soft_visibility.wgsl, of the lamp's own maps.
@group(1) @binding(3) var lamp_rise_map: texture_2d_array<u32>;
@group(1) @binding(4) var lamp_fall_map: texture_2d_array<u32>;

fn lamp_soft_visibility(texel: vec2<i32>) -> f32 {
    let width_codes = max(lamp.width_t * MAX_CODE, 1.0);
    let window_start = lamp.t * MAX_CODE - 0.5 * width_codes;
    let window_end = lamp.t * MAX_CODE + 0.5 * width_codes;
    var lit_codes = 0.0;
    for (var layer = 0; layer < i32(textureNumLayers(lamp_rise_map)); layer++) {
        let rise = max(vec4<f32>(textureLoad(lamp_rise_map, texel, layer, 0)), vec4<f32>(window_start));
        let fall = min(vec4<f32>(textureLoad(lamp_fall_map, texel, layer, 0)), vec4<f32>(window_end));
        lit_codes += dot(max(fall - rise, vec4<f32>(0.0)), vec4<f32>(1.0));
    }
    return min(lit_codes / width_codes, 1.0);
}
