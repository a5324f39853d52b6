// Sky and ground by the normal, times the visible share of the sky.
fn ambient_light(page_uv: vec2<f32>, normal: vec3<f32>, side: i32) -> vec3<f32> {
    return mix(frame.ground_light, frame.sky_light, 0.5 + 0.5 * normal.y) * ambient_visibility(page_uv, side);
}
