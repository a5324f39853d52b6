// Times at which texels see the lamp: one slice per layer.
@group(1) @binding(3) var lamp_rise_map: texture_2d_array<u32>;
@group(1) @binding(4) var lamp_fall_map: texture_2d_array<u32>;
