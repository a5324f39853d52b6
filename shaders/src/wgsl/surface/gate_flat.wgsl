// The normal that decides whether a surface faces the light, on the side that the eye is on: the face's.
fn gate_normal(varyings: Varyings, ray: vec3<f32>) -> vec3<f32> {
    return towards_eye(varyings.front_normal, varyings, ray);
}
