// A corner of a volume: a point, or for higher indices the point at infinity away from the sun.
fn corner(index: u32) -> vec4<f32> {
    if index < point_count() {
        return clip_position(point_m(index));
    }
    return frame.clip_from_eye * vec4<f32>(-frame.sun_direction, 0.0);
}
