// The depth pass of surfaces with alpha masks; the others need no fragment stage.
@fragment
fn depth_fragment(varyings: Varyings) {
    test_alpha(varyings);
}
