// From bake space to a shadow map.
@group(1) @binding(0) var<uniform> shadow_map: ShadowMap;

fn clip_position(position_m: vec3<f32>) -> vec4<f32> {
    return shadow_map.clip_from_point * vec4<f32>(position_m - shadow_map.origin_m, 1.0);
}
