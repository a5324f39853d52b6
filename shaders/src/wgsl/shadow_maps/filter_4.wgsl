// Four of the sixteen comparisons, two texels apart; which four depends on where in a block of two by two pixels this
// one lies, so that such a block makes all sixteen (the dither of
// GPU Gems chapter 11).
fn shadow_filter(at: Receiver, pixel: vec2<f32>) -> f32 {
    let odd = vec2<u32>(pixel) & vec2<u32>(1u);
    let first = vec2<f32>(f32(odd.x), f32(odd.x ^ odd.y)) - 1.5;
    return 0.25 * (shadow_tap(at, first) + shadow_tap(at, first + vec2<f32>(2.0, 0.0))
        + shadow_tap(at, first + vec2<f32>(0.0, 2.0)) + shadow_tap(at, first + 2.0));
}
