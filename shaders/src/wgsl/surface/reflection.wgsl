// A surface that only scatters light: the share of a light's irradiance that it sends to the eye.
fn reflected(at: Surface, towards_light: vec3<f32>) -> vec3<f32> {
    return at.base_color * max(dot(at.normal, towards_light), 0.0);
}
