//! Visibility at a point between texels, from their tracks. Twin of `shaders/src/wgsl/baked/sun_tracks.wgsl`.
//!
//! The sun's width in time is cut into [`PARTS`]. Each track hides a share of each part; a track that only some of the
//! four texels have counts by their weights. What hides a part is added up, and hides no more than all of it: the union
//! of occluders.
//!
//! Texels without tracks are played back by the sharp filter ([`crate::maps`]), which does best there: merged shade has
//! edges, but no occluders. Where some texels have tracks and others not, both answers count by the texels' weights.

use super::{FIRST_MERGED, PageTracks, TrackSpan};
use crate::atlas::Footprint;
use crate::maps::{SHARP_REACH, edge_sample_of, sharpened};
use glam::Vec3;

/// The code of the path's end.
const MAX_CODE: f32 = u16::MAX as f32;
/// Parts of the sun's width. Where many tracks end at once, what they hide of a part adds up to all of it while they
/// pass a small share of it. So light may change by a part at once, which must not be seen.
const PARTS: usize = 12;
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
fn blended(spans: [&[TrackSpan]; 4], weights: [f32; 4], t: f32, width_t: f32) -> f32 {
    let window = Window::new(t, width_t);
    let has_tracks = spans.map(|own| own.first().is_some_and(|span| u32::from(span.track) < FIRST_MERGED));
    let of_kind =
        |with_tracks: bool| std::array::from_fn(|k| if has_tracks[k] == with_tracks { weights[k] } else { 0.0 });
    let [with, without]: [[f32; 4]; 2] = [true, false].map(of_kind);
    let [with_sum, without_sum] = [with, without].map(|weights| weights.iter().sum::<f32>());
    let mut seen = 0.0;
    if without_sum > 0.0 {
        let samples = spans.iter().zip(without).filter(|(_, weight)| *weight > 0.0);
        let blended: Vec3 = samples.map(|(own, weight)| window.edge_sample(own) * (weight / without_sum)).sum();
        seen += without_sum * sharpened(blended);
    }
    if with_sum > 0.0 {
        seen += with_sum / (with_sum + without_sum) * window.seen_beside_tracks(spans, weights);
    }
    if seen < ROUNDING { 0.0 } else { seen }
}

/// The sun's width around a moment, in codes.
struct Window {
    start: f32,
    width: f32,
}

impl Window {
    fn new(t: f32, width_t: f32) -> Self {
        let width = (width_t * MAX_CODE).max(1.0);
        Self { start: t * MAX_CODE - 0.5 * width, width }
    }

    /// What the sharp filter blends of a texel, as [`crate::maps::edge_sample`] has it, from disjoint spans of shade.
    fn edge_sample(&self, shade: &[TrackSpan]) -> Vec3 {
        let now = self.start + 0.5 * self.width;
        let reach = SHARP_REACH * self.width;
        let end = self.start + self.width;
        // There is no sun before and after the path.
        let mut hidden = (-self.start).max(0.0) + (end - MAX_CODE).max(0.0);
        let mut depth = -reach;
        for span in shade {
            let [from, to] = [span.start, span.end].map(f32::from);
            hidden += (to.min(end) - from.max(self.start)).max(0.0);
            let after_start = if span.start == 0 { reach } else { now - from };
            let before_end = if span.end == u16::MAX { reach } else { to - now };
            depth = depth.max(after_start.min(before_end));
        }
        edge_sample_of((1.0 - hidden / self.width).max(0.0), -depth.min(reach) / self.width)
    }

    /// The share of the sun that is seen beside the union of blended tracks, times the sum of weights.
    fn seen_beside_tracks(&self, spans: [&[TrackSpan]; 4], weights: [f32; 4]) -> f32 {
        let part_codes = self.width / PARTS as f32;
        let mut hidden = [0.0f32; PARTS];
        let mut hide = |start: f32, end: f32, weight: f32| {
            // Most shade is at other times.
            if end <= 0.0 || start >= self.width {
                return;
            }
            for (part, hidden) in hidden.iter_mut().enumerate() {
                // From the window's start: far from it, codes are as coarse as `f32`.
                let from = part as f32 * part_codes;
                *hidden += weight * (end.min(from + part_codes) - start.max(from)).max(0.0);
            }
        };
        let sum: f32 = weights.iter().sum();
        // There is no sun before and after the path.
        hide(f32::NEG_INFINITY, -self.start, sum);
        hide(MAX_CODE - self.start, f32::INFINITY, sum);
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
            hide(start / weight - self.start, end / weight - self.start, weight);
        }
        let open: f32 = hidden.iter().map(|hidden| (sum * part_codes - hidden).max(0.0)).sum();
        open / self.width
    }
}
