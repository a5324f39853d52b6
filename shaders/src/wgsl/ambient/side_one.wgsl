// A page whose maps hold one side.
fn side_of_page(varyings: Varyings, ray: vec3<f32>) -> i32 {
    return 0;
}
