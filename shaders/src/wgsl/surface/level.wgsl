// The level of detail of a texture with so many texels per metre. It comes from distance and slant, not from
// differences between pixels, so that a ray tracer can compute the same one.
fn texture_level(varyings: Varyings, ray: vec3<f32>, texels_per_metre: f32) -> f32 {
    let depth_m = 1.0 / varyings.clip.w;
    let distance_m = depth_m * length(ray);
    let slant = max(abs(dot(varyings.front_normal, normalize(ray))), 0.01);
    let texels = texels_per_metre * distance_m * frame.pixel_angle_rad * inverseSqrt(slant);
    return log2(max(texels, 1.0));
}
