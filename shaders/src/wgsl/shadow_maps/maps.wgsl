// A view's shadow maps.
struct ShadowMaps {
    maps: array<ShadowMap, MOST_SHADOW_MAPS>,
    count: u32,
}

@group(3) @binding(0) var<uniform> shadow_maps: ShadowMaps;
@group(3) @binding(1) var shadow_depths: texture_depth_2d_array;
