// A surface that nothing is seen through.
fn opacity_of(alpha: f32, material: Material) -> f32 {
    return 1.0;
}
