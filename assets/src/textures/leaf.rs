//! A spray of small leaves along a twig, cut out by alpha.

use glam::{DVec2, dvec2};

use super::pixmap::{Pixmap, Rgb, blend};
use crate::noise::{Rng, smoothstep};
use crate::trig::{cos, sin};

/// One leaf: an almond from `base` along the unit vector `along`.
struct Leaf {
    base: DVec2,
    along: DVec2,
    long: f64,
    wide: f64,
    tone: f64,
}

impl Leaf {
    /// Signed distance-like measure: positive inside, in units of the picture.
    fn depth(&self, p: DVec2) -> f64 {
        let from_base = p - self.base;
        let t = from_base.dot(self.along) / self.long;
        let across = from_base.perp_dot(self.along).abs();
        4.0 * t * (1.0 - t) * self.wide * 0.5 - across
    }

    fn color(&self, p: DVec2) -> Rgb {
        let across = (p - self.base).perp_dot(self.along).abs();
        let vein = smoothstep(0.006, 0.002, across);
        let green = blend([0.33, 0.42, 0.16], [0.55, 0.60, 0.28], self.tone);
        blend(green, [0.70, 0.70, 0.42], vein * 0.6)
    }
}

/// Twigs as segments, and the leaves on both of their sides.
fn spray() -> (Vec<[DVec2; 2]>, Vec<Leaf>) {
    let mut rng = Rng::new(7);
    let stem = [dvec2(0.5, 0.99), dvec2(0.5, 0.12)];
    let mut twigs = vec![stem];
    for (y, side) in [(0.80, 1.0), (0.72, -1.0), (0.56, 1.0), (0.46, -1.0), (0.32, 1.0)] {
        let base = dvec2(0.5, y);
        twigs.push([base, base + dvec2(side * (0.16 + 0.22 * y), -0.20)]);
    }
    let mut leaves = Vec::new();
    for [from, to] in &twigs {
        let count = ((*to - *from).length() / 0.052) as usize;
        for k in 1..=count {
            let base = from.lerp(*to, k as f64 / count as f64);
            for side in [-1.0, 1.0] {
                leaves.push(leaf_at(base, (*to - *from).normalize(), side, &mut rng));
            }
        }
    }
    (twigs, leaves)
}

fn leaf_at(base: DVec2, along: DVec2, side: f64, rng: &mut Rng) -> Leaf {
    let angle = side * rng.range(0.6, 1.0);
    Leaf {
        base,
        along: dvec2(cos(angle), sin(angle)).rotate(along),
        long: rng.range(0.09, 0.125),
        wide: rng.range(0.040, 0.052),
        tone: rng.unit(),
    }
}

fn segment_distance(p: DVec2, [a, b]: [DVec2; 2]) -> f64 {
    let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
    p.distance(a.lerp(b, t))
}

/// The leaf texture: 256 x 256 with alpha. Where nothing grows, the colour stays green, so that filtering does not
/// fringe.
pub(crate) fn pixmap() -> Pixmap {
    let (twigs, leaves) = spray();
    Pixmap::paint_alpha(256, 256, |u, v| {
        let p = dvec2(u, v);
        let mut rgb = [0.42, 0.47, 0.22];
        let mut depth = f64::NEG_INFINITY;
        for &twig in &twigs {
            let inside = 0.007 - segment_distance(p, twig);
            if inside > depth {
                (rgb, depth) = ([0.36, 0.29, 0.18], inside);
            }
        }
        for leaf in &leaves {
            let inside = leaf.depth(p);
            if inside > depth.min(0.0) {
                (rgb, depth) = (leaf.color(p), inside);
            }
        }
        let alpha = smoothstep(-0.003, 0.003, depth);
        [rgb[0], rgb[1], rgb[2], alpha]
    })
}
