// What a face behind the surface adds to the count of volumes that hold the surface.
@fragment
fn volume_count_fragment(@builtin(front_facing) is_front: bool) -> @location(0) vec4<f32> {
    return vec4<f32>(select(1.0, -1.0, is_front), 0.0, 0.0, 0.0);
}
