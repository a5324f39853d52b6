// The lamp on a matt surface: as the square of distance, but not beyond what its own size allows, nor beyond its range.
fn lamp_shade(material: Material, base_color: vec3<f32>, normal: vec3<f32>, way_m: vec3<f32>, seen: f32) -> vec3<f32> {
    let distance2 = max(dot(way_m, way_m), 1e-12);
    if material.is_unlit > 0.5 || distance2 > lamp.range_m * lamp.range_m {
        return vec3<f32>(0.0);
    }
    let lambert = max(dot(normal, way_m) * inverseSqrt(distance2), 0.0);
    return base_color * lamp.light * (seen * lambert / (distance2 + lamp.radius_m * lamp.radius_m));
}
