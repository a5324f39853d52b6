// The sun as the maps tell it, no more than the share of its disc that stands before the surface's plane. For most
// surfaces the maps know of the plane already. They do not for those with two sides: their times hold for whichever side
// the sun stands before, and the far side of a leaf is dark.
fn sun_visibility(varyings: Varyings, face: vec3<f32>) -> f32 {
    let disc_share = clamp(0.5 + dot(face, frame.sun_direction) * frame.discs_per_radian, 0.0, 1.0);
    if disc_share <= 0.0 {
        return 0.0;
    }
    return min(disc_share, page_visibility(varyings.page_uv));
}
