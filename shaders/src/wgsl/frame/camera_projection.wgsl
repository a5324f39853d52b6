// From bake space to the camera. All passes that compare depths use this expression, and mark the position @invariant.
fn clip_position(position_m: vec3<f32>) -> vec4<f32> {
    return frame.clip_from_eye * vec4<f32>(position_m - frame.eye_m, 1.0);
}
