// Whether a face turns to the lamp, by more than the rounding of positions. A face in the lamp's plane is dark.
fn faces_lamp(gate: vec3<f32>, to_lamp_m: vec3<f32>) -> bool {
    let steps = abs(frame.eye_m) + abs(lamp.position_m) + abs(to_lamp_m);
    return dot(gate, to_lamp_m) > 4e-7 * (steps.x + steps.y + steps.z);
}
