// The way from a pixel's surface to the lamp. A ray is one deep, and so is what a pixel's depth is told in.
fn way_to_lamp(varyings: Varyings, ray: vec3<f32>) -> vec3<f32> {
    return lamp.position_m - (frame.eye_m + ray / varyings.clip.w);
}

// The lamp as the maps tell it, no more than the share of its ball that stands before the surface's plane.
fn lamp_visibility(page_uv: vec2<f32>, face: vec3<f32>, way_m: vec3<f32>) -> f32 {
    let ball_share = clamp(0.5 + dot(face, way_m) * lamp.balls_per_metre, 0.0, 1.0);
    if ball_share <= 0.0 {
        return 0.0;
    }
    return min(ball_share, page_lamp_visibility(page_uv));
}
