// A blended surface: its alpha, and what it does not let through (KHR_materials_transmission as a blend).
fn opacity_of(alpha: f32, material: Material) -> f32 {
    return alpha * (1.0 - material.transmission);
}
