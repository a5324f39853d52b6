// How the four texels of a footprint count, in the order of `texel_of`: nothing stands between them.
struct Reach {
    weights: vec4<f32>,
    takes_darkest: bool,
}

fn reach(footprint: Footprint) -> Reach {
    let at = footprint.weight;
    let back = 1.0 - at;
    return Reach(vec4<f32>(back.x * back.y, at.x * back.y, back.x * at.y, at.x * at.y), false);
}
