// The lamp's visibility alone.
@fragment
fn lamp_visibility_fragment(varyings: Varyings) -> @location(0) vec4<f32> {
    test_alpha(varyings);
    let ray = view_ray(varyings.clip.xy);
    let gate = gate_normal(varyings, ray);
    return vec4<f32>(lamp_visibility(varyings.page_uv, gate, to_lamp_from(varyings, ray)), 0.0, 0.0, 1.0);
}
