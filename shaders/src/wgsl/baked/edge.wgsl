// What the sharp filter makes of an edge. Twin of bake/src/maps/evaluate.rs, where it is explained.

const SHARP_REACH: f32 = 16.0;

fn ramp(distance: f32) -> f32 {
    return clamp(0.5 + distance, 0.0, 1.0);
}

fn edge_sample_of(visibility: f32, distance_widths: f32) -> vec3<f32> {
    return vec3<f32>(visibility, distance_widths + SHARP_REACH, ramp(distance_widths));
}

fn sharpened(blended: vec3<f32>) -> f32 {
    return clamp(blended.x + ramp(blended.y - SHARP_REACH) - blended.z, 0.0, 1.0);
}
