// The sun's visibility alone.
@fragment
fn visibility_fragment(varyings: Varyings) -> @location(0) vec4<f32> {
    test_alpha(varyings);
    let gate = gate_normal(varyings, view_ray(varyings.clip.xy));
    return vec4<f32>(sun_visibility(varyings, gate), 0.0, 0.0, 1.0);
}
