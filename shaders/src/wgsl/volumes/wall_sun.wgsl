const WALL_CORNERS: u32 = 3u;

// The corners of a wall in the order of `silhouettes.rs`.
fn wall_corner(wall: Wall, k: u32, is_along: bool) -> u32 {
    if k == 0u {
        return wall.high;
    }
    return select(point_count(), wall.low, (k == 1u) == is_along);
}
