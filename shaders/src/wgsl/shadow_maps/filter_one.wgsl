// One comparison.
fn shadow_filter(at: Receiver, pixel: vec2<f32>) -> f32 {
    return shadow_tap(at, vec2<f32>(0.0));
}
