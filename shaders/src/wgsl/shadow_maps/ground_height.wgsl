// What lies below the ground casts nothing on it.
fn height_above_ground(position_m: vec3<f32>) -> f32 {
    return position_m.y - shadow_map.ground_height_m;
}
