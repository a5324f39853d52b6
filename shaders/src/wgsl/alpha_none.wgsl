// A surface without holes.
fn cut_away(varyings: Varyings) {}
