//! Every engine with its claimed accuracy, and the check that it is as accurate as that.

use crate::{Agreement, Oracle, Traced};
use sunbake::atlas::SurfacePoint;
use sunbake::sun::SunPath;
use sunbake::trace::Tracer;
use sunbake::visibility::{BisectEngine, Engine, ExactEngine, Intervals, RayEngine, lit_at};

/// An engine and its claims.
pub struct Candidate {
    /// Makes an engine for the lanes of a path.
    pub make: for<'a> fn(&'a Tracer, &[SunPath]) -> Box<dyn Engine + 'a>,
    /// How far from an edge of brute force it may be wrong, in `t`; a lit or dark interval of twice that cannot be
    /// missed.
    pub blind_interval_t: f64,
    /// How far off an edge that it finds may be, in `t`.
    pub edge_t: fn(&SunPath) -> f64,
    /// Suns of brute force that are just its own, where there are such: it cannot disagree about any.
    pub own_suns: Option<usize>,
}

/// Evenly spaced rays: wrong up to half a step from an edge, and never further.
pub const RAYS: Candidate = Candidate {
    make: |tracer, lanes| Box::new(RayEngine::new(tracer, lanes, 256)),
    blind_interval_t: 0.5 / 256.0,
    edge_t: |_| 0.5 / 256.0,
    own_suns: Some(256),
};

/// Bisection: misses intervals shorter than its coarse step; edges that it finds are within one second. It may be wrong
/// up to a whole step from an edge, not half: it tests the very end of a lit or dark interval, where the sun may be
/// seen for less time than brute force resolves, and takes what is up to a step beside it for the same.
pub const BISECT: Candidate = Candidate {
    make: |tracer, lanes| Box::new(BisectEngine::new(tracer, lanes, 64, 1.0)),
    blind_interval_t: 1.0 / 63.0,
    edge_t: |path| seconds_t(path, 1.0),
    own_suns: None,
};

/// The engine that finds every interval.
pub const EXACT: Candidate = Candidate {
    make: |tracer, lanes| Box::new(ExactEngine::new(tracer, lanes)),
    blind_interval_t: 0.0,
    edge_t: |_| 1e-9,
    own_suns: None,
};

/// Whether the exact engine misses no interval, however short.
pub const FINDS_ALL: bool = EXACT.blind_interval_t == 0.0;

/// Every engine.
pub const ALL: [Candidate; 3] = [RAYS, BISECT, EXACT];

/// Suns of brute force in cases made by code.
pub const SUNS: usize = 4096;
/// What looks wrong is compared again with this many times more suns: a lit or dark interval may lie between two suns.
/// (One that is shorter still and yet meets a ray is rare: one in 20,000 random cases, with [`RAYS`], which have suns
/// of their own.)
const CLOSER: usize = 512;

/// Seconds of a path's clock, in `t`.
pub fn seconds_t(path: &SunPath, seconds: f64) -> f64 {
    seconds / (60.0 * path.duration_min)
}

impl Candidate {
    /// When a point sees the sun.
    pub fn lit(&self, here: &Traced, path: &SunPath, point: &SurfacePoint) -> Intervals {
        lit_at((self.make)(&here.tracer, std::slice::from_ref(path)).as_ref(), point).swap_remove(0)
    }

    /// Describes what is wrong with the engine's answer for a point, if anything is.
    pub fn disagreement(&self, here: &Traced, path: &SunPath, point: &SurfacePoint, truth: &[bool]) -> Option<String> {
        let found = self.lit(here, path, point);
        if self.is_within_claims(path, &found, truth) {
            return None;
        }
        let closer = Oracle::new(here, path, self.own_suns.unwrap_or(CLOSER * truth.len())).lit(point);
        let name = (self.make)(&here.tracer, &[]).name();
        let agreement = Agreement::of(&found, &closer);
        let is_within_claims = match self.own_suns {
            Some(_) => agreement.beside_an_edge + agreement.elsewhere == 0,
            None => self.is_within_claims(path, &found, &closer),
        };
        (!is_within_claims).then(|| format!("{name}: {agreement:?}\nfound {found:?}\nof {point:?}\nalong {path:?}"))
    }

    fn is_within_claims(&self, path: &SunPath, found: &Intervals, truth: &[bool]) -> bool {
        // An interval so short that its ends may be in either order may be none.
        let agreement = Agreement::of(&lasting(found, 1.999 * (self.edge_t)(path)), truth);
        // An edge of brute force lies anywhere between two of its suns.
        let unsure_t = 0.5001 / truth.len() as f64;
        agreement.furthest_t <= self.blind_interval_t + unsure_t
            && agreement.edge_error_t <= (self.edge_t)(path) + unsure_t
    }
}

/// Intervals without lit or dark ones shorter than `shortest_t`.
fn lasting(found: &Intervals, shortest_t: f64) -> Intervals {
    let light = found.as_slice().iter().copied().filter(|[start, end]| end - start >= shortest_t);
    let mut joined: Vec<[f64; 2]> = Vec::new();
    for [start, end] in light {
        match joined.last_mut() {
            Some(last) if start - last[1] < shortest_t => last[1] = end,
            _ => joined.push([start, end]),
        }
    }
    Intervals::from_unsorted(joined)
}

/// Asserts that every engine is as accurate as it claims at these points.
#[track_caller]
pub fn all_must_agree(case: &str, here: &Traced, path: &SunPath, points: &[SurfacePoint]) {
    must_agree(&ALL, case, here, path, points);
}

/// Asserts that these engines are as accurate as they claim at these points.
#[track_caller]
pub fn must_agree(engines: &[Candidate], case: &str, here: &Traced, path: &SunPath, points: &[SurfacePoint]) {
    let oracle = Oracle::new(here, path, SUNS);
    for (point, truth) in points.iter().zip(oracle.lit_all(points)) {
        let disagreements: Vec<String> =
            engines.iter().filter_map(|engine| engine.disagreement(here, path, point, &truth)).collect();
        assert!(disagreements.is_empty(), "{case}: {}", disagreements.join("\n"));
    }
}

/// Intervals must be those expected: each found is one of them, each that the engine cannot miss is found.
#[track_caller]
pub fn assert_intervals(case: &str, found: &Intervals, expected: &Intervals, off_t: f64, shortest_t: f64) {
    let is_near = |a: &[f64; 2], b: &[f64; 2]| (a[0] - b[0]).abs() <= off_t && (a[1] - b[1]).abs() <= off_t;
    let is_in = |a: &[f64; 2], list: &Intervals| list.as_slice().iter().any(|b| is_near(a, b));
    let invented = found.as_slice().iter().find(|piece| !is_in(piece, expected));
    let lacking = expected.as_slice().iter().find(|piece| piece[1] - piece[0] > shortest_t && !is_in(piece, found));
    assert_eq!((invented, lacking), (None, None), "{case}: found {found:?}, not {expected:?}");
}
