// A sun without width as the maps tell it, where it stands before the surface's plane: sun_baked.wgsl without a disc.
fn sun_visibility(varyings: Varyings, face: vec3<f32>) -> f32 {
    if dot(face, frame.sun_direction) <= 0.0 {
        return 0.0;
    }
    return page_visibility(varyings.page_uv);
}
