// A point sun from shadow maps: 0 where the surface faces away.
fn sun_visibility(varyings: Varyings, gate: vec3<f32>) -> f32 {
    if dot(gate, frame.sun_direction) <= 0.0 {
        return 0.0;
    }
    let place = receiver_place(varyings, gate);
    return shadow_visibility(place.from_eye_m, place.normal, varyings.clip.xy);
}
