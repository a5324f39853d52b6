// Evaluating a sunbake map, for any engine that takes WGSL. `rise_map` and `fall_map` hold one array layer per pair of
// the manifest's `layers`; `max_code` is 255 or 65535; `t` and `width_t` are path time and the sun's width in it.
// Call it for the four texels around a coordinate and blend the results: never blend the stored times.
@group(0) @binding(0) var rise_map: texture_2d_array<u32>;
@group(0) @binding(1) var fall_map: texture_2d_array<u32>;

fn soft_visibility(texel: vec2<i32>, max_code: f32, t: f32, width_t: f32) -> f32 {
    let width_codes = max(width_t * max_code, 1.0);
    let window_start = t * max_code - 0.5 * width_codes;
    var lit_codes = 0.0;
    for (var layer = 0; layer < i32(textureNumLayers(rise_map)); layer++) {
        let rise = max(vec4<f32>(textureLoad(rise_map, texel, layer, 0)), vec4<f32>(window_start));
        let fall = min(vec4<f32>(textureLoad(fall_map, texel, layer, 0)), vec4<f32>(window_start + width_codes));
        lit_codes += dot(max(fall - rise, vec4<f32>(0.0)), vec4<f32>(1.0));
    }
    return min(lit_codes / width_codes, 1.0);
}
