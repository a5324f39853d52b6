// How much of a point at a place of a map is lit.
fn lit_on_map(
    map: i32,
    place: vec3<f32>,
    from_eye_m: vec3<f32>,
    geometric_normal: vec3<f32>,
    pixel: vec2<f32>,
) -> f32 {
    return shadow_filter(receiver_on_map(map, place, from_eye_m, geometric_normal, false), pixel);
}
