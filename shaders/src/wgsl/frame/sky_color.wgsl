// The sky: the air, the sun's disc, and haze below the horizon. Twin of runtime/src/light/sky.rs.
fn sky_color(direction: vec3<f32>) -> vec3<f32> {
    let cos_sun = dot(direction, frame.sun_direction);
    let disc = select(0.0, 1.0, cos_sun > frame.sun_cos_radius && direction.y > 0.0);
    let below = smoothstep(0.0, 0.25, -direction.y);
    let depth = 1.0 - 0.45 * smoothstep(0.0, 1.0, -direction.y);
    return mix(air_color(direction), frame.haze * depth, below) + frame.sun_light * (8.0 * disc);
}
