// Volumes whose corners the CPU has listed.
@vertex
fn volume_vertex(@builtin(vertex_index) index: u32) -> @builtin(position) @invariant vec4<f32> {
    return corner(index);
}
