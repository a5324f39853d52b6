// Sky and ground by the bent normal, times the visible share of the sky. A bent normal is the mean visible direction:
// in the open its length is 2/3. So 3/4 of its height takes the place of half of the normal's, and in the open both
// give the same.
@group(1) @binding(5) var bent_map: texture_2d_array<u32>;

fn bent_at(texel: vec2<i32>, side: i32) -> f32 {
    return (f32(textureLoad(bent_map, texel, side, 0).y) - 32768.0) / 32767.0;
}

fn bent_height(page_uv: vec2<f32>, side: i32) -> f32 {
    let at = footprint(page_uv, textureDimensions(bent_map));
    let top = vec2<f32>(bent_at(texel_of(at, 0), side), bent_at(texel_of(at, 1), side));
    let bottom = vec2<f32>(bent_at(texel_of(at, 2), side), bent_at(texel_of(at, 3), side));
    return blended(at, vec4<f32>(top, bottom));
}

fn ambient_light(page_uv: vec2<f32>, normal: vec3<f32>, side: i32) -> vec3<f32> {
    let share = clamp(0.5 + 0.75 * bent_height(page_uv, side), 0.0, 1.0);
    return mix(frame.ground_light, frame.sky_light, share) * ambient_visibility(page_uv, side);
}
