// Ambient occlusion, blended by hand: 16-bit integer textures have no filter. A slice for each side.
@group(1) @binding(2) var ao_map: texture_2d_array<u32>;

fn ambient_visibility_at(texel: vec2<i32>, side: i32) -> f32 {
    return f32(textureLoad(ao_map, texel, side, 0).x) / 65535.0;
}

fn ambient_visibility(page_uv: vec2<f32>, side: i32) -> f32 {
    let last = vec2<i32>(textureDimensions(ao_map)) - 1;
    let place = page_uv * vec2<f32>(last + 1) - 0.5;
    let base = floor(place);
    let weight = place - base;
    let low = clamp(vec2<i32>(base), vec2<i32>(0), last);
    let high = clamp(vec2<i32>(base) + 1, vec2<i32>(0), last);
    let top = mix(ambient_visibility_at(low, side), ambient_visibility_at(vec2<i32>(high.x, low.y), side), weight.x);
    let bottom = mix(ambient_visibility_at(vec2<i32>(low.x, high.y), side), ambient_visibility_at(high, side), weight.x);
    return mix(top, bottom, weight.y);
}
