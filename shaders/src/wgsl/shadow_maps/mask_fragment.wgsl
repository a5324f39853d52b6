// A caster in a mask of casters on the ground: 0, however many overlap. Nothing below the ground casts on it.
@fragment
fn mask_fragment(varyings: Varyings) -> @location(0) vec4<f32> {
    test_alpha(varyings);
    if varyings.height_m < 0.0 {
        discard;
    }
    return vec4<f32>(0.0);
}
