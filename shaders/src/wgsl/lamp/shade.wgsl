// The lamp on a surface: inverse square of the distance, bounded by the lamp's own size; 0 beyond its range.
fn lamp_shade(at: Surface, to_lamp_m: vec3<f32>, visibility: f32) -> vec3<f32> {
    let distance2 = max(dot(to_lamp_m, to_lamp_m), 1e-12);
    if at.material.is_unlit > 0.5 || distance2 > lamp.range_m * lamp.range_m {
        return vec3<f32>(0.0);
    }
    let share = reflected(at, to_lamp_m * inverseSqrt(distance2));
    return share * lamp.light * (visibility / (distance2 + lamp.radius_m * lamp.radius_m));
}
