//! Visibility at a point between texels, from their tracks. Twin of `shaders/src/wgsl/baked/sun_tracks.wgsl`.
//!
//! The sun's width in time is cut into [`PARTS`]. Each track hides a share of each part; a track that only some of the
//! four texels have counts by their weights. What hides a part is added up, and hides no more than all of it: the union
//! of occluders.

use super::{PageTracks, TrackSpan};
use crate::atlas::Footprint;
use crate::maps::Bits;

/// Parts of the sun's width.
const PARTS: usize = 8;
/// Visibility that is left by rounding, and is none.
const ROUNDING: f32 = 1e-5;

/// Share of the sun that a point sees at `t`, in [0, 1]: see [`crate::maps::soft_visibility`] for the sun's width.
pub fn tracked_visibility(tracks: &PageTracks, footprint: &Footprint, t: f32, width_t: f32) -> f32 {
    let spans = footprint.texels.map(|texel| tracks.of_texel(texel));
    match footprint.blend_weights() {
        Some(weights) => blended(spans, weights, t, width_t),
        None => {
            let alone = spans.map(|own| blended([own, &[], &[], &[]], [1.0, 0.0, 0.0, 0.0], t, width_t));
            alone.into_iter().fold(1.0, f32::min)
        }
    }
}

/// The same of four lists of spans, which count by weights.
pub(super) fn blended(spans: [&[TrackSpan]; 4], weights: [f32; 4], t: f32, width_t: f32) -> f32 {
    let max_code = f32::from(Bits::Sixteen.max_code());
    let width_codes = (width_t * max_code).max(1.0);
    let window_start = t * max_code - 0.5 * width_codes;
    let part_codes = width_codes / PARTS as f32;
    let mut hidden = [0.0f32; PARTS];
    let mut hide = |start: f32, end: f32, weight: f32| {
        for (part, hidden) in hidden.iter_mut().enumerate() {
            // From the window's start: far from it, codes are as coarse as `f32`.
            let from = part as f32 * part_codes;
            *hidden += weight * (end.min(from + part_codes) - start.max(from)).max(0.0);
        }
    };
    let sum: f32 = weights.iter().sum();
    // There is no sun before and after the path.
    hide(f32::NEG_INFINITY, -window_start, sum);
    hide(max_code - window_start, f32::INFINITY, sum);
    let mut rest = spans;
    for (spans, weight) in rest.iter_mut().zip(weights) {
        if weight <= 0.0 {
            *spans = &[];
        }
    }
    while let Some(track) = rest.iter().filter_map(|spans| Some(spans.first()?.track)).min() {
        let (mut weight, mut start, mut end) = (0.0f32, 0.0f32, 0.0f32);
        for (spans, own) in rest.iter_mut().zip(weights) {
            if let Some((span, others)) = spans.split_first().filter(|(span, _)| span.track == track) {
                weight += own;
                start += own * f32::from(span.start);
                end += own * f32::from(span.end);
                *spans = others;
            }
        }
        hide(start / weight - window_start, end / weight - window_start, weight);
    }
    let open: f32 = hidden.iter().map(|hidden| (sum * part_codes - hidden).max(0.0)).sum();
    let seen = open / width_codes;
    if seen < ROUNDING { 0.0 } else { seen }
}
