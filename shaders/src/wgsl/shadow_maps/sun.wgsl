// A point sun from shadow maps: 0 where the surface faces away.
fn sun_visibility(varyings: Varyings, geometric_normal: vec3<f32>) -> f32 {
    if dot(geometric_normal, frame.sun_direction) <= 0.0 {
        return 0.0;
    }
    return shadow_visibility(view_ray(varyings.clip.xy) / varyings.clip.w, geometric_normal, varyings.clip.xy);
}
