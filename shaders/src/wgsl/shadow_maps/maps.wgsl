// A view's shadow maps.
struct ShadowMaps {
    views: array<ShadowView, MOST_SHADOW_VIEWS>,
    count: u32,
}

@group(3) @binding(0) var<uniform> shadow_maps: ShadowMaps;
@group(3) @binding(1) var shadow_depths: texture_depth_2d_array;
