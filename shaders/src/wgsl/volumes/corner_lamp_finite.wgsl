// For each point, the end of its volume as a multiple of its distance from the lamp: beyond the lamp's range.
@group(1) @binding(1) var<storage, read> reaches: array<f32>;

// A corner of a volume: a point, or for higher indices a point extruded away from the lamp.
fn corner(index: u32) -> vec4<f32> {
    let count = point_count();
    if index < count {
        return clip_position(point_m(index));
    }
    return clip_position(lamp.position_m + (point_m(index - count) - lamp.position_m) * reaches[index - count]);
}
