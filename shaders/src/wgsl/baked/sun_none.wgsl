// No sun: nothing is read.
fn sun_visibility(varyings: Varyings, gate: vec3<f32>) -> f32 {
    return 0.0;
}
