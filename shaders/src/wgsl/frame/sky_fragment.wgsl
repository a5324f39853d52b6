// The background: what is seen where there is no surface.
@fragment
fn sky_fragment(@builtin(position) clip: vec4<f32>) -> @location(0) vec4<f32> {
    return vec4<f32>(sky_color(normalize(view_ray(clip.xy))), 1.0);
}
