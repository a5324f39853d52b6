// How much of a point at a place of a map is lit.
//
// Texels may be compared with the receiver's plane. But where the sun grazes, a texel across the light is many metres
// along it. By there the plane has left the surface, for the far side of what shades it or for what lies below. So
// there the point is moved along its normal instead.

// Cosine between normal and sun below which the sun grazes.
const GRAZING: f32 = 1.0 / 64.0;

fn lit_on_map(
    map: i32,
    place: vec3<f32>,
    from_eye_m: vec3<f32>,
    geometric_normal: vec3<f32>,
    pixel: vec2<f32>,
) -> f32 {
    let grazes = BIAS_HAS_PLANE && dot(geometric_normal, frame.sun_direction) < GRAZING;
    return shadow_filter(receiver_on_map(map, place, from_eye_m, geometric_normal, grazes), pixel);
}
