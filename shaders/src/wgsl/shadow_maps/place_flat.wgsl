// What maps say of a surface: of its place and its plane.
fn place_visibility(varyings: Varyings, gate: vec3<f32>) -> f32 {
    return shadow_visibility(view_ray(varyings.clip.xy) / varyings.clip.w, gate, varyings.clip.xy);
}
