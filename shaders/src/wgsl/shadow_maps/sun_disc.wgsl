// The visible share of the sun's disc from shadow maps, at most the share that is above the surface's plane and the
// horizon.
fn sun_visibility(varyings: Varyings, gate: vec3<f32>) -> f32 {
    let height = min(dot(gate, frame.sun_direction), frame.sun_direction.y);
    let disc_share = clamp(0.5 + height * frame.inverse_angular_diameter, 0.0, 1.0);
    if disc_share <= 0.0 {
        return 0.0;
    }
    return min(disc_share, place_visibility(varyings, gate));
}
