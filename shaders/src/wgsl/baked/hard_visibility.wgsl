// Whether a texel sees a sun without width at t. Twin of bake/src/maps/evaluate.rs: same names, same order.
fn hard_visibility(
    rises: texture_2d_array<u32>,
    falls: texture_2d_array<u32>,
    texel: vec2<i32>,
    layers: vec2<i32>,
    t: f32,
) -> f32 {
    let now = vec4<f32>(t * MAX_CODE);
    for (var layer = layers.x; layer < layers.y; layer++) {
        let rise = vec4<f32>(textureLoad(rises, texel, layer, 0));
        let fall = vec4<f32>(textureLoad(falls, texel, layer, 0));
        if any((rise <= now) & (now <= fall)) {
            return 1.0;
        }
    }
    return 0.0;
}
