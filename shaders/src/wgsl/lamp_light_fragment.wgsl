// What a lamp without size adds where nothing hides it.
@fragment
fn lamp_light_fragment(varyings: Varyings) -> @location(0) vec4<f32> {
    cut_away(varyings);
    let at = surface_at(varyings);
    let way_m = way_to_lamp(varyings, at.ray);
    let seen = select(0.0, 1.0, faces_lamp(at.face, way_m));
    return vec4<f32>(lamp_shade(at.material, at.base_color, at.normal, way_m, seen), 0.0);
}
