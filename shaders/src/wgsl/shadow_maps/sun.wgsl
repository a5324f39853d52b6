// A point sun from shadow maps: 0 where the surface faces away.
fn sun_visibility(varyings: Varyings, gate: vec3<f32>) -> f32 {
    if dot(gate, frame.sun_direction) <= 0.0 {
        return 0.0;
    }
    return place_visibility(varyings, gate);
}
