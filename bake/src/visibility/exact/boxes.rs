//! Eight boxes at once against the suns of an arc. Conservative, in `f32`.
//!
//! From one point the suns of an arc lie on a cone about the frame's z axis. In the frame, a box spans heights z and
//! distances rho from the axis; it meets the cone of declination d only if `z cos d = rho sin d` somewhere in those spans,
//! and only at hour angles within those of its corners as seen along the axis. Lanes widen the cone to a shell between the least and the greatest declination.
//!
//! Every box has been grown by more than rounding amounts to (see [`super::BOX_PADDING`]).

use super::arc::{ArcFrame, Declination};
use super::cover::Query;
use super::wide::{Node, WIDTH};
use fearless_simd::{f32x8, mask32x8, prelude::*};
use glam::DMat3;
use smallvec::SmallVec;

/// Most spans that are told apart; more are joined.
const MOST_SPANS: usize = 8;
/// Spans are told apart if they are at least this far from each other, in diamond angle: about a degree.
const LEAST_SLIT: f32 = 0.02;
/// Growth of spans of diamond angle: a few steps of an `f32` near 2.
const ANGLE_PADDING: f32 = 2e-6;
/// What the cone's condition is relaxed by, as a share of distance.
const CONE_SLACK: f32 = 1e-6;

/// What a walk looks for.
pub(super) struct Wanted {
    /// The point, axes of the boxes.
    centre: [f32; 3],
    arc_from_box: [[f32; 3]; 3],
    /// Whether the boxes' axes are the arc's.
    is_aligned: bool,
    /// Way that the surface faces, arc frame: what lies behind it is passed over.
    side: [f32; 3],
    padding: f32,
    /// Cosine and sine of the least declination and of the greatest.
    shell: [[f32; 2]; 2],
    /// Spans of diamond angle that are still lit in some lane, grown.
    spans: SmallVec<[[f32; 2]; MOST_SPANS]>,
}

/// What eight boxes came to.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Seen {
    /// Bit set of the boxes that are met.
    pub mask: u32,
    /// Their spans of diamond angle; first above second where the span crosses the cut at 2.
    pub span: [[f32; WIDTH]; 2],
    /// Least distance from the axis.
    pub near: [f32; WIDTH],
}

/// Frames that a walk is about: where the boxes' axes and the arc's lie.
pub(super) struct Frames {
    box_from_arc: DMat3,
    arc_from_box: [[f32; 3]; 3],
    is_aligned: bool,
    /// Cosine and sine of the least declination and of the greatest.
    shell: [[f32; 2]; 2],
    padding: f32,
}

impl Frames {
    /// For an arc's frame, over boxes of given axes that are grown by `padding`.
    pub fn new(arc: &ArcFrame, box_from_tracer: DMat3, padding: f32) -> Self {
        let by_sine = |a: &&Declination, b: &&Declination| a.sin.total_cmp(&b.sin);
        let (low, high) = (arc.lanes.iter().min_by(by_sine), arc.lanes.iter().max_by(by_sine));
        let box_from_arc = box_from_tracer * arc.arc_from_bake.transpose();
        Self {
            box_from_arc,
            arc_from_box: [0, 1, 2].map(|k| box_from_arc.col(k).as_vec3().to_array()),
            is_aligned: box_from_tracer == arc.arc_from_bake,
            shell: [low, high].map(|d| d.map_or([1.0, 0.0], |d| [d.cos as f32, d.sin as f32])),
            padding,
        }
    }
}

impl Wanted {
    /// Looks from a query's point for what hides any of its gaps.
    pub fn new(frames: &Frames, query: &Query) -> Self {
        let in_box = frames.box_from_arc * query.origin;
        let mut wanted = Self {
            centre: in_box.as_vec3().to_array(),
            arc_from_box: frames.arc_from_box,
            is_aligned: frames.is_aligned,
            side: query.side.as_vec3().to_array(),
            padding: frames.padding,
            shell: frames.shell,
            spans: SmallVec::new(),
        };
        wanted.want(query);
        wanted
    }

    /// Looks for what is open now.
    pub fn want(&mut self, query: &Query) {
        self.spans.clear();
        for gaps in &query.gaps {
            for &[start, end] in gaps.as_slice() {
                let span = [start as f32 - ANGLE_PADDING, end as f32 + ANGLE_PADDING];
                let is_full = self.spans.len() == MOST_SPANS;
                match self.spans.last_mut() {
                    Some(last) if is_full || (last[0] <= span[0] && span[0] - last[1] < LEAST_SLIT) => {
                        *last = [last[0].min(span[0]), last[1].max(span[1])];
                    }
                    _ => self.spans.push(span),
                }
            }
        }
    }

    /// Whether a span (first above second where it crosses the cut) has a part among those wanted.
    #[inline(always)]
    pub fn wants(&self, [low, high]: [f32; 2]) -> bool {
        self.spans.iter().any(|&[start, end]| {
            let (from_start, to_end) = (high >= start, low <= end);
            if low <= high { from_start && to_end } else { from_start || to_end }
        })
    }
}

