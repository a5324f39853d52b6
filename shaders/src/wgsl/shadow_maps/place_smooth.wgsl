// What maps say of a facet: of its place and its plane where it faces the sun, else of the smooth shape above it. Twin
// of bake/src/scene/smooth.rs and bake/src/visibility/start.rs.

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

fn place_visibility(varyings: Varyings, gate: vec3<f32>) -> f32 {
    let ray = view_ray(varyings.clip.xy);
    let from_eye_m = ray / varyings.clip.w;
    let face = towards_eye(varyings.front_normal, varyings, ray);
    if dot(face, frame.sun_direction) > 0.0 {
        return shadow_visibility(from_eye_m, face, varyings.clip.xy);
    }
    let rise_m = lift(varyings, face);
    if all(rise_m == vec3<f32>(0.0)) {
        // Where the shape is hollow the facet is in the way.
        return 0.0;
    }
    return shadow_visibility(from_eye_m + rise_m, gate, varyings.clip.xy);
}
