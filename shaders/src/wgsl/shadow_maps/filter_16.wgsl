// Sixteen comparisons over four by four texels around the place itself, wherever in a texel it lies (Bunnell and
// Pellacini, "Shadow map antialiasing", GPU Gems chapter 11).
fn shadow_filter(at: Receiver, pixel: vec2<f32>) -> f32 {
    var lit = 0.0;
    for (var row = 0; row < 4; row++) {
        for (var column = 0; column < 4; column++) {
            lit += shadow_tap(at, vec2<f32>(f32(column), f32(row)) - 1.5);
        }
    }
    return lit / 16.0;
}
