// What a sun without size adds where nothing hides it.
@fragment
fn sun_light_fragment(varyings: Varyings) -> @location(0) vec4<f32> {
    cut_away(varyings);
    let at = surface_at(varyings);
    if at.material.is_unlit > 0.5 || dot(at.face, frame.sun_direction) <= 0.0 {
        return vec4<f32>(0.0);
    }
    return vec4<f32>(at.base_color * frame.sun_light * max(dot(at.normal, frame.sun_direction), 0.0), 0.0);
}
