//! Which part of a hidden span a triangle with holes really hides.
//!
//! While the sun moves, the point where its ray pierces the triangle runs along a curve, and the texture coordinate there is
//! `sum(w_i uv_i) / sum(w_i)`, the weights w_i being the products of the edge normals with the direction. A border between
//! two columns of texels, `u = k / width`, is crossed where `sum(w_i (u_i width - k)) = 0`: again a half space through the
//! point, whose ends are known in closed form. So the curve is followed from texel to texel, and no texel is skipped but
//! such as are crossed in less than [`LEAST_STEP`]. Squares of texels that are solid or clear throughout are crossed in one
//! step. In a texel where the corners' own alphas matter, alpha passes the cutoff at the end of a half space once more.

use super::arc::{Declination, half_space, of_diamond};
use crate::trace::CutView;
use fearless_simd::{f64x4, prelude::*};
use glam::{DVec2, DVec3};
use smallvec::SmallVec;

/// Smallest step along the curve, in diamond angle: some tens of microseconds of a day.
const LEAST_STEP: f64 = 1e-9;
/// After so many steps on one triangle the rest is covered in as many: texture coordinates may tile without bound.
const MOST_STEPS: u32 = 65_536;

/// Spans found; few, as a rule.
pub(super) type Parts = SmallVec<[[f64; 2]; 8]>;

/// A triangle with holes, seen from a point along one lane.
pub(super) struct Pierced<'a> {
    cut: CutView<'a>,
    /// For each corner, the normal of the opposite edge, positive on the triangle, with the declination worked in: its
    /// product with (cos h, sin h, 1) is the corner's weight.
    weights: [DVec3; 3],
    /// Their sum, and their sums weighted by each texture coordinate.
    total: DVec3,
    along: [DVec3; 2],
}

impl<'a> Pierced<'a> {
    /// From the corners relative to the point, arc frame.
    pub fn new(cut: CutView<'a>, [a, b, c]: [DVec3; 3], declination: Declination) -> Self {
        let normals = [b.cross(c), c.cross(a), a.cross(b)];
        let side = if a.dot(normals[0]) < 0.0 { -1.0 } else { 1.0 };
        let scale = DVec3::new(declination.cos, declination.cos, declination.sin) * side;
        let weights = normals.map(|n| n * scale);
        let blend = |values: [f64; 3]| weights[0] * values[0] + weights[1] * values[1] + weights[2] * values[2];
        let along = [cut.texel_uvs.map(|uv| uv.x), cut.texel_uvs.map(|uv| uv.y)].map(blend);
        Self { total: blend([1.0; 3]), along, weights, cut }
    }

    /// Adds the solid parts of a span that lies on the triangle.
    pub fn solid_parts<S: Simd>(&self, simd: S, span: [f64; 2], parts: &mut Parts) {
        simd.vectorize(
            #[inline(always)]
            || self.follow(simd, span, parts),
        );
    }

    #[inline(always)]
    fn follow<S: Simd>(&self, simd: S, [start, end]: [f64; 2], parts: &mut Parts) {
        let mut least_step = LEAST_STEP;
        let mut steps = 0;
        let mut at = start;
        while at < end {
            let texel = self.texel((at + least_step).min(0.5 * (at + end)));
            let (square, verdict) = self.cut.uniform(texel);
            let next = if self.cut.has_texture() { self.next_border(simd, square, at + least_step, end) } else { end };
            match verdict {
                Some(true) => join(parts, [at, next]),
                Some(false) => {}
                None => self.solid_in_texel(texel, [at, next], parts),
            }
            at = next;
            steps += 1;
            if steps == MOST_STEPS {
                least_step = ((end - at) / f64::from(MOST_STEPS)).max(LEAST_STEP);
            }
        }
    }

    /// The texel that is pierced at a diamond angle.
    fn texel(&self, u: f64) -> [i64; 2] {
        let [x, y] = of_diamond(u);
        let direction = DVec3::new(x, y, (x * x + y * y).sqrt());
        let uv = DVec2::new(self.along[0].dot(direction), self.along[1].dot(direction)) / self.total.dot(direction);
        [uv.x, uv.y].map(|at| at.floor().clamp(-1e9, 1e9) as i64)
    }

    /// Where the curve first leaves the square after `from`, or `end`: the four borders at once, as [`half_space`] does one.
    #[inline(always)]
    fn next_border<S: Simd>(&self, simd: S, [columns, rows]: [[i64; 2]; 2], from: f64, end: f64) -> f64 {
        let borders = f64x4::simd_from(simd, [columns[0], columns[1], rows[0], rows[1]].map(|at| at as f64));
        let [u, v] = self.along;
        let a = f64x4::simd_from(simd, [u.x, u.x, v.x, v.x]) - borders * self.total.x;
        let b = f64x4::simd_from(simd, [u.y, u.y, v.y, v.y]) - borders * self.total.y;
        let c = f64x4::simd_from(simd, [u.z, u.z, v.z, v.z]) - borders * self.total.z;
        let zero = f64x4::splat(simd, 0.0);
        let d = a * a + b * b - c * c;
        let w = d.max(zero).sqrt();
        let (ca, cb, wa, wb) = (c * a, c * b, w * a, w * b);
        let ends = [diamond4(simd, wb - ca, zero - cb - wa), diamond4(simd, zero - ca - wb, wa - cb)];
        let is_met = d.simd_gt(zero);
        let far = f64x4::splat(simd, end);
        let after = |u: f64x4<S>| (is_met & u.simd_ge(from)).select(u, far);
        let next: [f64; 4] = after(ends[0]).min(after(ends[1])).into();
        next.into_iter().fold(end, f64::min)
    }

    fn solid_in_texel(&self, texel: [i64; 2], [start, end]: [f64; 2], parts: &mut Parts) {
        let alpha = self.cut.alpha_of(texel);
        let [a, b, c] = self.cut.alphas.map(|own| own * alpha - self.cut.cutoff);
        let n = self.weights[0] * a + self.weights[1] * b + self.weights[2] * c;
        for span in half_space(n.x, n.y, n.z).as_slice() {
            join(parts, [span[0].max(start), span[1].min(end)]);
        }
    }
}

#[inline(always)]
fn diamond4<S: Simd>(simd: S, x: f64x4<S>, y: f64x4<S>) -> f64x4<S> {
    let zero = f64x4::splat(simd, 0.0);
    let r = y / (x.abs() + y.abs());
    let side = y.simd_lt(zero).select(f64x4::splat(simd, -2.0), f64x4::splat(simd, 2.0));
    x.simd_lt(zero).select(side - r, r)
}

/// Adds a span that starts no earlier than those before it.
fn join(parts: &mut Parts, span: [f64; 2]) {
    match parts.last_mut() {
        _ if span[0] >= span[1] => {}
        Some(last) if last[1] >= span[0] => last[1] = last[1].max(span[1]),
        _ => parts.push(span),
    }
}
