// A corner of a volume: one of the points or, beyond them, where the sun's rays meet, at infinity.
fn corner(index: u32) -> vec4<f32> {
    if index < point_count() {
        return clip_position(point_m(index));
    }
    return frame.clip_from_eye * vec4<f32>(-frame.sun_direction, 0.0);
}
