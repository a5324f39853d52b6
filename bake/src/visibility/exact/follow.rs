//! Following the sun across alpha masks, a few curves at a time.
//!
//! Each curve goes from border to border: two lie ahead, the earlier is crossed, and the texel beyond it (with the
//! square of equal texels that lies ahead) gives the next two. Where there are two crossings at once either may come
//! first, since the other follows in a step of no length. A step waits for the one before it, through a root and two
//! quotients, so a few curves take turns: their steps overlap in the processor.

use super::alpha_mask::{Curve, MaskedTriangleView, texel_of, value};

/// Curves that are followed in turns.
const CURVE_WALKS: usize = 4;
/// How far into a curve its first texel is looked up: some tens of microseconds of a day.
const LEAST_STEP: f64 = 1e-9;
/// A crossing that rounding has moved back by up to this much counts as one at the current place.
const ROUNDING: f64 = 1e-7;
/// How far outside its square a coordinate may be for rounding's sake, in texels.
const TEXEL_ROUNDING: f64 = 1e-6;
/// After this many steps on one curve, the rest is covered in as many: texture coordinates may repeat without bound.
const MOST_STEPS: u32 = 65_536;

/// A span that a triangle occludes.
#[derive(Debug, Clone, Copy)]
pub(super) struct SolidSpan {
    pub index_in_batch: usize,
    pub lane: usize,
    /// Diamond angles.
    pub span: [f64; 2],
}

impl SolidSpan {
    fn of(triangle: &MaskedTriangleView, span: [f64; 2]) -> Self {
        Self { index_in_batch: triangle.index_in_batch, lane: triangle.lane, span }
    }
}

/// Curves to be followed, and what was found on them.
#[derive(Default)]
pub(super) struct Follower<'a> {
    pierced: Vec<MaskedTriangleView<'a>>,
    /// Each with the index of its triangle; the first `taken` have been started.
    curves: Vec<(usize, Curve)>,
    taken: usize,
    pub found: Vec<SolidSpan>,
}

/// One curve being followed.
#[derive(Clone, Copy)]
struct CurveWalk {
    /// Index in [`Follower::curves`].
    curve: usize,
    /// How far along it.
    at: f64,
    texel: [i64; 2],
    square: [[i64; 2]; 2],
    /// Since when the texels have been solid.
    solid_since: Option<f64>,
    /// Since when it has been in a texel that may be solid in part.
    in_part_since: Option<f64>,
    steps: u32,
    /// Least step, once there have been very many.
    least_step: f64,
}

impl<'a> Follower<'a> {
    /// Adds the spans of diamond angle on which a triangle is pierced.
    pub fn add(&mut self, pierced: MaskedTriangleView<'a>, spans: impl Iterator<Item = [f64; 2]>) {
        let index = self.pierced.len();
        for span in spans {
            if pierced.mask.has_texture() {
                pierced.curves(span, |curve| self.curves.push((index, curve)));
                continue;
            }
            let mut add = |span| self.found.push(SolidSpan::of(&pierced, span));
            match pierced.mask.uniform([0, 0]).1 {
                Some(true) => add(span),
                Some(false) => {}
                None => pierced.solid_in_texel([0, 0], pierced.side(span), span, add),
            }
        }
        self.pierced.push(pierced);
    }

    /// Whether there is anything to follow.
    pub fn is_empty(&self) -> bool {
        self.pierced.is_empty()
    }

    /// Removes all curves and spans.
    pub fn clear(&mut self) {
        self.pierced.clear();
        self.curves.clear();
        self.found.clear();
        self.taken = 0;
    }

    /// Follows all curves to their ends.
    pub fn follow(&mut self) {
        let mut walks = [None; CURVE_WALKS];
        walks.iter_mut().for_each(|walk| *walk = self.start());
        while walks.iter().any(Option::is_some) {
            for walk in &mut walks {
                if walk.as_mut().is_some_and(|running| !self.step(running)) {
                    *walk = self.start();
                }
            }
        }
    }