/// Which of a node's boxes are met.
pub(super) fn node_seen<S: Simd>(simd: S, node: &Node, wanted: &Wanted, out: &mut Seen) {
    simd.vectorize(
        #[inline(always)]
        || {
            let x = f32x8::from_slice(simd, &node.centre[0]) - wanted.centre[0];
            let y = f32x8::from_slice(simd, &node.centre[1]) - wanted.centre[1];
            let z = f32x8::from_slice(simd, &node.centre[2]) - wanted.centre[2];
            let half_x = f32x8::from_slice(simd, &node.half[0]);
            let half_y = f32x8::from_slice(simd, &node.half[1]);
            let half_z = f32x8::from_slice(simd, &node.half[2]);
            let mut sides = [
                [x - half_x - wanted.padding, x + half_x + wanted.padding],
                [y - half_y - wanted.padding, y + half_y + wanted.padding],
                [z - half_z - wanted.padding, z + half_z + wanted.padding],
            ];
            if !wanted.is_aligned {
                for (side, row) in sides.iter_mut().zip(&wanted.arc_from_box) {
                    let middle = x * row[0] + y * row[1] + z * row[2];
                    let reach = half_x * row[0].abs() + half_y * row[1].abs() + half_z * row[2].abs() + wanted.padding;
                    *side = [middle - reach, middle + reach];
                }
            }
            seen(simd, sides, wanted, node.count, out);
        },
    );
}

/// Which boxes, given by their low and high side along each axis of the arc's frame, are met.
#[inline(always)]
fn seen<S: Simd>(simd: S, sides: [[f32x8<S>; 2]; 3], wanted: &Wanted, count: usize, out: &mut Seen) {
    let [[x0, x1], [y0, y1], [z0, z1]] = sides;
    let zero = f32x8::splat(simd, 0.0);
    let (left, right) = (x1.simd_lt(zero), x0.simd_gt(zero));
    let (below, above) = (y1.simd_lt(zero), y0.simd_gt(zero));

    let near_x = x0.max(zero - x1).max(zero);
    let near_y = y0.max(zero - y1).max(zero);
    let far_x = x1.max(zero - x0);
    let far_y = y1.max(zero - y0);
    let near = (near_x * near_x + near_y * near_y).sqrt();
    let far = (far_x * far_x + far_y * far_y).sqrt();
    let [[low_cos, low_sin], [high_cos, high_sin]] = wanted.shell;
    let least = if low_sin < 0.0 { far } else { near };
    let greatest = if high_sin < 0.0 { near } else { far };
    let slack = (far + z1.abs().max(z0.abs())) * CONE_SLACK;
    let over_low = (z1 * low_cos + slack).simd_ge(least * low_sin);
    let under_high = (z0 * high_cos - slack).simd_le(greatest * high_sin);

    let not_below_left = !below & left;
    let not_above_left = !above & left;
    let first = [(above | not_below_left).select(x1, x0), above.select(left.select(y1, y0), right.select(y0, y1))];
    let last = [(below | not_above_left).select(x1, x0), below.select(left.select(y0, y1), right.select(y1, y0))];
    let around = !(left | right | below | above);
    let low = around.select(f32x8::splat(simd, -3.0), diamond(simd, first));
    let high = around.select(f32x8::splat(simd, 3.0), diamond(simd, last));
    let [x, y, z] = wanted.side;
    let highest =
        if x > 0.0 { x1 } else { x0 } * x + if y > 0.0 { y1 } else { y0 } * y + if z > 0.0 { z1 } else { z0 } * z;
    let hit = over_low & under_high & highest.simd_gt(zero) & overlap(simd, low, high, wanted);
    out.mask = hit.to_bitmask() as u32 & ((1 << count) - 1);
    if out.mask != 0 {
        low.store_slice(&mut out.span[0]);
        high.store_slice(&mut out.span[1]);
        near.store_slice(&mut out.near);
    }
}

/// Whether spans have a part among those wanted; a span whose end is below its start crosses the cut.
#[inline(always)]
fn overlap<S: Simd>(simd: S, low: f32x8<S>, high: f32x8<S>, wanted: &Wanted) -> mask32x8<S> {
    let crosses = low.simd_gt(high);
    let mut any = mask32x8::splat(simd, false);
    for &[start, end] in &wanted.spans {
        let (from_start, to_end) = (high.simd_ge(start), low.simd_le(end));
        any |= (from_start & to_end) | (crosses & (from_start | to_end));
    }
    any
}

#[inline(always)]
fn diamond<S: Simd>(simd: S, [x, y]: [f32x8<S>; 2]) -> f32x8<S> {
    let zero = f32x8::splat(simd, 0.0);
    let r = y / (x.abs() + y.abs());
    let side = y.simd_lt(zero).select(f32x8::splat(simd, -2.0), f32x8::splat(simd, 2.0));
    x.simd_lt(zero).select(side - r, r)
}
