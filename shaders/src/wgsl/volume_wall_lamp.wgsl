const WALL_CORNERS: u32 = 6u;

// The corners of a wall in the order of `silhouettes.rs`.
fn wall_corner(wall: Wall, k: u32, is_along: bool) -> u32 {
    let thrown = point_count();
    let low_thrown = thrown + wall.low;
    let high_thrown = thrown + wall.high;
    var along = array<u32, 6>(wall.high, wall.low, low_thrown, wall.high, low_thrown, high_thrown);
    var against = array<u32, 6>(wall.high, low_thrown, wall.low, wall.high, high_thrown, low_thrown);
    return select(against[k], along[k], is_along);
}

@vertex
fn dark_cap_vertex(@builtin(vertex_index) index: u32) -> @builtin(position) @invariant vec4<f32> {
    return cap_corner(index, 1u);
}
