// Whether a texel sees a sun without width at t. Twin of bake/src/maps/evaluate.rs: same names, same order.

@group(1) @binding(0) var rise_map: texture_2d_array<u32>;
@group(1) @binding(1) var fall_map: texture_2d_array<u32>;

fn hard_visibility(texel: vec2<i32>, layers: vec2<i32>, t: f32) -> f32 {
    let now = vec4<f32>(t * MAX_CODE);
    for (var layer = layers.x; layer < layers.y; layer++) {
        let rise = vec4<f32>(textureLoad(rise_map, texel, layer, 0));
        let fall = vec4<f32>(textureLoad(fall_map, texel, layer, 0));
        if any((rise <= now) & (now <= fall)) {
            return 1.0;
        }
    }
    return 0.0;
}
