// A caster in a picture of what casts on the ground: black, however many lie over one another.
@fragment
fn mask_fragment(varyings: Varyings) -> @location(0) vec4<f32> {
    cut_away(varyings);
    if varyings.height_m < 0.0 {
        discard;
    }
    return vec4<f32>(0.0);
}
