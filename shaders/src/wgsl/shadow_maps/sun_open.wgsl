// A point sun that nothing hides.
fn sun_visibility(varyings: Varyings, geometric_normal: vec3<f32>) -> f32 {
    return select(0.0, 1.0, dot(geometric_normal, frame.sun_direction) > 0.0);
}
