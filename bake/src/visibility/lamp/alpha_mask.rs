//! Which part of an occluded span an alpha-masked triangle really occludes.
//!
//! While the lamp moves along its segment, the point where its ray pierces the triangle moves along a straight line of
//! the triangle's plane, and the texture coordinate there is `sum(w_i uv_i) / sum(w_i)`, the weights w_i being the
//! products of the edge normals with the lamp: all linear in s. A border between two columns of texels,
//! `u = k / width`, is crossed where `sum(w_i (u_i width - k)) = 0`, a linear condition. So the line is followed from
//! texel to texel, and no texel is skipped except those that are crossed in less than [`LEAST_STEP`]. Squares of texels
//! that are solid or clear throughout are crossed in one step. In a texel where the corners' own alphas matter, alpha
//! passes the cutoff at one root more.
//!
//! The sun's version, along a curve, is `exact/alpha_mask.rs`.

use super::hide::SegmentFromPoint;
use super::span::{Span, common, not_negative};
use crate::trace::MaskedTriangle;
use glam::DVec3;
use smallvec::SmallVec;

/// Smallest step along the segment.
const LEAST_STEP: f64 = 1e-10;
/// Most steps that one triangle is followed for; they grow where there would be more.
const MOST_STEPS: f64 = 65_536.0;

/// Solid spans; usually few.
pub(super) type SolidSpans = SmallVec<[Span; 8]>;

/// An alpha-masked triangle, seen from a point along a segment. Each pair holds values at the segment's two ends.
pub(super) struct MaskedTriangleView<'a> {
    mask: MaskedTriangle<'a>,
    /// For each corner, its weight.
    weights: [[f64; 2]; 3],
    /// Their sum, and their sums weighted by each texture coordinate.
    total: [f64; 2],
    along: [[f64; 2]; 2],
}

impl<'a> MaskedTriangleView<'a> {
    /// From the corners relative to the point.
    pub fn new(mask: MaskedTriangle<'a>, segment: &SegmentFromPoint, [a, b, c]: [DVec3; 3]) -> Self {
        let weights = [b.cross(c), c.cross(a), a.cross(b)].map(|n| segment.along(n));
        let along = [mask.texel_uvs.map(|uv| uv.x), mask.texel_uvs.map(|uv| uv.y)].map(|uvs| blend(weights, uvs));
        Self { total: blend(weights, [1.0; 3]), along, weights, mask }
    }

    /// Adds the solid parts of a span on which the triangle is pierced.
    pub fn solid_parts(&self, [start, end]: Span, parts: &mut SolidSpans) {
        let least_step = ((end - start) / MOST_STEPS).max(LEAST_STEP);
        let mut at = start;
        while at < end {
            let texel = self.texel((at + least_step).min(0.5 * (at + end)));
            let (square, verdict) = self.mask.uniform(texel);
            let next = if self.mask.has_texture() { self.next_border(square, at + least_step, end) } else { end };
            match verdict {
                Some(true) => join(parts, [at, next]),
                Some(false) => {}
                None => self.solid_in_texel(texel, [at, next], parts),
            }
            at = next;
        }
    }

    /// The texel that is pierced at `s`.
    fn texel(&self, s: f64) -> [i64; 2] {
        let total = at(self.total, s);
        self.along.map(|along| (at(along, s) / total).floor().clamp(-1e9, 1e9) as i64)
    }

    /// Where the line first leaves the square after `from`, or `end`.
    fn next_border(&self, square: [[i64; 2]; 2], from: f64, end: f64) -> f64 {
        let mut next = end;
        for (along, borders) in self.along.iter().zip(square) {
            for border in borders.map(|border| border as f64) {
                let [first, last] = [0, 1].map(|k| along[k] - self.total[k] * border);
                let crossing = first / (first - last);
                if from <= crossing && crossing < next {
                    next = crossing;
                }
            }
        }
        next
    }

    fn solid_in_texel(&self, texel: [i64; 2], span: Span, parts: &mut SolidSpans) {
        let alpha = self.mask.alpha_of(texel);
        let above = blend(self.weights, self.mask.alphas.map(|own| own * alpha - self.mask.cutoff));
        // Weights are negative where the triangle is seen from its back.
        let side = 1f64.copysign(self.total[0] + self.total[1]);
        if let Some(solid) = not_negative(above.map(|value| value * side)).and_then(|solid| common(solid, span)) {
            join(parts, solid);
        }
    }
}

/// Sums of the corners' weights times their values, at both ends.
fn blend(weights: [[f64; 2]; 3], values: [f64; 3]) -> [f64; 2] {
    [0, 1].map(|k| weights[0][k] * values[0] + weights[1][k] * values[1] + weights[2][k] * values[2])
}

/// A linear function between its ends.
fn at([first, last]: [f64; 2], s: f64) -> f64 {
    first + s * (last - first)
}

/// Adds a span that starts no earlier than those before it.
fn join(parts: &mut SolidSpans, span: Span) {
    match parts.last_mut() {
        _ if span[0] >= span[1] => {}
        Some(last) if last[1] >= span[0] => last[1] = last[1].max(span[1]),
        _ => parts.push(span),
    }
}
