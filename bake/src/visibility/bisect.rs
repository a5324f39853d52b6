//! N rays a point, then bisection where the answer changes: edges as precise as asked for, at logarithmic cost.
//!
//! Theory: between a visible and an occluded position of the sun lies an edge, and a ray half-way tells in which half.
//! So k rays find an edge to `1/2^k` of a coarse step, where evenly spaced rays would need `2^k` times as many
//! positions.
//!
//! Practice: the horizon and the surface's plane divide the path in closed form, so edges there are exact. Each span
//! between them has its own positions of the sun: its two ends, and those of the N that fall inside it (the first of
//! the N at t = 0, the last at t = 1). Every change from one position to the next is bisected until both sides are
//! `2 * edge_seconds` apart, and the edge is put in the middle. While bisecting, the occluder of the dark side is
//! tested before the hierarchy is walked: it usually causes the edge.
//!
//! What is missed: light or shade that begins and ends between two neighbouring positions, so anything shorter than
//! `1/(N - 1)` of the path may be missed; and of three changes between two positions one is found. Edges that are found
//! are off by at most `edge_seconds`.

use super::probe::Probe;
use super::start::SurfaceSide;
use super::{Engine, IntervalTable, Intervals, Session, Work};
use crate::atlas::SurfacePoint;
use crate::sun::SunPath;
use crate::trace::{Direction, Occluder, Tracer};
use glam::DVec3;

/// Least width of an edge in `t`: the spacing of `f64` is ten thousand times smaller, so bisection always ends.
const FINEST_T: f64 = 1e-12;

/// N evenly spaced suns, and bisection between those that differ.
pub struct BisectEngine<'a> {
    tracer: &'a Tracer,
    count: usize,
    edge_seconds: f64,
    lanes: Vec<BisectLane>,
}

/// A path, and everything that does not depend on the point.
struct BisectLane {
    path: SunPath,
    above_horizon: Intervals,
    /// The coarse suns, evenly spaced from t = 0 to t = 1.
    suns: Vec<Direction>,
    /// Width of an edge, in `t`, at which bisection stops.
    edge_width_t: f64,
}

impl<'a> BisectEngine<'a> {
    /// Places `count` suns (2 at least) along each lane's path. Edges found are off by at most `edge_seconds` of the
    /// path's clock; halving it costs every edge one ray more.
    pub fn new(tracer: &'a Tracer, lanes: &[SunPath], count: usize, edge_seconds: f64) -> Self {
        let count = count.max(2);
        let lanes = lanes.iter().map(|path| BisectLane::new(path, count, edge_seconds)).collect();
        Self { tracer, count, edge_seconds, lanes }
    }
}

impl BisectLane {
    fn new(path: &SunPath, count: usize, edge_seconds: f64) -> Self {
        let sun = |step| Direction::new(path.direction(step as f64 / (count - 1) as f64));
        Self {
            above_horizon: path.above_horizon(DVec3::Y),
            suns: (0..count).map(sun).collect(),
            edge_width_t: (2.0 * edge_seconds / (60.0 * path.duration_min)).max(FINEST_T),
            path: path.clone(),
        }
    }

    /// Spans in which the sun is above the horizon and in front of a start of the point, with that start. Starts that
    /// share a plane share the ends of their spans to the last bit.
    fn spans(&self, point: &SurfacePoint, probe: &Probe) -> Vec<([f64; 2], usize)> {
        let in_front = self.path.above_plane(point.normal);
        let in_shading = point.smooth.map(|smooth| self.path.above_plane(smooth.normal));
        let mut spans = Vec::new();
        for (index, start) in probe.starts().enumerate() {
            let of_side = |when: &Intervals, is_in_front: bool| if is_in_front { when.clone() } else { gaps(when) };
            let is_front = start.side == SurfaceSide::Front;
            let mut when = of_side(&in_front, is_front != start.is_lifted());
            if let Some(in_shading) = &in_shading {
                when = when.intersection(&of_side(in_shading, is_front));
            }
            let up = when.intersection(&self.above_horizon);
            spans.extend(up.as_slice().iter().map(|&span| (span, index)));
        }
        spans
    }

    /// Towards the sun as `t` is reached: where arcs do not quite meet, the end of the one before.
    fn direction_until(&self, t: f64) -> DVec3 {
        let arcs = self.path.arcs();
        let arc = arcs.iter().find(|arc| t <= arc.t[1]).unwrap_or(&arcs[arcs.len() - 1]);
        arc.direction_at_hour_angle(arc.hour_angle_at(t))
    }

    fn step_t(&self) -> f64 {
        1.0 / (self.suns.len() - 1) as f64
    }
}

/// The rest of the path.
fn gaps(intervals: &Intervals) -> Intervals {
    let ends = intervals.as_slice();
    let starts = std::iter::once(0.0).chain(ends.iter().map(|i| i[1]));
    Intervals::from_unsorted(starts.zip(ends.iter().map(|i| i[0]).chain([1.0])).map(|(a, b)| [a, b]).collect())
}

