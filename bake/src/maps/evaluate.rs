//! Visibility from stored codes: the CPU twins of `soft_visibility.wgsl`, `hard_visibility.wgsl` and `edge_sample.wgsl`
//! in `shaders/src/wgsl/baked`, with the same names in the same order.
//!
//! While the sun's disc crosses a shadow's edge it is approximated by a line along its path (linear light). With w the
//! sun's width in t, `soft(t) = 1/w * length(lit ∩ [t - w/2, t + w/2])`.
//!
//! **The sharp filter.** Where a shadow's edge passes between two texels, it passes them at different times, and the
//! time at which it passes a point between them is close to the blend of those two. So the signed distance in time from
//! the nearest edge is blended and evaluated at the point, as signed distances in space are for glyphs (Green,
//! "Improved alpha-tested magnification for vector textures and special effects", SIGGRAPH 2007). What the blend of
//! visibilities knows beyond the nearest edge is kept: `blend(soft) + ramp(blend(d)) - blend(ramp(d))`, with
//! `ramp(d) = d + 1/2` between 0 and 1. At a texel's centre that is `soft`; it is continuous in time and across texels.
//! Distances are counted from the deepest shade, so that where walls leave no texel to blend, nothing is lit.

use super::{Bits, LayerMaps};
use glam::Vec3;

/// Share of the sun that a texel sees at `t`, in [0, 1].
///
/// `width_t` is the sun's width in path time ([`crate::sun::SunPath::width_t`]); widths of less than one code step are
/// widened to one, which is the precision of the codes.
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

/// Visibility of a sun without width at `t`: 1 from each stored rise to its fall, both included, else 0.
pub fn hard_visibility(layers: &[LayerMaps], texel: usize, bits: Bits, t: f32) -> f32 {
    let now = t * f32::from(bits.max_code());
    for layer in layers {
        for c in 0..4 {
            let rise = f32::from(layer.rise[texel][c]);
            let fall = f32::from(layer.fall[texel][c]);
            if rise <= now && now <= fall {
                return 1.0;
            }
        }
    }
    0.0
}

/// Distance in time beyond which an edge says nothing, in widths of the light.
pub(crate) const SHARP_REACH: f32 = 16.0;

/// Visibility of a lone edge at a signed distance in widths of the light.
fn ramp(distance: f32) -> f32 {
    (0.5 + distance).clamp(0.0, 1.0)
}

/// What the sharp filter blends of a texel: visibility as of [`soft_visibility`], the signed distance in time from the
/// nearest edge in widths of the light (more in light), counted from the deepest shade, and the visibility that this
/// distance alone would mean. The path's ends are no edges.
pub fn edge_sample(layers: &[LayerMaps], texel: usize, bits: Bits, t: f32, width_t: f32) -> Vec3 {
    let max_code = f32::from(bits.max_code());
    let width_codes = (width_t * max_code).max(1.0);
    let now = t * max_code;
    let window_start = now - 0.5 * width_codes;
    let window_end = now + 0.5 * width_codes;
    let reach = SHARP_REACH * width_codes;
    let mut lit_codes = 0.0;
    let mut distance = -reach;
    for layer in layers {
        for c in 0..4 {
            let rise = f32::from(layer.rise[texel][c]);
            let fall = f32::from(layer.fall[texel][c]);
            lit_codes += (fall.min(window_end) - rise.max(window_start)).max(0.0);
            let after_rise = if rise == 0.0 { reach } else { now - rise };
            let before_fall = if fall == max_code { reach } else { fall - now };
            distance = distance.max(after_rise.min(before_fall));
        }
    }
    edge_sample_of((lit_codes / width_codes).min(1.0), distance.min(reach) / width_codes)
}

/// The same of a visibility and a signed distance in widths of the light.
pub(crate) fn edge_sample_of(visibility: f32, distance_widths: f32) -> Vec3 {
    Vec3::new(visibility, distance_widths + SHARP_REACH, ramp(distance_widths))
}

/// Visibility from blended samples of texels.
pub fn sharpened(blended: Vec3) -> f32 {
    (blended.x + ramp(blended.y - SHARP_REACH) - blended.z).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::super::PageEncoder;
    use super::*;
    use crate::visibility::Intervals;

    #[test]
    fn a_sun_without_width_is_seen_from_rise_to_fall_and_as_any_narrow_one_between_edges() {
        let mut page = PageEncoder::new(2, Bits::Sixteen, 2);
        let lit = [[0.0, 0.125], [0.25, 0.5], [0.75, 1.0]];
        page.set(0, &Intervals::from_unsorted(lit.to_vec()));
        let layers = page.finish();
        for i in 0..=1000 {
            let t = i as f32 / 1000.0;
            let seen = hard_visibility(&layers, 0, Bits::Sixteen, t);
            let is_near_edge = lit.as_flattened().iter().any(|edge| (edge - f64::from(t)).abs() < 2.0 / 65_535.0);
            let is_end = i % 1000 == 0;
            assert!(is_near_edge || seen == soft_visibility(&layers, 0, Bits::Sixteen, t, 0.0), "{t}");
            assert!(!is_end || seen == 1.0, "{t}");
            assert_eq!(hard_visibility(&layers, 1, Bits::Sixteen, t), 0.0, "{t}");
        }
    }
}
