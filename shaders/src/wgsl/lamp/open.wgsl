// A lamp that nothing hides: the share of its sphere that is in front of the surface's plane; 0 beyond its range.
fn lamp_visibility(page_uv: vec2<f32>, gate: vec3<f32>, to_lamp_m: vec3<f32>) -> f32 {
    let sphere_share = clamp(0.5 + dot(gate, to_lamp_m) * lamp.inverse_diameter_per_m, 0.0, 1.0);
    return select(sphere_share, 0.0, dot(to_lamp_m, to_lamp_m) > lamp.range_m * lamp.range_m);
}
