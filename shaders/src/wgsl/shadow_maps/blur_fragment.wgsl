// One direction of a binomial blur over nine texels, of a mask of casters.
@group(0) @binding(0) var blurred: texture_2d<f32>;

fn blurred_along(pixel: vec2<f32>, step: vec2<i32>) -> vec4<f32> {
    let last = vec2<i32>(textureDimensions(blurred)) - 1;
    var weights = array<f32, 5>(70.0, 56.0, 28.0, 8.0, 1.0);
    var sum = 0.0;
    for (var i = -4; i <= 4; i++) {
        let texel = clamp(vec2<i32>(pixel) + step * i, vec2<i32>(0), last);
        sum += weights[abs(i)] * textureLoad(blurred, texel, 0).r;
    }
    return vec4<f32>(sum / 256.0);
}

@fragment
fn blur_across_fragment(@builtin(position) pixel: vec4<f32>) -> @location(0) vec4<f32> {
    return blurred_along(pixel.xy, vec2<i32>(1, 0));
}

@fragment
fn blur_down_fragment(@builtin(position) pixel: vec4<f32>) -> @location(0) vec4<f32> {
    return blurred_along(pixel.xy, vec2<i32>(0, 1));
}
