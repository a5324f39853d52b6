// Light on a matt surface: the sun so far as it is seen, a sky above, the ground's glow from below.
fn shade(material: Material, base_color: vec3<f32>, normal: vec3<f32>, visibility: f32, open: f32) -> vec3<f32> {
    if material.is_unlit > 0.5 {
        return base_color + material.emissive;
    }
    let sun = frame.sun_light * (visibility * max(dot(normal, frame.sun_direction), 0.0));
    let sky = mix(frame.ground_light, frame.sky_light, 0.5 + 0.5 * normal.y) * open;
    return base_color * (sun + sky) + material.emissive;
}
