// The hemisphere's light from where it is free. A bent normal is as long as its directions agree, 2/3 of a unit in the
// open, so that 3/4 of its height stands where half of the normal's does: in the open both say the same.
@group(1) @binding(5) var bent_map: texture_2d_array<u32>;

fn bent_at(texel: vec2<i32>, side: i32) -> f32 {
    return (f32(textureLoad(bent_map, texel, side, 0).y) - 32768.0) / 32767.0;
}

fn bent_height(page_uv: vec2<f32>, side: i32) -> f32 {
    let last = vec2<i32>(textureDimensions(bent_map)) - 1;
    let place = page_uv * vec2<f32>(last + 1) - 0.5;
    let base = floor(place);
    let weight = place - base;
    let low = clamp(vec2<i32>(base), vec2<i32>(0), last);
    let high = clamp(vec2<i32>(base) + 1, vec2<i32>(0), last);
    let top = mix(bent_at(low, side), bent_at(vec2<i32>(high.x, low.y), side), weight.x);
    let bottom = mix(bent_at(vec2<i32>(low.x, high.y), side), bent_at(high, side), weight.x);
    return mix(top, bottom, weight.y);
}

fn ambient_light(page_uv: vec2<f32>, normal: vec3<f32>, side: i32) -> vec3<f32> {
    let share = clamp(0.5 + 0.75 * bent_height(page_uv, side), 0.0, 1.0);
    return mix(frame.ground_light, frame.sky_light, share) * ambient_visibility(page_uv, side);
}
