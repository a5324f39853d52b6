// The vertex stage of casters without alpha masks, for masks of casters on the ground.
struct Varyings {
    @builtin(position) clip: vec4<f32>,
    @location(0) height_m: f32,
}

@vertex
fn mask_vertex(@location(0) position_m: vec3<f32>) -> Varyings {
    return Varyings(clip_position(position_m), height_above_ground(position_m));
}
