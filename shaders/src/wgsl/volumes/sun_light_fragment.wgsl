// Light of a point sun that no volume hides.
@fragment
fn sun_light_fragment(varyings: Varyings) -> @location(0) vec4<f32> {
    test_alpha(varyings);
    let at = surface_at(varyings);
    if at.material.is_unlit > 0.5 || dot(at.gate, frame.sun_direction) <= 0.0 {
        return vec4<f32>(0.0);
    }
    return vec4<f32>(reflected(at, frame.sun_direction) * frame.sun_light, 0.0);
}
