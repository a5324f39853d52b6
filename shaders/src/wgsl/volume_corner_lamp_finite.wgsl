// How many times as far from the lamp as each point its volume ends: beyond the lamp's range.
@group(1) @binding(1) var<storage, read> reaches: array<f32>;

// A corner of a volume: one of the points or, beyond them, one of them extruded away from the lamp.
fn corner(index: u32) -> vec4<f32> {
    let count = point_count();
    if index < count {
        return clip_position(point_m(index));
    }
    return clip_position(lamp.position_m + (point_m(index - count) - lamp.position_m) * reaches[index - count]);
}
