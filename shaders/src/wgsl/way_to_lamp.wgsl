// The way from a pixel's surface to the lamp. A ray is one deep, and so is what a pixel's depth is told in.
fn way_to_lamp(varyings: Varyings, ray: vec3<f32>) -> vec3<f32> {
    return lamp.position_m - (frame.eye_m + ray / varyings.clip.w);
}
