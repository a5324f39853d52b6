// What of a facet is compared with shadow maps, relative to the eye, and the normal of its plane: the facet itself where
// it faces the sun, else the smooth shape above it. Twin of bake/src/scene/smooth.rs and bake/src/visibility/start.rs.
struct ReceiverPlace {
    from_eye_m: vec3<f32>,
    normal: vec3<f32>,
}

// The vector of an edge, if it bulges to the side that is seen.
fn rising(edge_lift: vec3<f32>, side: vec3<f32>) -> vec3<f32> {
    return select(vec3<f32>(0.0), edge_lift, dot(edge_lift, side) > 0.0);
}

// From the facet to the smooth shape.
fn lift(varyings: Varyings, side: vec3<f32>) -> vec3<f32> {
    let second = varyings.lift_weights.x;
    let third = varyings.lift_weights.y;
    let first = 1.0 - second - third;
    return rising(varyings.first_lift_m, side) * (first * second)
        + rising(varyings.second_lift_m, side) * (second * third)
        + rising(varyings.third_lift_m, side) * (third * first);
}

fn receiver_place(varyings: Varyings, gate: vec3<f32>) -> ReceiverPlace {
    let ray = view_ray(varyings.clip.xy);
    let from_eye_m = ray / varyings.clip.w;
    let face = towards_eye(varyings.front_normal, varyings, ray);
    if dot(face, frame.sun_direction) > 0.0 {
        return ReceiverPlace(from_eye_m, face);
    }
    return ReceiverPlace(from_eye_m + lift(varyings, face), gate);
}
