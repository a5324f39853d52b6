// A lamp without size, where nothing hides it: all of it, or none where the surface turns away or lies beyond its range.
@fragment
fn lamp_gate_fragment(varyings: Varyings) -> @location(0) vec4<f32> {
    cut_away(varyings);
    let ray = view_ray(varyings.clip.xy);
    let face = towards_eye(varyings.front_normal, varyings, ray);
    let way_m = way_to_lamp(varyings, ray);
    let is_lit = faces_lamp(face, way_m) && dot(way_m, way_m) <= lamp.range_m * lamp.range_m;
    return vec4<f32>(select(0.0, 1.0, is_lit), 0.0, 0.0, 1.0);
}
