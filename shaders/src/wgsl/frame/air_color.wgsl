// The sky above the horizon, without the sun's disc: from horizon to zenith, and a glow around the sun, concentrated
// near the horizon. Twin of runtime/src/light/sky.rs.
fn air_color(direction: vec3<f32>) -> vec3<f32> {
    let height = max(direction.y, 0.0);
    let up = 1.0 - exp(-4.0 * height);
    let cos_sun = dot(direction, frame.sun_direction);
    let near_sun = max(0.5 + 0.5 * cos_sun, 0.0);
    let aureole = 0.35 * pow(near_sun, 8.0) * (1.0 - 0.7 * up) + 0.65 * pow(near_sun, 96.0);
    return mix(frame.horizon, frame.zenith, up) + frame.glow * aureole;
}
