// Several maps that overlap: the first that holds the point. A point on no map is lit.
fn shadow_visibility(from_eye_m: vec3<f32>, geometric_normal: vec3<f32>, pixel: vec2<f32>) -> f32 {
    for (var map = 0; map < i32(shadow_maps.count); map++) {
        let place = place_on_map(map, from_eye_m);
        if is_on_map(place, MAP_MARGIN_TEXELS) {
            return lit_on_map(map, place, from_eye_m, geometric_normal, pixel);
        }
    }
    return 1.0;
}
