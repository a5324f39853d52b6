// Light on a diffuse surface: the visible share of the sun, ambient light, and what it emits.
fn shade(at: Surface, visibility: f32, ambient: vec3<f32>) -> vec3<f32> {
    if at.material.is_unlit > 0.5 {
        return at.base_color;
    }
    let sun = frame.sun_light * (visibility * max(dot(at.normal, frame.sun_direction), 0.0));
    return at.base_color * (sun + ambient) + at.emitted;
}
