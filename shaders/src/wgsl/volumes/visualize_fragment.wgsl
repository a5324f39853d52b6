// Faces in front of the surface, counted separately: those that turn to the eye in red, those that turn away in blue.
@fragment
fn volume_visualize_fragment(@builtin(front_facing) is_front: bool) -> @location(0) vec4<f32> {
    return select(vec4<f32>(0.0, 0.0, 1.0, 0.0), vec4<f32>(1.0, 0.0, 0.0, 0.0), is_front);
}
