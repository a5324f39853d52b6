// Light on a diffuse surface: the visible share of the sun, and ambient light.
fn shade(
    material: Material,
    base_color: vec3<f32>,
    normal: vec3<f32>,
    visibility: f32,
    ambient: vec3<f32>,
) -> vec3<f32> {
    if material.is_unlit > 0.5 {
        return base_color + material.emissive;
    }
    let sun = frame.sun_light * (visibility * max(dot(normal, frame.sun_direction), 0.0));
    return base_color * (sun + ambient) + material.emissive;
}
