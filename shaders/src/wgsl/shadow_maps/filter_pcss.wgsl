// A filter as wide as the penumbra (Fernando, "Percentage-closer soft shadows", 2005), after the sun's true size: a
// blocker that is d away hides as much of the disc as of a circle with radius d tan(sun's radius) around the place
// looked up.
//
// Texels are looked at on a spiral of golden angles (Vogel, 1979), turned differently at each pixel by interleaved
// gradient noise (Jimenez, "Next generation post processing in Call of Duty", SIGGRAPH 2014).

const BLOCKER_TAPS: u32 = 24u;
// Of these so many look at the nearest texels: beside a wide search, what stands right before the receiver is small.
const NEAR_TAPS: u32 = 6u;
const FILTER_TAPS: u32 = 32u;
const GOLDEN_ANGLE_RAD: f32 = 2.3999632;
// Narrower than this a filter is the sampler's own.
const LEAST_RADIUS_TEXELS: f32 = 0.75;

fn on_spiral(i: u32, count: u32, turn_rad: f32) -> vec2<f32> {
    let angle_rad = f32(i) * GOLDEN_ANGLE_RAD + turn_rad;
    return sqrt((f32(i) + 0.5) / f32(count)) * vec2<f32>(cos(angle_rad), sin(angle_rad));
}

// Moves places on the surface's own side to the other: a ray that leaves there meets the surface, and how much of the
// sun's disc that hides is known without looking.
fn off_surface(at: Receiver, place: vec2<f32>) -> vec2<f32> {
    return place - 2.0 * min(dot(place, at.outward), 0.0) * at.outward;
}

// Mean distance of what lies between the receiver and some of the sun, in metres along the light; negative where
// nothing does.
fn blocker_distance_m(at: Receiver, slope: f32, metres_per_depth: f32, turn_rad: f32) -> f32 {
    let size = f32(textureDimensions(shadow_depths).x);
    let texel_m = max(at.metres_per_uv.x, at.metres_per_uv.y) / size;
    let reach_m = max(at.depth * metres_per_depth * slope, 1.5 * texel_m);
    var sum_m = 0.0;
    var count = 0.0;
    for (var i = 0u; i < BLOCKER_TAPS; i++) {
        var place = on_spiral(i, NEAR_TAPS, turn_rad) * 1.5 * texel_m;
        if i >= NEAR_TAPS {
            place = on_spiral(i - NEAR_TAPS, BLOCKER_TAPS - NEAR_TAPS, turn_rad) * reach_m;
        }
        let offset_m = off_surface(at, place);
        let texel = clamp(floor((at.uv + offset_m / at.metres_per_uv) * size), vec2<f32>(0.0), vec2<f32>(size - 1.0));
        let stored = textureLoad(shadow_depths, vec2<i32>(texel), at.map, 0);
        let in_front_m = (depth_at(at, (texel + 0.5) / size) - stored) * metres_per_depth;
        // What stands beside the cone of the sun's rays hides none of them.
        if in_front_m > 0.0 && length(offset_m) <= in_front_m * slope + 1.5 * texel_m {
            sum_m += in_front_m;
            count += 1.0;
        }
    }
    return select(-1.0, sum_m / count, count > 0.0);
}

fn shadow_filter(at: Receiver, pixel: vec2<f32>) -> f32 {
    let turn_rad = 6.2831853 * fract(52.9829189 * fract(dot(pixel, vec2<f32>(0.06711056, 0.00583715))));
    let slope = tan(0.5 / frame.inverse_angular_diameter);
    let metres_per_depth = -1.0 / shadow_maps.maps[at.map].z_per_metre;
    let distance_m = blocker_distance_m(at, slope, metres_per_depth, turn_rad);
    if distance_m < 0.0 {
        return 1.0;
    }
    let size = f32(textureDimensions(shadow_depths).x);
    let radius_texels = max(distance_m * slope / at.metres_per_uv * size, vec2<f32>(LEAST_RADIUS_TEXELS));
    var lit = 0.0;
    for (var i = 0u; i < FILTER_TAPS; i++) {
        lit += shadow_tap(at, off_surface(at, on_spiral(i, FILTER_TAPS, turn_rad)) * radius_texels);
    }
    return lit / f32(FILTER_TAPS);
}
