// A surface as a pixel shows it, turned to the side that the eye is on.
struct Surface {
    ray: vec3<f32>,
    material: Material,
    base_color: vec3<f32>,
    // Decides whether the surface faces the light.
    gate: vec3<f32>,
    normal: vec3<f32>,
}

fn surface_at(varyings: Varyings) -> Surface {
    let ray = view_ray(varyings.clip.xy);
    let material = materials[varyings.material];
    let base_color = material.base_color * vertex_color(varyings) * texture_color(varyings, ray);
    let normal = towards_eye(normalize(varyings.shading_normal.xyz), varyings, ray);
    return Surface(ray, material, base_color.rgb, gate_normal(varyings, ray), normal);
}
