// The sun on the ground, from a mask of casters projected flat onto it, as the camera sees them.
@group(3) @binding(0) var flat_mask: texture_2d<f32>;

fn sun_visibility(varyings: Varyings, gate: vec3<f32>) -> f32 {
    if dot(gate, frame.sun_direction) <= 0.0 {
        return 0.0;
    }
    return textureLoad(flat_mask, vec2<i32>(varyings.clip.xy), 0).r;
}
