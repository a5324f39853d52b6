// Light of a point lamp that no volume hides.
@fragment
fn lamp_light_fragment(varyings: Varyings) -> @location(0) vec4<f32> {
    test_alpha(varyings);
    let at = surface_at(varyings);
    let to_lamp_m = to_lamp_from(varyings, at.ray);
    let visibility = select(0.0, 1.0, faces_lamp(at.gate, to_lamp_m));
    return vec4<f32>(lamp_shade(at, to_lamp_m, visibility), 0.0);
}
