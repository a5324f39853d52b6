// Ambient occlusion: the visible share of the sky. Blended by hand, since integer textures are not filtered. One
// slice per side.
@group(1) @binding(2) var ao_map: texture_2d_array<u32>;

fn ambient_visibility_at(texel: vec2<i32>, side: i32) -> f32 {
    return f32(textureLoad(ao_map, texel, side, 0).x) / 65535.0;
}

fn ambient_visibility(page_uv: vec2<f32>, side: i32) -> f32 {
    let at = footprint(page_uv, textureDimensions(ao_map));
    let top = vec2<f32>(ambient_visibility_at(texel_of(at, 0), side), ambient_visibility_at(texel_of(at, 1), side));
    let bottom = vec2<f32>(ambient_visibility_at(texel_of(at, 2), side), ambient_visibility_at(texel_of(at, 3), side));
    return blended(at, vec4<f32>(top, bottom));
}
