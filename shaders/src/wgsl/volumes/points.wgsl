// Points of the casters, three numbers each.
@group(1) @binding(0) var<storage, read> points: array<f32>;

fn point_count() -> u32 {
    return arrayLength(&points) / 3u;
}

fn point_m(index: u32) -> vec3<f32> {
    return vec3<f32>(points[3u * index], points[3u * index + 1u], points[3u * index + 2u]);
}
