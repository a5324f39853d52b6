// A point sun that no volume hides: 1, or 0 where the surface faces away.
@fragment
fn sun_mask_fragment(varyings: Varyings) -> @location(0) vec4<f32> {
    test_alpha(varyings);
    let gate = gate_normal(varyings, view_ray(varyings.clip.xy));
    return vec4<f32>(select(0.0, 1.0, dot(gate, frame.sun_direction) > 0.0), 0.0, 0.0, 1.0);
}
