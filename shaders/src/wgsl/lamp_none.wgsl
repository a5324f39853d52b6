// A page without a lamp: nothing is read.
fn way_to_lamp(varyings: Varyings, ray: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(0.0);
}

fn lamp_visibility(page_uv: vec2<f32>, face: vec3<f32>, way_m: vec3<f32>) -> f32 {
    return 0.0;
}
