// The sky: from horizon to zenith, a glow around the sun, concentrated near the horizon, the disc itself,
// and haze below the horizon. Twin of runtime/src/light/sky.rs.
fn sky_color(direction: vec3<f32>) -> vec3<f32> {
    let height = max(direction.y, 0.0);
    let up = 1.0 - exp(-4.0 * height);
    let cos_sun = dot(direction, frame.sun_direction);
    let near_sun = max(0.5 + 0.5 * cos_sun, 0.0);
    let aureole = 0.35 * pow(near_sun, 8.0) * (1.0 - 0.7 * up) + 0.65 * pow(near_sun, 96.0);
    let air = mix(frame.horizon, frame.zenith, up) + frame.glow * aureole;
    let disc = select(0.0, 1.0, cos_sun > frame.sun_cos_radius && direction.y > 0.0);
    let below = smoothstep(0.0, 0.25, -direction.y);
    let depth = 1.0 - 0.45 * smoothstep(0.0, 1.0, -direction.y);
    return mix(air, frame.haze * depth, below) + frame.sun_light * (8.0 * disc);
}
