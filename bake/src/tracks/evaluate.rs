//! Visibility at a point between texels, from their tracks.
//!
//! The sun's width in time is cut into [`BINS`] parts. Each track hides a share of each part; a track that only some of
//! the four texels have counts by their weights. What hides a part is added up, to one at most: the union of occluders.

use super::TrackSpan;
use crate::maps::Bits;

/// Parts of the sun's width.
const BINS: usize = 8;

/// Four texels around a point.
#[derive(Debug, Clone, Copy)]
pub struct TrackFootprint<'a> {
    /// Their spans.
    pub spans: [&'a [TrackSpan]; 4],
    /// How much each counts. They add up to one.
    pub weights: [f32; 4],
}

/// Share of the sun that a point sees at `t`, in [0, 1]: see [`crate::maps::soft_visibility`] for the sun's width.
pub fn tracked_visibility(footprint: &TrackFootprint, t: f32, width_t: f32) -> f32 {
    let max_code = f32::from(Bits::Sixteen.max_code());
    let width_codes = (width_t * max_code).max(1.0);
    let window_start = t * max_code - 0.5 * width_codes;
    let bin_codes = width_codes / BINS as f32;
    let mut hidden = [0.0f32; BINS];
    let mut hide = |start: f32, end: f32, weight: f32| {
        for (bin, hidden) in hidden.iter_mut().enumerate() {
            let from = window_start + bin as f32 * bin_codes;
            let share = (end.min(from + bin_codes) - start.max(from)) / bin_codes;
            *hidden += weight * share.max(0.0);
        }
    };
    // There is no sun before and after the path.
    hide(f32::NEG_INFINITY, 0.0, 1.0);
    hide(max_code, f32::INFINITY, 1.0);
    let mut rest = footprint.spans;
    while let Some(track) = rest.iter().filter_map(|spans| Some(spans.first()?.track)).min() {
        let (mut weight, mut start, mut end) = (0.0f32, 0.0f32, 0.0f32);
        for (spans, own) in rest.iter_mut().zip(footprint.weights) {
            if let Some((span, others)) = spans.split_first().filter(|(span, _)| span.track == track) {
                weight += own;
                start += own * f32::from(span.start);
                end += own * f32::from(span.end);
                *spans = others;
            }
        }
        if weight > 0.0 {
            hide(start / weight, end / weight, weight);
        }
    }
    let lit: f32 = hidden.iter().map(|hidden| (1.0 - hidden).max(0.0)).sum();
    lit / BINS as f32
}
