// A point sun that nothing hides.
fn sun_visibility(varyings: Varyings, gate: vec3<f32>) -> f32 {
    return select(0.0, 1.0, dot(gate, frame.sun_direction) > 0.0);
}
