//! Sixteen boxes, or sixteen triangles, at once against the spans of an arc that are still lit. Conservative, in `f32`.
//!
//! From one point the suns of an arc lie on a cone about the frame's z axis, and those of a span of hour angle in a
//! wedge whose edge is that axis. A box, or a triangle by its corners, is skipped if it lies
//!
//! * beyond a side of every lit wedge: a product with a plane's normal tells, and no angle is needed. A wedge of more
//!   than half a turn is missed by what lies beyond both of its sides;
//! * above or below the cone (with several lanes, the shell between two): the space inside a cone is convex, so that a
//!   triangle whose corners lie inside does not reach it. From outside, a plane through the apex that keeps the cone on
//!   its other side tells: the one on the triangle's side, `z cos d < sin d (u . p)` for a unit vector u across the
//!   axis, since `u . p` is at most p's distance from it;
//! * behind the surface.
//!
//! Every box has been grown by more than rounding amounts to (see [`super::BOX_PADDING`]), and corners are given as
//! much (against the cone twice as much).

use super::arc::{ArcFrame, Declination, of_diamond};
use super::cover::Query;
use crate::trace::bvh16::{Bvh16Leaf, Bvh16Node, Points, first_bits};
use fearless_simd::{f32x16, mask32x16, prelude::*};
use glam::DMat3;
use smallvec::SmallVec;

/// Most spans that are kept apart; more are joined.
const MOST_SPANS: usize = 8;
/// Spans are kept apart if they are at least this far from each other, in diamond angle: about a degree.
const LEAST_SLIT: f32 = 0.02;
/// Growth of spans of diamond angle: a few steps of an `f32` near 2.
const ANGLE_PADDING: f32 = 2e-6;
/// Relative relaxation of squared distances from the axis.
const CONE_SLACK: f32 = 4e-6;

/// The spans that are still lit, as a walk tests boxes against them.
#[derive(Default)]
pub(super) struct LitSpans {
    /// The point, axes of the boxes.
    centre: [f32; 3],
    arc_from_box: [[f32; 3]; 3],
    /// Whether the boxes' axes are the arc's.
    is_aligned: bool,
    /// Direction that the surface faces, arc frame: what lies behind it is skipped.
    side: [f32; 3],
    padding: f32,
    /// Cosine and sine of the least declination and of the greatest.
    shell: [[f32; 2]; 2],
    wedges: SmallVec<[Wedge; MOST_SPANS]>,
    /// Spans of diamond angle that are still lit in some lane, grown; and room to sort them.
    spans: Vec<[f32; 2]>,
}

/// The hour angles from one direction across the axis, counter-clockwise, to another.
#[derive(Debug, Clone, Copy, Default)]
struct Wedge {
    start: [f32; 2],
    end: [f32; 2],
    /// Whether it is more than half a turn.
    is_wide: bool,
}

/// The axes of the boxes relative to those of the arc.
pub(super) struct BoxFrames {
    box_from_arc: DMat3,
    arc_from_box: [[f32; 3]; 3],
    is_aligned: bool,
    /// Cosine and sine of the least declination and of the greatest.
    shell: [[f32; 2]; 2],
    padding: f32,
}

impl BoxFrames {
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

impl LitSpans {
    /// Takes the point and the gaps of a query.
    pub fn start(&mut self, frames: &BoxFrames, query: &Query) {
        self.centre = (frames.box_from_arc * query.origin).as_vec3().to_array();
        self.arc_from_box = frames.arc_from_box;
        self.is_aligned = frames.is_aligned;
        self.side = query.side.as_vec3().to_array();
        self.padding = frames.padding;
        self.shell = frames.shell;
        self.update(query);
    }

    /// Takes the gaps that are open now.
    pub fn update(&mut self, query: &Query) {
        let Self { spans, wedges, .. } = self;
        spans.clear();
        for gaps in &query.gaps {
            let grown = |&[start, end]: &[f64; 2]| [start as f32 - ANGLE_PADDING, end as f32 + ANGLE_PADDING];
            spans.extend(gaps.as_slice().iter().map(grown));
        }
        if query.gaps.len() > 1 {
            spans.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]));
        }
        wedges.clear();
        let mut last: Option<[f32; 2]> = None;
        for &span in spans.iter() {
            match &mut last {
                Some(last) if wedges.len() + 1 == MOST_SPANS || span[0] - last[1] < LEAST_SLIT => {
                    last[1] = last[1].max(span[1]);
                }
                _ => wedges.extend(last.replace(span).map(Wedge::new)),
            }
        }
        wedges.extend(last.map(Wedge::new));
    }
}

