// A normal turned to the side that the eye is on.
fn towards_eye(normal: vec3<f32>, varyings: Varyings, ray: vec3<f32>) -> vec3<f32> {
    return select(normal, -normal, dot(varyings.front_normal, ray) > 0.0);
}
