// A point lamp that no volume hides: 1, or 0 where the surface faces away or lies beyond its range.
@fragment
fn lamp_mask_fragment(varyings: Varyings) -> @location(0) vec4<f32> {
    test_alpha(varyings);
    let ray = view_ray(varyings.clip.xy);
    let to_lamp_m = to_lamp_from(varyings, ray);
    let is_in_range = dot(to_lamp_m, to_lamp_m) <= lamp.range_m * lamp.range_m;
    let is_lit = is_in_range && faces_lamp(gate_normal(varyings, ray), to_lamp_m);
    return vec4<f32>(select(0.0, 1.0, is_lit), 0.0, 0.0, 1.0);
}
