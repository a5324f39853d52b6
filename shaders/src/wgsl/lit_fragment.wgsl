// The lit pass: linear light, before the tone curve.
@fragment
fn lit_fragment(varyings: Varyings) -> @location(0) vec4<f32> {
    cut_away(varyings);
    let ray = view_ray(varyings.clip.xy);
    let material = materials[varyings.material];
    let base_color = material.base_color * vertex_color(varyings) * texture_color(varyings, ray);
    let face = towards_eye(varyings.front_normal, varyings, ray);
    let normal = towards_eye(normalize(varyings.shading_normal.xyz), varyings, ray);
    let visibility = sun_visibility(varyings.page_uv, face);
    let ambient = ambient_light(varyings.page_uv, normal, side_of_page(varyings, ray));
    let light = shade(material, base_color.rgb, normal, visibility, ambient);
    let way_m = way_to_lamp(varyings, ray);
    let of_lamp = lamp_shade(material, base_color.rgb, normal, way_m, lamp_visibility(varyings.page_uv, face, way_m));
    return vec4<f32>(light + of_lamp, 1.0);
}
