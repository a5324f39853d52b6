// The depth pass of surfaces with holes; the others need no fragment stage.
@fragment
fn depth_fragment(varyings: Varyings) {
    cut_away(varyings);
}
