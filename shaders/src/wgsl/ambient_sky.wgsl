// The sky of the moment in spherical harmonics, against what a texel sees of each. Three coefficients a slice, and three
// slices for each side.
struct Sky {
    coefficients: array<vec4<f32>, 9>,
}

@group(0) @binding(3) var<uniform> sky: Sky;
@group(1) @binding(6) var sky_map: texture_2d_array<u32>;

fn sky_light_at(texel: vec2<i32>, side: i32) -> vec3<f32> {
    var light = vec3<f32>(0.0);
    for (var k = 0; k < 3; k++) {
        let codes = vec4<f32>(textureLoad(sky_map, texel, 3 * side + k, 0));
        let seen = (codes - 32768.0) / 32767.0;
        light += sky.coefficients[3 * k].xyz * seen.x;
        light += sky.coefficients[3 * k + 1].xyz * seen.y;
        light += sky.coefficients[3 * k + 2].xyz * seen.z;
    }
    return light;
}

fn ambient_light(page_uv: vec2<f32>, normal: vec3<f32>, side: i32) -> vec3<f32> {
    let last = vec2<i32>(textureDimensions(sky_map)) - 1;
    let place = page_uv * vec2<f32>(last + 1) - 0.5;
    let base = floor(place);
    let weight = place - base;
    let low = clamp(vec2<i32>(base), vec2<i32>(0), last);
    let high = clamp(vec2<i32>(base) + 1, vec2<i32>(0), last);
    let top = mix(sky_light_at(low, side), sky_light_at(vec2<i32>(high.x, low.y), side), weight.x);
    let bottom = mix(sky_light_at(vec2<i32>(low.x, high.y), side), sky_light_at(high, side), weight.x);
    return max(mix(top, bottom, weight.y), vec3<f32>(0.0));
}
