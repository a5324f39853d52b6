// Which side's maps to read: the one that the eye is on.
fn side_of_page(varyings: Varyings, ray: vec3<f32>) -> i32 {
    return select(0, 1, dot(varyings.front_normal, ray) > 0.0);
}
