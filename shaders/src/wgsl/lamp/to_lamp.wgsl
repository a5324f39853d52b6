// From a pixel's surface to the lamp. The ray's component along the camera's axis is 1, and clip.w is 1 / depth.
fn to_lamp_from(varyings: Varyings, ray: vec3<f32>) -> vec3<f32> {
    return lamp.position_m - (frame.eye_m + ray / varyings.clip.w);
}
