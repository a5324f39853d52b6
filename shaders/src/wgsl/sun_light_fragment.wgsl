// What a sun without size adds where nothing hides it.
@fragment
fn sun_light_fragment(varyings: Varyings) -> @location(0) vec4<f32> {
    cut_away(varyings);
    let ray = view_ray(varyings.clip.xy);
    let material = materials[varyings.material];
    let base_color = material.base_color * vertex_color(varyings) * texture_color(varyings, ray);
    let face = towards_eye(varyings.front_normal, varyings, ray);
    let normal = towards_eye(normalize(varyings.shading_normal.xyz), varyings, ray);
    if material.is_unlit > 0.5 || dot(face, frame.sun_direction) <= 0.0 {
        return vec4<f32>(0.0);
    }
    return vec4<f32>(base_color.rgb * frame.sun_light * max(dot(normal, frame.sun_direction), 0.0), 0.0);
}
