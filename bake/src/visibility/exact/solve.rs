//! Which part of an arc each of eight triangles occludes at a point, in `f64` and in closed form.
//!
//! Theory: let the corners v be relative to the point and ordered so that `D = v0 . (v1 x v2) > 0`, and let
//! `n_i = v_i x v_(i+1)`. The corners are a basis, and by Cramer's rule `dir = (n_1 . dir v0 + n_2 . dir v1 +
//! n_0 . dir v2) / D`. A ray along dir meets the triangle, in front of the point, exactly if all three factors are not
//! negative: divided by their sum they are the barycentric coordinates of the hit, at a distance of D over the sum. So
//! the triangle hides the sun where all three `n_i . dir(h) >= 0`. Each is a span of hour angle with ends in closed
//! form (`arc.rs`); the triangle hides their intersection.
//!
//! Watertight: `a x b` and `b x a` are exact opposites in floating point, and every step from there to the ends of a
//! span treats opposites alike. So the triangles on both sides of an edge end at the same number, and no gap is left.
//! That holds because corners are rotated into the arc's frame by one sequence of operations wherever they are, and
//! because nothing is fused: additions and products round the same at every level of SIMD.
//!
//! Triangles whose plane is within the run-up of shadow rays are handled in `near.rs`, alpha-masked ones in
//! `alpha_mask.rs`: both are told apart here.

use super::arc::Declination;
use super::gaps::Gaps;
use fearless_simd::{f64x8, mask64x8, prelude::*};
use glam::{DMat3, DVec3, Vec3};
use smallvec::SmallVec;

/// Triangles solved at once.
pub(super) const SIMD_WIDTH: usize = 8;

/// Corners of eight triangles: by corner, axis and triangle.
pub(super) type BatchCorners = [[[f64; SIMD_WIDTH]; 3]; 3];

/// Up to eight triangles, corners in the arc's frame.
#[derive(Default, Clone)]
pub(super) struct TriangleBatch {
    pub corners: BatchCorners,
    pub ids: [u32; SIMD_WIDTH],
    pub count: usize,
}

impl TriangleBatch {
    /// Adds a triangle; there must be room.
    pub fn push(&mut self, id: u32, corners: [DVec3; 3]) {
        self.ids[self.count] = id;
        for (axes, corner) in self.corners.iter_mut().zip(corners) {
            for (values, value) in axes.iter_mut().zip(corner.to_array()) {
                values[self.count] = value;
            }
        }
        self.count += 1;
    }

    /// Adds a triangle, not yet in the arc's frame; there must be room.
    #[inline]
    pub fn push_unrotated(&mut self, id: u32, corners: &[Vec3; 3]) {
        self.ids[self.count] = id;
        for (axes, corner) in self.corners.iter_mut().zip(corners) {
            for (values, value) in axes.iter_mut().zip(corner.to_array()) {
                values[self.count] = f64::from(value);
            }
        }
        self.count += 1;
    }

    /// Rotates all triangles into the arc's frame. Every corner goes through here, so that triangles which share it
    /// agree about it exactly.
    pub fn rotate<S: Simd>(&mut self, simd: S, rotation: &DMat3) {
        simd.vectorize(
            #[inline(always)]
            || {
                for corner in &mut self.corners {
                    let x = f64x8::from_slice(simd, &corner[0]);
                    let y = f64x8::from_slice(simd, &corner[1]);
                    let z = f64x8::from_slice(simd, &corner[2]);
                    for (k, values) in corner.iter_mut().enumerate() {
                        let rotated = x * rotation.x_axis[k] + y * rotation.y_axis[k] + z * rotation.z_axis[k];
                        rotated.store_slice(values);
                    }
                }
            },
        );
    }

    /// Corners of the triangle at an index, in the frame that the batch is in.
    pub fn corners_of(&self, index: usize) -> [DVec3; 3] {
        self.corners.each_ref().map(|[x, y, z]| DVec3::new(x[index], y[index], z[index]))
    }
}

/// What eight triangles occlude at one declination, within the hull of the gaps.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct HiddenSpans {
    /// Bit set of those that occlude something.
    pub mask: u32,
    pub low: [f64; SIMD_WIDTH],
    pub high: [f64; SIMD_WIDTH],
    /// Bit set of those whose span has up to three holes, given by `holes`.
    pub split: u32,
    /// For each edge, the span between `low` and `high` that is not occluded, if its end is above its start.
    pub holes: [[[f64; SIMD_WIDTH]; 2]; 3],
}

