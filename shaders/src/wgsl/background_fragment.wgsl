// Where there is no surface there is nothing to be shaded.
@fragment
fn background_fragment() -> @location(0) vec4<f32> {
    return vec4<f32>(1.0);
}
