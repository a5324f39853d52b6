// The lamp as the maps tell it, no more than the share of its ball that stands before the surface's plane, and not beyond
// its range.
fn lamp_visibility(page_uv: vec2<f32>, face: vec3<f32>, way_m: vec3<f32>) -> f32 {
    let ball_share = clamp(0.5 + dot(face, way_m) * lamp.balls_per_metre, 0.0, 1.0);
    if ball_share <= 0.0 || dot(way_m, way_m) > lamp.range_m * lamp.range_m {
        return 0.0;
    }
    return min(ball_share, page_lamp_visibility(page_uv));
}
