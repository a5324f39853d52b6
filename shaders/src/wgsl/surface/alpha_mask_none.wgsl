// A surface without an alpha mask.
fn test_alpha(varyings: Varyings) {}
