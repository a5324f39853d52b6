// Whether a face turns to the lamp, by more than its place can be told: what the lamp grazes from its own plane is dark.
fn faces_lamp(face: vec3<f32>, way_m: vec3<f32>) -> bool {
    let steps = abs(frame.eye_m) + abs(lamp.position_m) + abs(way_m);
    return dot(face, way_m) > 4e-7 * (steps.x + steps.y + steps.z);
}