impl Engine for BisectEngine<'_> {
    fn name(&self) -> String {
        format!("bisect:{} --edge-seconds {}", self.count, self.edge_seconds)
    }

    fn lane_count(&self) -> usize {
        self.lanes.len()
    }

    fn session(&self) -> Box<dyn Session + '_> {
        let last_occluder = self.lanes.iter().map(|lane| vec![None; lane.suns.len()]).collect();
        Box::new(BisectSession { engine: self, last_occluder, rays: 0 })
    }
}

struct BisectSession<'a> {
    engine: &'a BisectEngine<'a>,
    /// For each lane and coarse sun.
    last_occluder: Vec<Vec<Option<Occluder>>>,
    rays: u64,
}

impl Session for BisectSession<'_> {
    fn lit(&mut self, points: &[SurfacePoint], answers: &mut IntervalTable) {
        let engine = self.engine;
        for point in points {
            let probe = Probe::new(engine.tracer, point);
            for (lane, last_occluder) in engine.lanes.iter().zip(&mut self.last_occluder) {
                let mut search = Search { lane, probe: &probe, last_occluder, rays: &mut self.rays, lit: Vec::new() };
                lane.spans(point, &probe).into_iter().for_each(|(span, start)| search.span(span, start));
                answers.push(&Intervals::from_unsorted(search.lit));
            }
        }
    }

    fn work(&self) -> Work {
        Work { rays: self.rays, ..Work::default() }
    }
}

/// One point along one lane.
struct Search<'a> {
    lane: &'a BisectLane,
    probe: &'a Probe<'a>,
    last_occluder: &'a mut [Option<Occluder>],
    rays: &'a mut u64,
    lit: Vec<[f64; 2]>,
}

/// A moment, and what occludes the sun then, if anything does.
#[derive(Clone, Copy)]
struct Sample {
    t: f64,
    occluder: Option<Occluder>,
}

impl Sample {
    fn is_lit(&self) -> bool {
        self.occluder.is_none()
    }
}

impl Search<'_> {
    /// Finds the lit intervals within a span.
    fn span(&mut self, [first_t, last_t]: [f64; 2], start: usize) {
        let step_t = self.lane.step_t();
        let inside = (first_t / step_t) as usize + 1..(last_t / step_t).ceil() as usize;
        let first_sun = self.lane.path.direction(first_t);
        let mut before = self.end(first_t, first_sun, start, None);
        let mut lit_since = before.is_lit().then_some(first_t);
        for step in inside {
            let now = self.coarse(step, start, before.occluder);
            lit_since = self.advance(before, now, lit_since, start);
            before = now;
        }
        let end = self.end(last_t, self.lane.direction_until(last_t), start, before.occluder);
        let lit_since = self.advance(before, end, lit_since, start);
        self.lit.extend(lit_since.map(|since| [since, last_t]));
    }

    /// From one moment to the next: adds the lit interval that ended between them, and gives the start of the current
    /// one.
    fn advance(&mut self, before: Sample, now: Sample, lit_since: Option<f64>, start: usize) -> Option<f64> {
        if before.is_lit() == now.is_lit() {
            return lit_since;
        }
        let edge_t = self.edge_t(before, now, start);
        self.lit.extend(lit_since.map(|since| [since, edge_t]));
        now.is_lit().then_some(edge_t)
    }

    /// The edge between a moment that is lit and one that is not.
    fn edge_t(&mut self, mut low: Sample, mut high: Sample, start: usize) -> f64 {
        while high.t - low.t > self.lane.edge_width_t {
            let t = 0.5 * (low.t + high.t);
            let sun = Direction::new(self.lane.path.direction(t));
            let middle = self.trace(t, start, &sun, [low.occluder.or(high.occluder), None]);
            let end = if middle.is_lit() == low.is_lit() { &mut low } else { &mut high };
            *end = middle;
        }
        0.5 * (low.t + high.t)
    }

    fn coarse(&mut self, step: usize, start: usize, before: Option<Occluder>) -> Sample {
        let lane = self.lane;
        let sample =
            self.trace(step as f64 * lane.step_t(), start, &lane.suns[step], [self.last_occluder[step], before]);
        if !sample.is_lit() {
            self.last_occluder[step] = sample.occluder;
        }
        sample
    }

    /// The end of a span. It uses the last occluder of the coarse position next to it.
    fn end(&mut self, t: f64, sun: DVec3, start: usize, before: Option<Occluder>) -> Sample {
        let sun = Direction::new(sun);
        let beside = (t / self.lane.step_t()).round() as usize;
        self.trace(t, start, &sun, [self.last_occluder[beside.min(self.last_occluder.len() - 1)], before])
    }

    fn trace(&mut self, t: f64, start: usize, sun: &Direction, guesses: [Option<Occluder>; 2]) -> Sample {
        *self.rays += 1;
        Sample { t, occluder: self.probe.occluder(start, sun, guesses) }
    }
}
