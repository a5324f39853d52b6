// Shadow tracks: the times of one occluder are blended over the four texels, then what all of them hide is added up.
// Twin of bake/src/tracks/evaluate.rs, where it is explained.

// For each texel 64 times the index of its first span, plus how many it has.
@group(1) @binding(8) var list_map: texture_2d_array<u32>;
// Spans, row after row and slice after slice: the number of the track, and codes of its start and end.
@group(1) @binding(9) var track_map: texture_2d_array<u32>;
@group(1) @binding(10) var shade_map: texture_2d_array<u32>;

const SPAN_CODES: f32 = 65535.0;
// Numbers from here on are of merged shade, and no track's.
const FIRST_MERGED: u32 = 65284u;
// More than any number.
const NO_TRACK: u32 = 65536u;
// Visibility that is left by rounding, and is none.
const ROUNDING: f32 = 1e-5;

// Parts of the sun's width, three times four.
const PARTS: f32 = 12.0;

// The sun's width in parts, and how much of each is hidden. Codes are counted from where they begin: far from
// it, codes are as coarse as f32.
struct Parts {
    // Of a part.
    width: f32,
    // Where the first begins, in codes.
    start: f32,
    first: vec4<f32>,
    middle: vec4<f32>,
    last: vec4<f32>,
}

struct Place {
    texel: vec2<u32>,
    slice: u32,
}

fn span_place(index: u32) -> Place {
    let size = textureDimensions(track_map);
    let row = index / size.x;
    return Place(vec2<u32>(index % size.x, row % size.y), row / size.y);
}

// The track of the next of a texel's spans, which are those from `list.x` up to `list.y`.
fn next_track(list: vec2<u32>) -> u32 {
    if list.x >= list.y {
        return NO_TRACK;
    }
    let place = span_place(list.x);
    return textureLoad(track_map, place.texel, place.slice, 0).x;
}

fn shade_of(span: u32) -> vec2<f32> {
    let place = span_place(span);
    return vec2<f32>(textureLoad(shade_map, place.texel, place.slice, 0).xy);
}

// Hides what lies between two codes.
fn hide(parts: ptr<function, Parts>, shade: vec2<f32>, weight: f32) {
    let width = (*parts).width;
    // Most shade is at other times.
    if shade.y <= 0.0 || shade.x >= PARTS * width {
        return;
    }
    let start = width * vec4<f32>(0.0, 1.0, 2.0, 3.0);
    (*parts).first += weight * hidden(shade, start, width);
    (*parts).middle += weight * hidden(shade, start + 4.0 * width, width);
    (*parts).last += weight * hidden(shade, start + 8.0 * width, width);
}

// How much shade lies in four parts of a width.
fn hidden(shade: vec2<f32>, start: vec4<f32>, width: f32) -> vec4<f32> {
    return max(min(vec4<f32>(shade.y), start + width) - max(vec4<f32>(shade.x), start), vec4<f32>(0.0));
}

fn list_of(texel: vec2<i32>) -> vec2<u32> {
    let list = textureLoad(list_map, texel, 0, 0).x;
    return vec2<u32>(list >> 6u, (list >> 6u) + (list & 63u));
}

// What the sharp filter blends of a texel with this list of merged shade.
fn merged_sample(list: vec2<u32>, parts: Parts) -> vec3<f32> {
    let width = PARTS * parts.width;
    let middle = 0.5 * width;
    let reach = SHARP_REACH * width;
    // There is no sun before and after the path.
    var hidden = max(-parts.start, 0.0) + max(parts.start + width - SPAN_CODES, 0.0);
    var depth = -reach;
    for (var span = list.x; span < list.y; span++) {
        let codes = shade_of(span);
        let shade = codes - parts.start;
        hidden += max(min(shade.y, width) - max(shade.x, 0.0), 0.0);
        let after_start = select(middle - shade.x, reach, codes.x == 0.0);
        let before_end = select(shade.y - middle, reach, codes.y == SPAN_CODES);
        depth = max(depth, min(after_start, before_end));
    }
    return edge_sample_of(max(1.0 - hidden / width, 0.0), -min(depth, reach) / width);
}

fn tracked(at: Footprint, weights: vec4<f32>) -> f32 {
    let width = max(frame.width_t * SPAN_CODES, 1.0);
    let none = vec4<f32>(0.0);
    var parts = Parts(width / PARTS, frame.t * SPAN_CODES - 0.5 * width, none, none, none);
    var lists = array<vec2<u32>, 4>();
    var tracks = array<u32, 4>();
    var without = vec4<f32>(0.0);
    for (var k = 0; k < 4; k++) {
        // What does not count is not read.
        if weights[k] > 0.0 {
            lists[k] = list_of(texel_of(at, k));
        }
        tracks[k] = next_track(lists[k]);
        without[k] = select(0.0, weights[k], tracks[k] >= FIRST_MERGED);
    }
    let sum = dot(weights, vec4<f32>(1.0));
    let without_sum = dot(without, vec4<f32>(1.0));
    var seen = 0.0;
    if without_sum > 0.0 {
        var blended = vec3<f32>(0.0);
        for (var k = 0; k < 4; k++) {
            if without[k] > 0.0 {
                blended += without[k] / without_sum * merged_sample(lists[k], parts);
            }
        }
        seen = without_sum * sharpened(blended);
    }
    if without_sum < sum {
        seen += (sum - without_sum) / sum * seen_beside_tracks(lists, tracks, weights, parts);
    }
    return select(seen, 0.0, seen < ROUNDING);
}

// The share of the sun that is seen beside the union of blended tracks, times the sum of weights.
fn seen_beside_tracks(all: array<vec2<u32>, 4>, first: array<u32, 4>, weights: vec4<f32>, window: Parts) -> f32 {
    var lists = all;
    var tracks = first;
    var parts = window;
    let sum = dot(weights, vec4<f32>(1.0));
    let width = PARTS * parts.width;
    // There is no sun before and after the path.
    hide(&parts, vec2<f32>(0.0, -parts.start), sum);
    hide(&parts, vec2<f32>(SPAN_CODES - parts.start, width), sum);
    loop {
        let track = min(min(tracks[0], tracks[1]), min(tracks[2], tracks[3]));
        if track == NO_TRACK {
            break;
        }
        var weight = 0.0;
        var shade = vec2<f32>(0.0);
        for (var k = 0; k < 4; k++) {
            if tracks[k] == track {
                weight += weights[k];
                shade += weights[k] * shade_of(lists[k].x);
                lists[k].x++;
                tracks[k] = next_track(lists[k]);
            }
        }
        hide(&parts, shade / weight - parts.start, weight);
    }
    let whole = vec4<f32>(sum * parts.width);
    let none = vec4<f32>(0.0);
    let open = max(whole - parts.first, none) + max(whole - parts.middle, none) + max(whole - parts.last, none);
    return dot(open, vec4<f32>(1.0)) / width;
}

fn page_visibility(page_uv: vec2<f32>) -> f32 {
    let at = footprint(page_uv, textureDimensions(list_map));
    let share = reach(at);
    if !share.takes_darkest {
        return tracked(at, share.weights);
    }
    let above = min(tracked(at, vec4<f32>(1.0, 0.0, 0.0, 0.0)), tracked(at, vec4<f32>(0.0, 1.0, 0.0, 0.0)));
    let below = min(tracked(at, vec4<f32>(0.0, 0.0, 1.0, 0.0)), tracked(at, vec4<f32>(0.0, 0.0, 0.0, 1.0)));
    return min(above, below);
}