impl HiddenSpans {
    /// The span of a triangle less its holes, if that is one span (or an empty one), as it mostly is.
    #[inline]
    pub fn whole(&self, index: usize) -> Option<[f64; 2]> {
        let [mut low, mut high] = [self.low[index], self.high[index]];
        if self.split & (1 << index) == 0 {
            return Some([low, high]);
        }
        for [start, end] in self.holes.iter().map(|hole| [hole[0][index], hole[1][index]]) {
            match start < end && start < high && end > low {
                false => {}
                true if start <= low => low = end,
                true if end >= high => high = start,
                true => return None,
            }
        }
        Some([low, high])
    }

    /// The span of a triangle less its holes.
    pub fn pieces(&self, index: usize) -> SmallVec<[[f64; 2]; 4]> {
        let mut left = SmallVec::from_buf_and_len([[self.low[index], self.high[index]]; 4], 1);
        if self.split & (1 << index) != 0 {
            for hole in &self.holes {
                take_out(&mut left, [hole[0][index], hole[1][index]]);
            }
        }
        left
    }
}

/// Removes a span from a list of spans.
fn take_out(spans: &mut SmallVec<[[f64; 2]; 4]>, [start, end]: [f64; 2]) {
    if start >= end {
        return;
    }
    let mut index = 0;
    while let Some(&[low, high]) = spans.get(index) {
        let (before, after) = ([low, high.min(start)], [low.max(end), high]);
        match [before[0] < before[1], after[0] < after[1]] {
            [false, false] => {
                spans.remove(index);
                continue;
            }
            [true, false] => spans[index] = before,
            [false, true] => spans[index] = after,
            [true, true] => {
                spans[index] = before;
                spans.insert(index + 1, after);
                index += 1;
            }
        }
        index += 1;
    }
}

/// What eight triangles occlude at a point at some declinations, as far as it meets the gaps. Returns a bit set of the
/// triangles whose plane is within the run-up (given squared); for these the rest of the answer is not valid.
pub(super) fn hide<S: Simd>(
    simd: S,
    corners: &BatchCorners,
    origin: DVec3,
    run_up2: f64,
    lanes: &[Declination],
    gaps: &[Gaps],
    hidden: &mut [HiddenSpans],
) -> u32 {
    simd.vectorize(
        #[inline(always)]
        || {
            let edges = edges(simd, corners, origin, run_up2);
            for ((declination, gaps), hidden) in lanes.iter().zip(gaps).zip(hidden) {
                hide_at(simd, &edges, *declination, gaps.as_slice(), hidden);
            }
            edges.near
        },
    )
}

/// Edge normals of eight triangles, signed so that their products are positive where the triangle hides.
struct Edges<S: Simd> {
    normals: [[f64x8<S>; 3]; 3],
    near: u32,
}

#[inline(always)]
fn edges<S: Simd>(simd: S, corners: &BatchCorners, origin: DVec3, run_up2: f64) -> Edges<S> {
    let a = relative(simd, &corners[0], origin);
    let b = relative(simd, &corners[1], origin);
    let c = relative(simd, &corners[2], origin);
    let (ab, bc, ca) = (cross(a, b), cross(b, c), cross(c, a));
    let area = [ab[0] + bc[0] + ca[0], ab[1] + bc[1] + ca[1], ab[2] + bc[2] + ca[2]];
    let volume = dot(a, bc);
    let near = (volume * volume).simd_le(dot(area, area) * run_up2);
    let one = f64x8::splat(simd, 1.0);
    let side = volume.simd_lt(f64x8::splat(simd, 0.0)).select(one * -1.0, one);
    let normals = [scaled(ab, side), scaled(bc, side), scaled(ca, side)];
    Edges { normals, near: near.to_bitmask() as u32 }
}

#[inline(always)]
fn relative<S: Simd>(simd: S, corner: &[[f64; SIMD_WIDTH]; 3], origin: DVec3) -> [f64x8<S>; 3] {
    [
        f64x8::from_slice(simd, &corner[0]) - origin.x,
        f64x8::from_slice(simd, &corner[1]) - origin.y,
        f64x8::from_slice(simd, &corner[2]) - origin.z,
    ]
}

