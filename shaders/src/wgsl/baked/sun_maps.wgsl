// Times at which texels see the sun: one slice per layer of each lane.
@group(1) @binding(0) var rise_map: texture_2d_array<u32>;
@group(1) @binding(1) var fall_map: texture_2d_array<u32>;
