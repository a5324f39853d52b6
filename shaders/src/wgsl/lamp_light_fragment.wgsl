// What a lamp without size adds where nothing hides it.
@fragment
fn lamp_light_fragment(varyings: Varyings) -> @location(0) vec4<f32> {
    cut_away(varyings);
    let ray = view_ray(varyings.clip.xy);
    let material = materials[varyings.material];
    let base_color = material.base_color * vertex_color(varyings) * texture_color(varyings, ray);
    let face = towards_eye(varyings.front_normal, varyings, ray);
    let normal = towards_eye(normalize(varyings.shading_normal.xyz), varyings, ray);
    let way_m = way_to_lamp(varyings, ray);
    let seen = select(0.0, 1.0, faces_lamp(face, way_m));
    return vec4<f32>(lamp_shade(material, base_color.rgb, normal, way_m, seen), 0.0);
}
