// The lamp on a diffuse surface: inverse square of the distance, bounded by the lamp's own size; 0 beyond its range.
fn lamp_shade(
    material: Material,
    base_color: vec3<f32>,
    normal: vec3<f32>,
    to_lamp_m: vec3<f32>,
    visibility: f32,
) -> vec3<f32> {
    let distance2 = max(dot(to_lamp_m, to_lamp_m), 1e-12);
    if material.is_unlit > 0.5 || distance2 > lamp.range_m * lamp.range_m {
        return vec3<f32>(0.0);
    }
    let lambert = max(dot(normal, to_lamp_m) * inverseSqrt(distance2), 0.0);
    return base_color * lamp.light * (visibility * lambert / (distance2 + lamp.radius_m * lamp.radius_m));
}
