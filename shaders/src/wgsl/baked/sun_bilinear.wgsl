// Four texels evaluated, then blended. Times themselves must never be blended: a texel that is lit in the morning and
// one that is lit in the evening do not make one that is lit at noon.
fn page_visibility(page_uv: vec2<f32>) -> f32 {
    let at = footprint(page_uv, textureDimensions(rise_map));
    let top = vec2<f32>(disc_visibility(texel_of(at, 0)), disc_visibility(texel_of(at, 1)));
    let bottom = vec2<f32>(disc_visibility(texel_of(at, 2)), disc_visibility(texel_of(at, 3)));
    return blended(at, vec4<f32>(top, bottom));
}
