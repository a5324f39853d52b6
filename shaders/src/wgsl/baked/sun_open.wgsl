// A sun that nothing hides: the share of its disc that is in front of the surface's plane.
fn sun_visibility(varyings: Varyings, gate: vec3<f32>) -> f32 {
    return clamp(0.5 + dot(gate, frame.sun_direction) * frame.inverse_angular_diameter, 0.0, 1.0);
}
