// The four texels around a page coordinate, and how much of each: (1 - weight) of the low ones, weight of the high
// ones.
struct Footprint {
    low: vec2<i32>,
    high: vec2<i32>,
    weight: vec2<f32>,
}

fn footprint(page_uv: vec2<f32>, size: vec2<u32>) -> Footprint {
    let last = vec2<i32>(size) - 1;
    let place = page_uv * vec2<f32>(last + 1) - 0.5;
    let base = floor(place);
    let low = clamp(vec2<i32>(base), vec2<i32>(0), last);
    let high = clamp(vec2<i32>(base) + 1, vec2<i32>(0), last);
    return Footprint(low, high, place - base);
}

// Texels of a footprint, counted along rows.
fn texel_of(at: Footprint, k: i32) -> vec2<i32> {
    return vec2<i32>(select(at.low.x, at.high.x, (k & 1) == 1), select(at.low.y, at.high.y, k >= 2));
}

// The texel that holds a page coordinate.
fn texel_at(page_uv: vec2<f32>, size: vec2<u32>) -> vec2<i32> {
    let last = vec2<i32>(size) - 1;
    return clamp(vec2<i32>(floor(page_uv * vec2<f32>(last + 1))), vec2<i32>(0), last);
}
