// Projects a vertex along the sun's rays onto the ground, and from there to the camera. Coordinates are homogeneous:
// under a sun at the horizon the point lies at infinity.
@group(1) @binding(0) var<uniform> shadow_map: ShadowMap;

// A sun lower than this counts as this high: a fifth of an arc second.
const LEAST_SLANT: f32 = 1e-6;

fn clip_position(position_m: vec3<f32>) -> vec4<f32> {
    let sun = vec3<f32>(frame.sun_direction.x, max(frame.sun_direction.y, LEAST_SLANT), frame.sun_direction.z);
    let from_eye = (position_m - frame.eye_m) * sun.y - sun * height_above_ground(position_m);
    return frame.clip_from_eye * vec4<f32>(from_eye, sun.y);
}
