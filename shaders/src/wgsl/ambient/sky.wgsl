// The sky of the moment in spherical harmonics, times each texel's visibility of each. Three coefficients per slice,
// three slices per side.
struct Sky {
    coefficients: array<vec4<f32>, 9>,
}

@group(0) @binding(3) var<uniform> sky: Sky;
@group(1) @binding(6) var sky_map: texture_2d_array<u32>;

fn sky_light_at(texel: vec2<i32>, side: i32) -> vec3<f32> {
    var light = vec3<f32>(0.0);
    for (var k = 0; k < 3; k++) {
        let codes = vec4<f32>(textureLoad(sky_map, texel, 3 * side + k, 0));
        let visibility = (codes - 32768.0) / 32767.0;
        light += sky.coefficients[3 * k].xyz * visibility.x;
        light += sky.coefficients[3 * k + 1].xyz * visibility.y;
        light += sky.coefficients[3 * k + 2].xyz * visibility.z;
    }
    return light;
}

fn ambient_light(page_uv: vec2<f32>, normal: vec3<f32>, side: i32) -> vec3<f32> {
    let at = footprint(page_uv, textureDimensions(sky_map));
    let upper_left = sky_light_at(texel_of(at, 0), side);
    let upper_right = sky_light_at(texel_of(at, 1), side);
    let lower_left = sky_light_at(texel_of(at, 2), side);
    let lower_right = sky_light_at(texel_of(at, 3), side);
    return max(blended_colors(at, upper_left, upper_right, lower_left, lower_right), vec3<f32>(0.0));
}
