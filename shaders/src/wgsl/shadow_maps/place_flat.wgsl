// What of a surface is compared with shadow maps, relative to the eye, and the normal of its plane.
struct ReceiverPlace {
    from_eye_m: vec3<f32>,
    normal: vec3<f32>,
}

fn receiver_place(varyings: Varyings, gate: vec3<f32>) -> ReceiverPlace {
    return ReceiverPlace(view_ray(varyings.clip.xy) / varyings.clip.w, gate);
}
