// Evaluating a sunbake map, for any engine that takes GLSL 1.30 or later. `rise_map` and `fall_map` hold one array layer
// per pair of the manifest's `layers`; `max_code` is 255 or 65535; `t` and `width_t` are path time and the sun's width
// in it. Call it for the four texels around a coordinate and blend the results: never blend the stored times.
uniform usampler2DArray rise_map;
uniform usampler2DArray fall_map;

float soft_visibility(ivec2 texel, float max_code, float t, float width_t) {
    float width_codes = max(width_t * max_code, 1.0);
    float window_start = t * max_code - 0.5 * width_codes;
    float lit_codes = 0.0;
    for (int layer = 0; layer < textureSize(rise_map, 0).z; layer++) {
        vec4 rise = max(vec4(texelFetch(rise_map, ivec3(texel, layer), 0)), vec4(window_start));
        vec4 fall = min(vec4(texelFetch(fall_map, ivec3(texel, layer), 0)), vec4(window_start + width_codes));
        lit_codes += dot(max(fall - rise, vec4(0.0)), vec4(1.0));
    }
    return min(lit_codes / width_codes, 1.0);
}
