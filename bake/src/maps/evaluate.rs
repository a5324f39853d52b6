//! Soft visibility from stored codes: the CPU twin of `soft_visibility` in `shaders/src/soft_visibility.wgsl`, with the
//! same names in the same order.
//!
//! The sun's disc, while it crosses a shadow's edge, is taken as a line along its path (the chapter's linear light):
//! `soft(t) = 1/w * length(lit ∩ [t - w/2, t + w/2])`, w being the sun's width in t.

use super::{Bits, LayerMaps};

/// Share of the sun that a texel sees at `t`, in [0, 1].
///
/// `width_t` is the sun's width in path time ([`crate::sun::SunPath::width_t`]); widths of less than one code step are
/// widened to one, since the codes know no better.
pub fn soft_visibility(layers: &[LayerMaps], texel: usize, bits: Bits, t: f32, width_t: f32) -> f32 {
    let max_code = f32::from(bits.max_code());
    let width_codes = (width_t * max_code).max(1.0);
    let window_start = t * max_code - 0.5 * width_codes;
    let window_end = t * max_code + 0.5 * width_codes;
    let mut lit_codes = 0.0;
    for layer in layers {
        for c in 0..4 {
            let rise = f32::from(layer.rise[texel][c]).max(window_start);
            let fall = f32::from(layer.fall[texel][c]).min(window_end);
            lit_codes += (fall - rise).max(0.0);
        }
    }
    (lit_codes / width_codes).min(1.0)
}
