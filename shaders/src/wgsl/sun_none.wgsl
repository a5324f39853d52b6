// A set without a sun: nothing is read.
fn sun_visibility(page_uv: vec2<f32>, face: vec3<f32>) -> f32 {
    return 0.0;
}
