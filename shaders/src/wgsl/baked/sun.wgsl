// The visible share of the sun from the maps, at most the share of its disc that is in front of the surface's plane.
// For surfaces with one side, stored times end where the sun passes the plane. For those with two, they hold for the
// side that faces the sun, and this keeps the other side dark.
fn sun_visibility(varyings: Varyings, gate: vec3<f32>) -> f32 {
    let disc_share = clamp(0.5 + dot(gate, frame.sun_direction) * frame.inverse_angular_diameter, 0.0, 1.0);
    if disc_share <= 0.0 {
        return 0.0;
    }
    return min(disc_share, page_visibility(varyings.page_uv));
}
