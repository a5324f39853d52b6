// Where a vertex lands. Every pass that must agree in depth uses this expression, and marks its position @invariant.
fn clip_position(position_m: vec3<f32>) -> vec4<f32> {
    return frame.clip_from_eye * vec4<f32>(position_m - frame.eye_m, 1.0);
}
