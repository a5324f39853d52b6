// An alpha mask. Alpha is read from the nearest texel of the image's first level: twin of bake/src/scene/alpha.rs, so
// that pictures, shadows and rays agree where a leaf ends.

fn wrap_texel(index: i32, size: i32, wrap: u32) -> i32 {
    if wrap == WRAP_CLAMP {
        return clamp(index, 0, size - 1);
    }
    let period = select(size, 2 * size, wrap == WRAP_MIRROR);
    let folded = ((index % period) + period) % period;
    return select(folded, min(folded, period - 1 - folded), wrap == WRAP_MIRROR);
}

fn test_alpha(varyings: Varyings) {
    let material = materials[varyings.material];
    let alpha = material.base_color.a * vertex_color(varyings).a * texel_alpha(varyings, material);
    if alpha < material.cutoff {
        discard;
    }
}
