// The material's texture. The level of detail comes from distance and slant, not from differences between pixels, so
// that a ray tracer can compute the same one.
@group(2) @binding(0) var base_texture: texture_2d<f32>;
@group(2) @binding(1) var base_sampler: sampler;

fn texture_color(varyings: Varyings, ray: vec3<f32>) -> vec4<f32> {
    let depth_m = 1.0 / varyings.clip.w;
    let distance_m = depth_m * length(ray);
    let slant = max(abs(dot(varyings.front_normal, normalize(ray))), 0.01);
    let texels = varyings.texels_per_metre * distance_m * frame.pixel_angle_rad * inverseSqrt(slant);
    return textureSampleLevel(base_texture, base_sampler, varyings.image_uv, log2(max(texels, 1.0)));
}