impl Wedge {
    fn new([start, end]: [f32; 2]) -> Self {
        let direction = |u: f32| of_diamond(f64::from(u.clamp(-2.0, 2.0))).map(|v| v as f32);
        Self { start: direction(start), end: direction(end), is_wide: end - start > 2.0 }
    }
}

/// Which of a node's boxes are met: a bit set. `near2` gets their least squared distance from the axis.
pub(super) fn node_met<S: Simd>(simd: S, node: &Bvh16Node, lit: &LitSpans, near2: &mut [f32; 16]) -> u32 {
    simd.vectorize(
        #[inline(always)]
        || {
            let boxes = rotated(simd, node, lit);
            let (met, near) = met(simd, &boxes, lit);
            near.store_slice(near2);
            met.to_bitmask() as u32 & first_bits(node.count)
        },
    )
}

/// Which triangles of a leaf may occlude something lit: a bit set.
pub(super) fn leaf_met<S: Simd>(simd: S, leaf: &Bvh16Leaf, lit: &LitSpans) -> u32 {
    simd.vectorize(
        #[inline(always)]
        || {
            let a = corner(simd, &leaf.corners[0], lit);
            let b = corner(simd, &leaf.corners[1], lit);
            let c = corner(simd, &leaf.corners[2], lit);
            triangles_met(simd, [a, b, c], lit).to_bitmask() as u32 & first_bits(leaf.count)
        },
    )
}

/// Sixteen boxes relative to where the walk looks from, by axis.
struct Boxes<S: Simd> {
    centre: [f32x16<S>; 3],
    half: [f32x16<S>; 3],
}

/// A node's boxes in the arc's frame.
#[inline(always)]
fn rotated<S: Simd>(simd: S, node: &Bvh16Node, lit: &LitSpans) -> Boxes<S> {
    let x = f32x16::from_slice(simd, &node.centre[0]) - lit.centre[0];
    let y = f32x16::from_slice(simd, &node.centre[1]) - lit.centre[1];
    let z = f32x16::from_slice(simd, &node.centre[2]) - lit.centre[2];
    let half_x = f32x16::from_slice(simd, &node.half[0]);
    let half_y = f32x16::from_slice(simd, &node.half[1]);
    let half_z = f32x16::from_slice(simd, &node.half[2]);
    let padding = lit.padding;
    if lit.is_aligned {
        return Boxes { centre: [x, y, z], half: [half_x + padding, half_y + padding, half_z + padding] };
    }
    let [r0, r1, r2] = lit.arc_from_box;
    Boxes {
        centre: [row(r0, [x, y, z]), row(r1, [x, y, z]), row(r2, [x, y, z])],
        half: [
            row(abs(r0), [half_x, half_y, half_z]) + padding,
            row(abs(r1), [half_x, half_y, half_z]) + padding,
            row(abs(r2), [half_x, half_y, half_z]) + padding,
        ],
    }
}

/// Corners in the arc's frame, relative to the walk's point.
#[inline(always)]
fn corner<S: Simd>(simd: S, points: &Points, lit: &LitSpans) -> [f32x16<S>; 3] {
    let x = f32x16::from_slice(simd, &points[0]) - lit.centre[0];
    let y = f32x16::from_slice(simd, &points[1]) - lit.centre[1];
    let z = f32x16::from_slice(simd, &points[2]) - lit.centre[2];
    if lit.is_aligned {
        return [x, y, z];
    }
    let [r0, r1, r2] = lit.arc_from_box;
    [row(r0, [x, y, z]), row(r1, [x, y, z]), row(r2, [x, y, z])]
}

#[inline(always)]
fn abs([a, b, c]: [f32; 3]) -> [f32; 3] {
    [a.abs(), b.abs(), c.abs()]
}

#[inline(always)]
fn row<S: Simd>([a, b, c]: [f32; 3], [x, y, z]: [f32x16<S>; 3]) -> f32x16<S> {
    x * a + y * b + z * c
}

/// Which boxes are met, and their least squared distance from the axis.
#[inline(always)]
fn met<S: Simd>(simd: S, boxes: &Boxes<S>, lit: &LitSpans) -> (mask32x16<S>, f32x16<S>) {
    let zero = f32x16::splat(simd, 0.0);
    let Boxes { centre: [x, y, z], half: [half_x, half_y, half_z] } = *boxes;
    let (near_x, near_y) = ((x.abs() - half_x).max(zero), (y.abs() - half_y).max(zero));
    let (far_x, far_y) = (x.abs() + half_x, y.abs() + half_y);
    let near2 = near_x * near_x + near_y * near_y;
    let far2 = far_x * far_x + far_y * far_y;
    let [low, [high_cos, high_sin]] = lit.shell;
    let over_low = reaches_over(simd, z + half_z, [near2, far2], low);
    let under_high = reaches_over(simd, half_z - z, [near2, far2], [high_cos, -high_sin]);

    let mut in_wedge = mask32x16::splat(simd, false);
    for &Wedge { start: [sx, sy], end: [ex, ey], is_wide } in &lit.wedges {
        let past_start = (y * sx - x * sy + half_y * sx.abs() + half_x * sy.abs()).simd_ge(zero);
        let before_end = (x * ey - y * ex + half_x * ey.abs() + half_y * ex.abs()).simd_ge(zero);
        in_wedge |= if is_wide { past_start | before_end } else { past_start & before_end };
    }
    let highest = row(lit.side, [x, y, z]) + row(abs(lit.side), [half_x, half_y, half_z]);
    (over_low & under_high & in_wedge & highest.simd_ge(zero), near2)
}

