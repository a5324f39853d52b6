// One map. A point beside it is lit.
fn shadow_visibility(from_eye_m: vec3<f32>, geometric_normal: vec3<f32>, pixel: vec2<f32>) -> f32 {
    let place = place_on_map(0, from_eye_m);
    if !is_on_map(place, 0.0) {
        return 1.0;
    }
    return lit_on_map(0, place, from_eye_m, geometric_normal, pixel);
}
