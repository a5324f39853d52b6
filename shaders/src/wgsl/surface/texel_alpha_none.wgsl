// Alpha of a material without a texture.
fn texel_alpha(varyings: Varyings, material: Material) -> f32 {
    return 1.0;
}
