// A set without ambient occlusion: all of the sky is seen.
fn openness(page_uv: vec2<f32>) -> f32 {
    return 1.0;
}
