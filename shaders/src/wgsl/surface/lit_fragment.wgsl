// The lit pass: linear light, before the tone curve.
@fragment
fn lit_fragment(varyings: Varyings) -> @location(0) vec4<f32> {
    test_alpha(varyings);
    let at = surface_at(varyings);
    let visibility = sun_visibility(varyings, at.gate);
    let ambient = ambient_light(varyings.page_uv, at.normal, side_of_page(varyings, at.ray));
    let light = shade(at, visibility, ambient);
    let to_lamp_m = to_lamp_from(varyings, at.ray);
    let visibility_of_lamp = lamp_visibility(varyings.page_uv, at.gate, to_lamp_m);
    return vec4<f32>(light + lamp_shade(at, to_lamp_m, visibility_of_lamp), at.opacity);
}
