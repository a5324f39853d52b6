// The same with metal and highlights.
fn shade(at: Surface, visibility: f32, ambient: vec3<f32>) -> vec3<f32> {
    let sun = reflected(at, frame.sun_direction) * (frame.sun_light * visibility);
    return sun + reflected_ambient(at, ambient) + at.emitted;
}
