//! Which part of an occluded span an alpha-masked triangle really occludes.
//!
//! **Theory.** While the sun moves, the point where its ray pierces the triangle runs along a curve, and the texture
//! coordinate there is `sum(w_i uv_i) / sum(w_i)`, the weights w_i being the products of the edge normals with the
//! direction. With `s = tan(h / 2)` a direction is `(1 - s^2, 2 s, 1 + s^2)`, less a factor that falls out, so
//! coordinates are quotients of quadratics in s, `U / W` and `V / W`. A border between two columns of texels is crossed
//! where `U - k W = 0`: again known in closed form. So the curve is followed from texel to texel, and none is skipped
//! except within its first microseconds. Squares of texels that are solid or clear throughout are crossed in one step.
//! In a texel where the corners' own alphas matter, alpha passes the cutoff at the end of a half space.
//!
//! **Practice.** A curve is cut where a coordinate turns back ([`Curve`]), and where s would grow beyond one. On each
//! piece both coordinates run one way, so that just two borders lie ahead, and each is crossed at one known root.
//! `follow.rs` follows a few at a time.

use super::arc::{Declination, half_space, of_diamond};
use crate::trace::MaskedTriangle;
use glam::DVec3;
use smallvec::SmallVec;

/// An alpha-masked triangle, seen from a point along one lane.
pub(super) struct MaskedTriangleView<'a> {
    pub mask: MaskedTriangle<'a>,
    /// Which triangle of a batch it is, and along which lane it is seen.
    pub index_in_batch: usize,
    pub lane: usize,
    /// For each corner, the normal of the opposite edge with the declination worked in: its product with
    /// (cos h, sin h, 1) is the corner's weight. Where the triangle is pierced all have one sign, the positive one
    /// after [`MaskedTriangleView::side`].
    weights: [DVec3; 3],
    /// The weights' sums, weighted by each texture coordinate, and their plain sum.
    sums: [DVec3; 3],
}

impl<'a> MaskedTriangleView<'a> {
    /// From the corners relative to the point, arc frame.
    pub fn new(
        mask: MaskedTriangle<'a>,
        [index_in_batch, lane]: [usize; 2],
        [a, b, c]: [DVec3; 3],
        declination: Declination,
    ) -> Self {
        let normals = [b.cross(c), c.cross(a), a.cross(b)];
        let scale = DVec3::new(declination.cos, declination.cos, declination.sin);
        let weights = normals.map(|n| n * scale);
        let blend = |values: [f64; 3]| weights[0] * values[0] + weights[1] * values[1] + weights[2] * values[2];
        let sums = [mask.texel_uvs.map(|uv| uv.x), mask.texel_uvs.map(|uv| uv.y), [1.0; 3]].map(blend);
        Self { mask, index_in_batch, lane, weights, sums }
    }

    /// 1 if weights are positive on a span on which the triangle is pierced, else -1. It depends on the side that the
    /// triangle is seen from, and on whether it is pierced ahead of the point or, within the run-up of rays, behind it.
    pub fn side(&self, [start, end]: [f64; 2]) -> f64 {
        let [x, y] = of_diamond(0.5 * (start + end));
        1f64.copysign(self.sums[2].dot(DVec3::new(x, y, (x * x + y * y).sqrt())))
    }

    /// The pieces of a span of diamond angle on which both texture coordinates run one way.
    pub fn curves(&self, [start, end]: [f64; 2], mut add: impl FnMut(Curve)) {
        let side = self.side([start, end]);
        for (low, high, middle) in [(-2.0, -1.0, -2.0), (-1.0, 1.0, 0.0), (1.0, 2.0, 2.0)] {
            let span = [start.max(low), end.min(high)];
            if span[0] < span[1] {
                self.curves_about(middle, side, span, &mut add);
            }
        }
    }

    /// The same for a span within a quarter turn of the diamond angle `middle`: 0, 2 or -2.
    fn curves_about(&self, middle: f64, side: f64, [start, end]: [f64; 2], add: &mut impl FnMut(Curve)) {
        let towards = if middle == 0.0 { side } else { -side };
        let quadratics = self.sums.map(|sum| {
            let (x, y, z) = (sum.x * towards, sum.y * towards, sum.z * side);
            [z - x, 2.0 * y, z + x]
        });
        let turns = [turning(quadratics[0], quadratics[2]), turning(quadratics[1], quadratics[2])];
        let ends = [s_of(start - middle), s_of(end - middle)];
        let mut stops: SmallVec<[f64; 6]> = turns.iter().flat_map(|&turn| roots(turn)).collect();
        stops.retain(|s| ends[0] < *s && *s < ends[1]);
        stops.sort_unstable_by(f64::total_cmp);
        stops.push(ends[1]);
        let (mut from, mut from_u) = (ends[0], start);
        for (index, &to) in stops.iter().enumerate() {
            let to_u = if index + 1 == stops.len() { end } else { middle + local_u_of(to) };
            let half_way = 0.5 * (from + to);
            let grows = turns.map(|turn| value(turn, half_way) >= 0.0);
            add(Curve { quadratics, side, middle, ends: [from, to], ends_u: [from_u, to_u], grows });
            (from, from_u) = (to, to_u);
        }
    }

    /// Adds what is solid of a span that lies in one texel.
    pub fn solid_in_texel(&self, texel: [i64; 2], side: f64, [start, end]: [f64; 2], mut add: impl FnMut([f64; 2])) {
        let alpha = self.mask.alpha_of(texel);
        let [a, b, c] = self.mask.alphas.map(|own| (own * alpha - self.mask.cutoff) * side);
        let n = self.weights[0] * a + self.weights[1] * b + self.weights[2] * c;
        half_space(n.x, n.y, n.z).as_slice().iter().for_each(|span| add([span[0].max(start), span[1].min(end)]));
    }
}

