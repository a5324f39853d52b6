// One for every pixel of every face.
@fragment
fn volume_fill_fragment() -> @location(0) vec4<f32> {
    return vec4<f32>(1.0, 0.0, 0.0, 0.0);
}
