// A surface as a pixel shows it, turned to the side that the eye is on.
struct Surface {
    ray: vec3<f32>,
    material: Material,
    base_color: vec3<f32>,
    opacity: f32,
    metallic: f32,
    roughness: f32,
    emitted: vec3<f32>,
    // Decides whether the surface faces the light.
    gate: vec3<f32>,
    normal: vec3<f32>,
}

fn surface_at(varyings: Varyings) -> Surface {
    let ray = view_ray(varyings.clip.xy);
    let material = materials[varyings.material];
    let base_color = material.base_color * vertex_color(varyings) * texture_color(varyings, ray);
    let opacity = opacity_of(base_color.a, material);
    let metal = metallic_roughness(varyings, ray, material);
    let emitted = emitted_light(varyings, ray, material);
    let gate = gate_normal(varyings, ray);
    let normal = towards_eye(shading_normal(varyings, ray, material), varyings, ray);
    return Surface(ray, material, base_color.rgb, opacity, metal.x, metal.y, emitted, gate, normal);
}
