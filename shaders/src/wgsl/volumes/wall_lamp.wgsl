const WALL_CORNERS: u32 = 6u;

// The corners of a wall in the order of `silhouettes.rs`.
fn wall_corner(wall: Wall, k: u32, is_along: bool) -> u32 {
    let extruded = point_count();
    let low_extruded = extruded + wall.low;
    let high_extruded = extruded + wall.high;
    var along = array<u32, 6>(wall.high, wall.low, low_extruded, wall.high, low_extruded, high_extruded);
    var against = array<u32, 6>(wall.high, low_extruded, wall.low, wall.high, high_extruded, low_extruded);
    return select(against[k], along[k], is_along);
}

@vertex
fn dark_cap_vertex(@builtin(vertex_index) index: u32) -> @builtin(position) @invariant vec4<f32> {
    return cap_corner(index, 1u);
}
