// Maps from fine to coarse: the finest that holds the point, blended towards its border with the next, if that holds
// it too. A point on no map is lit.

// Where a map starts to give way to the next, as a share of the way to its border.
const BLEND_FROM: f32 = 0.85;

fn shadow_visibility(from_eye_m: vec3<f32>, geometric_normal: vec3<f32>, pixel: vec2<f32>) -> f32 {
    let most = 1.0 - 2.0 * MAP_MARGIN_TEXELS / f32(textureDimensions(shadow_depths).x);
    for (var map = 0; map < i32(shadow_maps.count); map++) {
        let place = place_on_map(map, from_eye_m);
        if !is_on_map(place, MAP_MARGIN_TEXELS) {
            continue;
        }
        let visibility = lit_on_map(map, place, from_eye_m, geometric_normal, pixel);
        let border = max(abs(place.x), abs(place.y)) / most;
        let next_share = smoothstep(BLEND_FROM, 1.0, border);
        if map + 1 == i32(shadow_maps.count) || next_share == 0.0 {
            return visibility;
        }
        let next_place = place_on_map(map + 1, from_eye_m);
        if !is_on_map(next_place, MAP_MARGIN_TEXELS) {
            return visibility;
        }
        let next = lit_on_map(map + 1, next_place, from_eye_m, geometric_normal, pixel);
        return mix(visibility, next, next_share);
    }
    return 1.0;
}
