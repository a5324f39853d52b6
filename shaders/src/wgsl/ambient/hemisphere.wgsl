// Light of the sky above and the ground below, by the normal alone. Nothing hides either.
fn ambient_light(page_uv: vec2<f32>, normal: vec3<f32>, side: i32) -> vec3<f32> {
    return mix(frame.ground_light, frame.sky_light, 0.5 + 0.5 * normal.y);
}
