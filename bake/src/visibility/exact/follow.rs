//! Following the sun across textures with holes, a few curves at a time.
//!
//! Each curve goes from border to border: two lie ahead, the earlier is crossed, and the texel beyond it (with the square of
//! equal texels that lies ahead) gives the next two. Where there are two crossings at once either may come first, since the other
//! follows in a step of no length. A step waits for the one before it, through a root and two quotients, so a few curves
//! take turns: their steps overlap in the processor.

use super::alpha_mask::{Curve, Pierced, texel_of, value};

/// Curves that take turns.
const COURSES: usize = 4;
/// How far into a curve its first texel is looked up: some tens of microseconds of a day.
const LEAST_STEP: f64 = 1e-9;
/// A crossing that rounding has put up to so far back is taken for one right here.
const ROUNDING: f64 = 1e-7;
/// How far outside its square a coordinate may be for rounding's sake, in texels.
const TEXEL_ROUNDING: f64 = 1e-6;
/// After so many steps on one curve the rest is covered in as many: texture coordinates may tile without bound.
const MOST_STEPS: u32 = 65_536;

/// What a triangle hides for sure.
#[derive(Debug, Clone, Copy)]
pub(super) struct Solid {
    pub slot: usize,
    pub lane: usize,
    pub span: [f64; 2],
}

/// Curves to be followed, and what was found on them.
#[derive(Default)]
pub(super) struct Follower<'a> {
    pierced: Vec<Pierced<'a>>,
    /// Each on one of the triangles; the first ones have been taken up.
    curves: Vec<(usize, Curve)>,
    taken: usize,
    pub found: Vec<Solid>,
}

/// One curve being followed.
#[derive(Clone, Copy)]
struct Course {
    /// Its index.
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
    pub fn add(&mut self, pierced: Pierced<'a>, spans: impl Iterator<Item = [f64; 2]>) {
        let index = self.pierced.len();
        for span in spans {
            if pierced.cut.has_texture() {
                pierced.curves(span, |curve| self.curves.push((index, curve)));
                continue;
            }
            let Pierced { slot, lane, .. } = pierced;
            let mut add = |span| self.found.push(Solid { slot, lane, span });
            match pierced.cut.uniform([0, 0]).1 {
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

    /// Forgets what was followed and found.
    pub fn clear(&mut self) {
        self.pierced.clear();
        self.curves.clear();
        self.found.clear();
        self.taken = 0;
    }

    /// Follows all curves to their ends.
    pub fn follow(&mut self) {
        let mut courses = [None; COURSES];
        courses.iter_mut().for_each(|course| *course = self.start());
        while courses.iter().any(Option::is_some) {
            for course in &mut courses {
                if course.as_mut().is_some_and(|running| !self.step(running)) {
                    *course = self.start();
                }
            }
        }
    }

    /// Takes up the next curve, if there is one.
    fn start(&mut self) -> Option<Course> {
        let (_, curve) = self.curves.get(self.taken)?;
        let [from, to] = curve.ends;
        let mut course = Course {
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
        self.enter(&mut course);
        Some(course)
    }

    /// Looks at the texel that a course has come to.
    #[inline]
    fn enter(&mut self, course: &mut Course) {
        let (on, curve) = &self.curves[course.curve];
        let on = &self.pierced[*on];
        let (square, verdict) = on.cut.uniform_ahead(course.texel, curve.grows);
        course.square = square;
        match (verdict, course.solid_since) {
            (Some(true), None) => course.solid_since = Some(curve.u_of(course.at)),
            (Some(false) | None, Some(since)) => {
                self.found.push(Solid { slot: on.slot, lane: on.lane, span: [since, curve.u_of(course.at)] });
                course.solid_since = None;
            }
            _ => {}
        }
        course.in_part_since = verdict.is_none().then(|| curve.u_of(course.at));
    }

    /// Goes to the next border and over it; false if the curve ends before.
    #[inline]
    fn step(&mut self, course: &mut Course) -> bool {
        let (on, curve) = &self.curves[course.curve];
        let on = &self.pierced[*on];
        let crossings = [crossing(curve, 0, course), crossing(curve, 1, course)];
        let axis = usize::from(crossings[0] > crossings[1]);
        let next = crossings[axis].min(curve.ends[1]);
        if let Some(since) = course.in_part_since {
            let add = |span| self.found.push(Solid { slot: on.slot, lane: on.lane, span });
            on.solid_in_texel(course.texel, curve.side, [since, curve.u_of(next)], add);
        }
        if next >= curve.ends[1] {
            let solid = |since| Solid { slot: on.slot, lane: on.lane, span: [since, curve.ends_u[1]] };
            self.found.extend(course.solid_since.map(solid));
            return false;
        }
        let grows = curve.grows[axis];
        course.texel[axis] = course.square[axis][usize::from(grows)] - i64::from(!grows);
        let [low, high] = course.square[1 - axis];
        let along = value(curve.quadratics[1 - axis], next) / value(curve.quadratics[2], next);
        let is_inside = along >= low as f64 - TEXEL_ROUNDING && along <= high as f64 + TEXEL_ROUNDING;
        let beside = texel_of(along);
        course.texel[1 - axis] = if is_inside { beside.clamp(low, high - 1) } else { beside };
        course.at = next;
        course.steps += 1;
        if course.steps >= MOST_STEPS {
            course.hurry(curve);
        }
        self.enter(course);
        true
    }
}

impl Course {
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

/// Where a coordinate next crosses the border of its square in the way that it runs: of both roots of `U - k W`, signed so
/// that it grows, the one with a positive slope.
#[inline(always)]
fn crossing(curve: &Curve, axis: usize, course: &Course) -> f64 {
    let grows = curve.grows[axis];
    let border = course.square[axis][usize::from(grows)] as f64;
    let sign = if grows { 1.0 } else { -1.0 };
    let [u, w] = [curve.quadratics[axis], curve.quadratics[2]];
    let (a, b, c) = ((u[0] - border * w[0]) * sign, (u[1] - border * w[1]) * sign, (u[2] - border * w[2]) * sign);
    let d = b * b - 4.0 * a * c;
    let root = d.max(0.0).sqrt();
    let s = if b < 0.0 { (root - b) / (2.0 * a) } else { -2.0 * c / (b + root) };
    // Where it turns within rounding of the border it may be past it from the start. Of what is not a number, nothing.
    if d < 0.0 && a > 0.0 {
        return course.at;
    }
    if d >= 0.0 && s >= course.at - ROUNDING { s.max(course.at) } else { f64::INFINITY }
}
