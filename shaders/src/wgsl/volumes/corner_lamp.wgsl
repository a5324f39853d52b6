// A corner of a volume: a point, or for higher indices a point extruded away from the lamp to infinity.
fn corner(index: u32) -> vec4<f32> {
    let count = point_count();
    if index < count {
        return clip_position(point_m(index));
    }
    return frame.clip_from_eye * vec4<f32>(point_m(index - count) - lamp.position_m, 0.0);
}