/// A curve across a triangle's texture on which both coordinates run one way.
#[derive(Debug, Clone, Copy)]
pub(super) struct Curve {
    /// Of U, V and W, from the square down; W is positive.
    pub quadratics: [[f64; 3]; 3],
    /// What made it so: see [`MaskedTriangleView::side`].
    pub side: f64,
    /// Diamond angle at which s is 0.
    middle: f64,
    /// Where it starts and ends, as s and as diamond angles.
    pub ends: [f64; 2],
    pub ends_u: [f64; 2],
    /// Whether each coordinate grows along it.
    pub grows: [bool; 2],
}

impl Curve {
    /// Diamond angle of a place on the curve.
    pub fn u_of(&self, s: f64) -> f64 {
        match s {
            s if s <= self.ends[0] => self.ends_u[0],
            s if s >= self.ends[1] => self.ends_u[1],
            s => self.middle + local_u_of(s),
        }
    }

    /// The texel that is pierced.
    pub fn texel(&self, s: f64) -> [i64; 2] {
        let [u, v, w] = self.quadratics.map(|quadratic| value(quadratic, s));
        [texel_of(u / w), texel_of(v / w)]
    }
}

/// The texel that holds a coordinate.
#[inline]
pub(super) fn texel_of(coordinate: f64) -> i64 {
    let whole = coordinate.clamp(-1e9, 1e9) as i64;
    whole - i64::from((whole as f64) > coordinate)
}

/// `a s^2 + b s + c`.
#[inline]
pub(super) fn value([a, b, c]: [f64; 3], s: f64) -> f64 {
    (a * s + b) * s + c
}

/// What has the sign of the derivative of `u / w`.
fn turning([u2, u1, u0]: [f64; 3], [w2, w1, w0]: [f64; 3]) -> [f64; 3] {
    [u2 * w1 - u1 * w2, 2.0 * (u2 * w0 - u0 * w2), u1 * w0 - u0 * w1]
}

/// Roots of a quadratic, without cancellation. Roots that do not exist are not finite.
fn roots([a, b, c]: [f64; 3]) -> [f64; 2] {
    let d = b * b - 4.0 * a * c;
    let q = -0.5 * (b + d.sqrt().copysign(b));
    [q / a, c / q]
}

/// `tan(h / 2)` of a diamond angle from -1 to 1.
fn s_of(u: f64) -> f64 {
    let [x, y] = of_diamond(u);
    y / ((x * x + y * y).sqrt() + x)
}

/// Diamond angle of `tan(h / 2)`, from -1 to 1.
fn local_u_of(s: f64) -> f64 {
    2.0 * s / (1.0 - s * s + 2.0 * s.abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::pseudo_random;

    /// A triangle in front of the sun that is solid, by its corners' alphas, on one side: that side is solid whether
    /// it lies ahead or behind, as it may within the run-up of rays.
    #[test]
    fn the_solid_part_does_not_depend_on_the_sign_of_the_weights() {
        let equator = Declination { cos: 1.0, sin: 0.0 };
        for ahead in [1.0, -1.0] {
            let corners = [(-1.0, -1.0), (3.0, -1.0), (-1.0, 3.0)].map(|(y, z)| DVec3::new(ahead, y, z));
            let mask = MaskedTriangle::of_alphas([0.0, 1.0, 0.0], 0.25);
            let pierced = MaskedTriangleView::new(mask, [0, 0], corners, equator);
            let span = [-0.4, 0.4];
            let mut solid = Vec::new();
            pierced.solid_in_texel([0, 0], pierced.side(span), span, |span| solid.push(span));
            solid.retain(|span| span[0] < span[1]);
            // Alpha is (y + 1) / 4, and passes a quarter at y = 0, which is straight ahead.
            assert_eq!(solid.len(), 1);
            let expected = if ahead > 0.0 { [0.0, 0.4] } else { [-0.4, 0.0] };
            assert!((0..2).all(|k| (solid[0][k] - expected[k]).abs() < 1e-12), "{solid:?}, not {expected:?}");
        }
    }

    #[test]
    fn half_tangents_turn_back_into_diamond_angles() {
        for step in -1000..=1000 {
            let u = f64::from(step) / 1000.0;
            assert!((local_u_of(s_of(u)) - u).abs() < 4e-16, "{u}");
        }
    }

    #[test]
    fn roots_are_roots_and_quotients_turn_there() {
        let mut state = 17;
        let mut random = || 2.0 * pseudo_random(&mut state) - 1.0;
        for _ in 0..10_000 {
            let [u, w] = [(); 2].map(|()| [random(), random(), random()]);
            let turn = turning(u, w);
            for s in roots(turn).into_iter().filter(|s| s.is_finite()) {
                let size = turn[0].abs() * s * s + turn[1].abs() * s.abs() + turn[2].abs();
                assert!(value(turn, s).abs() <= 1e-14 * size, "{turn:?} is {} at {s}", value(turn, s));
            }
            let s = random();
            let (du, dw) = (2.0 * u[0] * s + u[1], 2.0 * w[0] * s + w[1]);
            let slope = du * value(w, s) - value(u, s) * dw;
            assert!((value(turn, s) - slope).abs() < 1e-14, "{u:?} / {w:?} at {s}");
        }
    }
}