/// Whether `z cos d >= rho sin d` for the given z and some distance from the axis between two, given squared.
#[inline(always)]
fn reaches_over<S: Simd>(simd: S, z: f32x16<S>, [near2, far2]: [f32x16<S>; 2], [cos, sin]: [f32; 2]) -> mask32x16<S> {
    let above = z.simd_ge(f32x16::splat(simd, 0.0));
    let height2 = z * z * (cos * cos);
    match sin >= 0.0 {
        true => above & height2.simd_ge(near2 * (sin * sin * (1.0 - CONE_SLACK))),
        false => above | height2.simd_le(far2 * (sin * sin * (1.0 + CONE_SLACK))),
    }
}

/// Which triangles may be met.
#[inline(always)]
fn triangles_met<S: Simd>(simd: S, [a, b, c]: [[f32x16<S>; 3]; 3], lit: &LitSpans) -> mask32x16<S> {
    let tiny = f32x16::splat(simd, -lit.padding);
    let mut in_wedge = mask32x16::splat(simd, false);
    for &Wedge { start: [sx, sy], end: [ex, ey], is_wide } in &lit.wedges {
        let from_start = (a[1] * sx - a[0] * sy).max(b[1] * sx - b[0] * sy).max(c[1] * sx - c[0] * sy);
        let to_end = (a[0] * ey - a[1] * ex).max(b[0] * ey - b[1] * ex).max(c[0] * ey - c[1] * ex);
        let (past_start, before_end) = (from_start.simd_ge(tiny), to_end.simd_ge(tiny));
        in_wedge |= if is_wide { past_start | before_end } else { past_start & before_end };
    }
    let highest = row(lit.side, a).max(row(lit.side, b)).max(row(lit.side, c));

    let ahead = in_wedge & highest.simd_ge(tiny);
    if ahead.to_bitmask() == 0 {
        return ahead;
    }

    // Towards the triangle's middle across the axis, and how long that is.
    let (x, y) = (a[0] + b[0] + c[0], a[1] + b[1] + c[1]);
    let middle = [x, y, (x * x + y * y).sqrt()];
    let [[low_cos, low_sin], high] = lit.shell;
    let is_above = lies_above(simd, [a, b, c], middle, high, lit.padding);
    let upside_down = [[a[0], a[1], -a[2]], [b[0], b[1], -b[2]], [c[0], c[1], -c[2]]];
    let is_below = lies_above(simd, upside_down, middle, [low_cos, -low_sin], lit.padding);
    ahead & !(is_above | is_below)
}

/// Whether all of a triangle is sure to have `z cos d > rho sin d`.
#[inline(always)]
fn lies_above<S: Simd>(
    simd: S,
    [a, b, c]: [[f32x16<S>; 3]; 3],
    [x, y, length]: [f32x16<S>; 3],
    [cos, sin]: [f32; 2],
    padding: f32,
) -> mask32x16<S> {
    let zero = f32x16::splat(simd, 0.0);
    let spare = 2.0 * padding;
    let height = [a[2] * cos - spare, b[2] * cos - spare, c[2] * cos - spare];
    if sin < 0.0 {
        let (x, y) = (x * sin, y * sin);
        let a = height[0] * length - (x * a[0] + y * a[1]);
        let b = height[1] * length - (x * b[0] + y * b[1]);
        let c = height[2] * length - (x * c[0] + y * c[1]);
        return a.min(b).min(c).simd_gt(zero);
    }
    let sin2 = sin * sin * (1.0 + CONE_SLACK);
    let a = (height[0] * height[0]).simd_gt((a[0] * a[0] + a[1] * a[1]) * sin2);
    let b = (height[1] * height[1]).simd_gt((b[0] * b[0] + b[1] * b[1]) * sin2);
    let c = (height[2] * height[2]).simd_gt((c[0] * c[0] + c[1] * c[1]) * sin2);
    a & b & c & height[0].min(height[1]).min(height[2]).simd_gt(zero)
}
