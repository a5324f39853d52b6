// The values of a footprint's texels blended, in the order of `texel_of`.
fn blended(at: Footprint, values: vec4<f32>) -> f32 {
    let top = mix(values.x, values.y, at.weight.x);
    let bottom = mix(values.z, values.w, at.weight.x);
    return mix(top, bottom, at.weight.y);
}

// The same for colours.
fn blended_colors(at: Footprint, a: vec3<f32>, b: vec3<f32>, c: vec3<f32>, d: vec3<f32>) -> vec3<f32> {
    return mix(mix(a, b, at.weight.x), mix(c, d, at.weight.x), at.weight.y);
}