    /// Starts the next curve, if there is one.
    fn start(&mut self) -> Option<CurveWalk> {
        let (_, curve) = self.curves.get(self.taken)?;
        let [from, to] = curve.ends;
        let mut walk = CurveWalk {
            curve: self.taken,
            at: from,
            texel: curve.texel((from + LEAST_STEP).min(0.5 * (from + to))),
            square: Default::default(),
            solid_since: None,
            in_part_since: None,
            steps: 0,
            least_step: 0.0,
        };
        self.taken += 1;
        self.enter(&mut walk);
        Some(walk)
    }

    /// Evaluates the texel that a walk has come to.
    #[inline]
    fn enter(&mut self, walk: &mut CurveWalk) {
        let (on, curve) = &self.curves[walk.curve];
        let on = &self.pierced[*on];
        let (square, verdict) = on.mask.uniform_ahead(walk.texel, curve.grows);
        walk.square = square;
        match (verdict, walk.solid_since) {
            (Some(true), None) => walk.solid_since = Some(curve.u_of(walk.at)),
            (Some(false) | None, Some(since)) => {
                self.found.push(SolidSpan::of(on, [since, curve.u_of(walk.at)]));
                walk.solid_since = None;
            }
            _ => {}
        }
        walk.in_part_since = verdict.is_none().then(|| curve.u_of(walk.at));
    }

    /// Goes to the next border and over it; false if the curve ends before.
    #[inline]
    fn step(&mut self, walk: &mut CurveWalk) -> bool {
        let (on, curve) = &self.curves[walk.curve];
        let on = &self.pierced[*on];
        let crossings = [crossing(curve, 0, walk), crossing(curve, 1, walk)];
        let axis = usize::from(crossings[0] > crossings[1]);
        let next = crossings[axis].min(curve.ends[1]);
        if let Some(since) = walk.in_part_since {
            let add = |span| self.found.push(SolidSpan::of(on, span));
            on.solid_in_texel(walk.texel, curve.side, [since, curve.u_of(next)], add);
        }
        if next >= curve.ends[1] {
            let solid = |since| SolidSpan::of(on, [since, curve.ends_u[1]]);
            self.found.extend(walk.solid_since.map(solid));
            return false;
        }
        let grows = curve.grows[axis];
        walk.texel[axis] = walk.square[axis][usize::from(grows)] - i64::from(!grows);
        let [low, high] = walk.square[1 - axis];
        let along = value(curve.quadratics[1 - axis], next) / value(curve.quadratics[2], next);
        let is_inside = along >= low as f64 - TEXEL_ROUNDING && along <= high as f64 + TEXEL_ROUNDING;
        let beside = texel_of(along);
        walk.texel[1 - axis] = if is_inside { beside.clamp(low, high - 1) } else { beside };
        walk.at = next;
        walk.steps += 1;
        if walk.steps >= MOST_STEPS {
            walk.hurry(curve);
        }
        self.enter(walk);
        true
    }
}

impl CurveWalk {
    /// Goes on by the least step after very many.
    #[cold]
    fn hurry(&mut self, curve: &Curve) {
        if self.steps == MOST_STEPS {
            self.least_step = ((curve.ends[1] - self.at) / f64::from(MOST_STEPS)).max(LEAST_STEP);
        }
        self.at = (self.at + self.least_step).min(curve.ends[1]);
        self.texel = curve.texel(self.at);
    }
}

/// Where a coordinate next crosses the border of its square in the way that it runs: of both roots of `U - k W`, signed
/// so that it grows, the one with a positive slope.
#[inline(always)]
fn crossing(curve: &Curve, axis: usize, walk: &CurveWalk) -> f64 {
    let grows = curve.grows[axis];
    let border = walk.square[axis][usize::from(grows)] as f64;
    let sign = if grows { 1.0 } else { -1.0 };
    let [u, w] = [curve.quadratics[axis], curve.quadratics[2]];
    let (a, b, c) = ((u[0] - border * w[0]) * sign, (u[1] - border * w[1]) * sign, (u[2] - border * w[2]) * sign);
    let d = b * b - 4.0 * a * c;
    let root = d.max(0.0).sqrt();
    let s = if b < 0.0 { (root - b) / (2.0 * a) } else { -2.0 * c / (b + root) };
    // Where it turns within rounding of the border it may be past it from the start. NaN yields no crossing.
    if d < 0.0 && a > 0.0 {
        return walk.at;
    }
    if d >= 0.0 && s >= walk.at - ROUNDING { s.max(walk.at) } else { f64::INFINITY }
}
