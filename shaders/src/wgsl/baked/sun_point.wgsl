// A point sun from the maps, where it is in front of the surface's plane: sun.wgsl without a disc.
fn sun_visibility(varyings: Varyings, gate: vec3<f32>) -> f32 {
    if dot(gate, frame.sun_direction) <= 0.0 {
        return 0.0;
    }
    return page_visibility(varyings.page_uv);
}
