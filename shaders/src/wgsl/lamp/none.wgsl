// No lamp: nothing is read.
fn to_lamp_from(varyings: Varyings, ray: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(0.0);
}

fn lamp_visibility(page_uv: vec2<f32>, gate: vec3<f32>, to_lamp_m: vec3<f32>) -> f32 {
    return 0.0;
}
