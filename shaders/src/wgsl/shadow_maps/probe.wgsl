// Two texels, one of depth 0 and one of depth 1, and what a sampler makes of a comparison halfway between them.
@vertex
fn probe_vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    let corner = vec2<f32>(f32((index << 1u) & 2u), f32(index & 2u));
    return vec4<f32>(corner * 2.0 - 1.0, 1.0, 1.0);
}

@group(0) @binding(0) var probed: texture_depth_2d_array;
@group(0) @binding(1) var probed_sampler: sampler_comparison;
@group(0) @binding(2) var<storage, read_write> found: array<f32, 1>;

@compute @workgroup_size(1)
fn probe() {
    found[0] = textureSampleCompareLevel(probed, probed_sampler, vec2<f32>(0.5, 0.5), 0, 0.5);
}