#[inline(always)]
fn cross<S: Simd>(a: [f64x8<S>; 3], b: [f64x8<S>; 3]) -> [f64x8<S>; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[inline(always)]
fn dot<S: Simd>(a: [f64x8<S>; 3], b: [f64x8<S>; 3]) -> f64x8<S> {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn scaled<S: Simd>(a: [f64x8<S>; 3], scale: f64x8<S>) -> [f64x8<S>; 3] {
    [a[0] * scale, a[1] * scale, a[2] * scale]
}

#[inline(always)]
fn hide_at<S: Simd>(
    simd: S,
    edges: &Edges<S>,
    Declination { cos, sin }: Declination,
    gaps: &[[f64; 2]],
    hidden: &mut HiddenSpans,
) {
    hidden.mask = 0;
    hidden.split = 0;
    let (Some(first_gap), Some(last_gap)) = (gaps.first(), gaps.last()) else { return };
    let hull = [first_gap[0], last_gap[1]];
    let (before, after) = (f64x8::splat(simd, -3.0), f64x8::splat(simd, 3.0));
    let (mut low, mut high) = (before, after);
    for k in 0..3 {
        let edge = edges.normals[k];
        let span = span(simd, edge[0] * cos, edge[1] * cos, edge[2] * sin);
        let crosses = span.start.simd_gt(span.end) & span.is_part;
        let has_start = !(crosses & span.start.simd_gt(hull[1]));
        let has_end = !(crosses & span.end.simd_lt(hull[0]) & has_start);
        let is_split = crosses & has_start & has_end;
        low = low.max((!has_start | is_split).select(before, span.start));
        high = high.min((!has_end | is_split).select(after, span.end));
        let split = is_split.to_bitmask() as u32;
        if split != 0 {
            hidden.split |= split;
            is_split.select(span.end, after).store_slice(&mut hidden.holes[k][0]);
            is_split.select(span.start, before).store_slice(&mut hidden.holes[k][1]);
        } else {
            hidden.holes[k] = [[3.0; SIMD_WIDTH], [-3.0; SIMD_WIDTH]];
        }
        // Most triangles occlude nothing, and one or two edges show it.
        let mut alive = low.simd_lt(low);
        for gap in gaps {
            alive |= low.simd_lt(gap[1]) & high.simd_gt(gap[0]);
        }
        hidden.mask = (alive & low.simd_lt(high)).to_bitmask() as u32;
        if hidden.mask == 0 {
            return;
        }
    }
    low.store_slice(&mut hidden.low);
    high.store_slice(&mut hidden.high);
}

/// Where eight functions `a cos h + b sin h + c` are not negative: see [`super::arc::half_space`], its scalar twin.
struct EightSpans<S: Simd> {
    start: f64x8<S>,
    end: f64x8<S>,
    /// Neither everywhere nor nowhere.
    is_part: mask64x8<S>,
}

#[inline(always)]
fn span<S: Simd>(simd: S, a: f64x8<S>, b: f64x8<S>, c: f64x8<S>) -> EightSpans<S> {
    let zero = f64x8::splat(simd, 0.0);
    let d = a * a + b * b - c * c;
    let is_part = d.simd_gt(zero);
    let everywhere = c.simd_ge(zero);
    let w = d.max(zero).sqrt();
    let (ca, cb, wa, wb) = (c * a, c * b, w * a, w * b);
    let [start, end] = diamonds(simd, [wb - ca, zero - cb - wa], [zero - ca - wb, wa - cb]);
    let far = f64x8::splat(simd, 3.0);
    let whole_start = everywhere.select(zero - far, far);
    EightSpans { start: is_part.select(start, whole_start), end: is_part.select(end, zero - whole_start), is_part }
}

/// Two diamond angles by one division: see [`super::arc::diamonds`].
#[inline(always)]
fn diamonds<S: Simd>(simd: S, [x, y]: [f64x8<S>; 2], [x1, y1]: [f64x8<S>; 2]) -> [f64x8<S>; 2] {
    let (sum, sum1) = (x.abs() + y.abs(), x1.abs() + y1.abs());
    let inverse = f64x8::splat(simd, 1.0) / (sum * sum1);
    [unfold(simd, x, y, y * (sum1 * inverse)), unfold(simd, x1, y1, y1 * (sum * inverse))]
}

/// Diamond angle of (x, y) from the ratio of y to their sum.
#[inline(always)]
fn unfold<S: Simd>(simd: S, x: f64x8<S>, y: f64x8<S>, ratio: f64x8<S>) -> f64x8<S> {
    let zero = f64x8::splat(simd, 0.0);
    let side = y.simd_lt(zero).select(f64x8::splat(simd, -2.0), f64x8::splat(simd, 2.0));
    x.simd_lt(zero).select(side - ratio, ratio)
}
