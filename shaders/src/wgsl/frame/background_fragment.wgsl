// Visibility where there is no surface.
@fragment
fn background_fragment() -> @location(0) vec4<f32> {
    return vec4<f32>(1.0);
}
