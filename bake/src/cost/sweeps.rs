//! Knobs turned one at a time on runs of neighbouring texels of the page, each against the same texel's own best answer.
//!
//! * *Engines*: minutes in which a list differs from the exact one (`exact` is itself the reference, so its error is zero;
//!   that it deserves to be is tested against brute force elsewhere).
//! * *Bits* and *layers*: minutes in which the stored list differs from the exact one.
//! * *Lanes*: minutes of the disc's visibility against [`truth::LANES`] lanes at the same texel, before anything is stored.
//! * *Sky*: openness against [`RAYS`] rays with another seed.

use super::budget::Budget;
use super::metric::{self, distribution, symmetric_difference_t};
use super::report::ErrorEntry;
use super::truth;
use super::workload::Workload;
use crate::ambient::AmbientPoint;
use crate::atlas::{Sample, SurfacePoint};
use crate::maps::{Bits, PageEncoder, stored_intervals};
use crate::progress::Progress;
use crate::settings::EngineChoice;
use crate::visibility::{ExactEngine, Intervals};
use rayon::prelude::*;
use std::time::Instant;

/// Texels of a run.
const RUN: usize = 1024;
/// Of each run, texels that are asked about the sky.
const SKY_RUN: usize = 512;
/// Runs that are asked about the sky, at most.
const SKY_RUNS: usize = 8;
/// Every how many texels the disc is compared at.
const DISC_STEP: usize = 4;
/// Rays of sky that a texel's openness is known by.
pub(super) const RAYS: u32 = 16_384;
/// Seconds below which a measurement is made three times, and the least taken: it is over before a machine has settled.
const SHORT_S: f64 = 0.4;

/// What turning a knob gave.
#[derive(Clone, Copy)]
pub(super) struct Turned {
    /// Scaled to the page.
    pub seconds: f64,
    pub gpu_bytes: u64,
    pub sun_min: Option<ErrorEntry>,
    pub open: Option<ErrorEntry>,
}

/// A sample of the page's texels, and their best answers as far as they were needed so far.
pub(super) struct Knobs<'a> {
    workload: &'a Workload,
    samples: Vec<Sample>,
    points: Vec<SurfacePoint>,
    exact: Vec<Intervals>,
    /// Seconds that the exact engine took for the sample.
    pub exact_s: f64,
    /// Seconds that a ray of sky takes, of one texel.
    pub sky_ray_s: f64,
    /// Seconds until the sky can be asked.
    pub sky_ready_s: f64,
    /// Most seconds that one of an engine's suns took, for the sample: of rays, of bisection.
    pub sun_s: [Option<f64>; 2],
    disc: Option<Vec<Vec<f32>>>,
    sky: Option<Vec<(f32, bool)>>,
}

impl<'a> Knobs<'a> {
    /// Draws as many runs as the budget suits, and finds their exact times. None if it was stopped.
    pub fn new(workload: &'a Workload, budget: &Budget) -> Option<Self> {
        budget.task("measuring the exact engine");
        let all = &workload.page.samples;
        let probe: Vec<SurfacePoint> = spread(all, 2).iter().map(|sample| workload.point(sample)).collect();
        let engine = ExactEngine::new(&workload.tracer, &[workload.path().clone()]);
        let (_, probe_s) = workload.solve_visibility(&engine, &probe, budget)?;
        // 4,096 rays take some fifty times as long as the exact answer, and should take a twentieth of the budget.
        let run_s = probe_s * RUN as f64 / probe.len().max(1) as f64;
        let runs = (0.05 * budget.seconds() / (50.0 * run_s.max(1e-9))) as usize;
        let samples = spread(all, runs.clamp(4, 32));
        let points: Vec<SurfacePoint> = samples.iter().map(|sample| workload.point(sample)).collect();
        let (exact, exact_s) = workload.solve_visibility(&engine, &points, budget)?;
        let mut knobs = Self {
            workload,
            samples,
            points,
            exact,
            exact_s,
            sky_ray_s: 0.0,
            sky_ready_s: 0.0,
            sun_s: [None; 2],
            disc: None,
            sky: None,
        };
        let started = Instant::now();
        let engine = workload.sky(64, 0);
        knobs.sky_ready_s = started.elapsed().as_secs_f64();
        let points = knobs.sky_points();
        knobs.sky_ray_s = workload.find_open(&engine, &points, budget)?.1 / (64.0 * points.len().max(1) as f64);
        Some(knobs)
    }

    /// Texels measured on.
    pub fn texel_count(&self) -> usize {
        self.points.len()
    }

    /// Seconds of the sample as seconds of the page.
    fn scaled(&self, seconds: f64) -> f64 {
        seconds * self.workload.page.samples.len() as f64 / self.points.len().max(1) as f64
    }

    /// Seconds of the exact engine for a texel.
    pub fn exact_texel_s(&self) -> f64 {
        self.exact_s / self.points.len().max(1) as f64
    }

    /// Bytes of so many layers of times on the page, as a GPU holds them.
    fn layer_bytes(&self, layers: usize, bits: Bits) -> u64 {
        self.workload.page.texel_count * layers as u64 * 8 * u64::from(bits.count() / 8)
    }

    fn minutes(&self, errors_t: Vec<f64>) -> Option<ErrorEntry> {
        let duration_min = self.workload.path().duration_min;
        distribution(errors_t.into_iter().map(|t| t * duration_min).collect())
    }

    /// Asks once, or thrice if that is soon done.
    fn timed<T>(&self, mut ask: impl FnMut() -> Option<(T, f64)>) -> Option<(T, f64)> {
        let (answer, mut seconds) = ask()?;
        for _ in 0..if seconds < SHORT_S { 2 } else { 0 } {
            seconds = seconds.min(ask()?.1);
        }
        Some((answer, seconds))
    }

    /// An engine; `layer_cap` bounds the bytes that its answers take.
    pub fn engine(&mut self, choice: EngineChoice, layer_cap: usize, budget: &Budget) -> Option<Turned> {
        let engine = choice.engine(&self.workload.tracer, &[self.workload.path().clone()], 1.0);
        let (found, seconds) = self.timed(|| self.workload.solve_visibility(engine.as_ref(), &self.points, budget))?;
        let which = match choice {
            EngineChoice::Rays(count) => Some((0, count)),
            EngineChoice::Bisect(count) => Some((1, count)),
            EngineChoice::Exact => None,
        };
        if let Some((kind, count)) = which {
            let sun_s = seconds / count as f64;
            self.sun_s[kind] = Some(self.sun_s[kind].map_or(sun_s, |before| before.min(sun_s)));
        }
        let most = found.iter().map(|lit| lit.as_slice().len()).max().unwrap_or(0);
        let errors = found.iter().zip(&self.exact).map(|(a, b)| symmetric_difference_t(a, b)).collect();
        Some(Turned {
            seconds: self.scaled(seconds),
            gpu_bytes: self.layer_bytes(most.div_ceil(4).min(layer_cap), Bits::Sixteen),
            sun_min: self.minutes(errors),
            open: None,
        })
    }

    /// Storing the exact times with these bits and at most so many layers.
    pub fn stored(&self, bits: Bits, layer_cap: usize) -> Turned {
        let encode = || {
            let started = Instant::now();
            let mut encoder = PageEncoder::new(self.exact.len(), bits, layer_cap);
            for (texel, lit) in self.exact.iter().enumerate() {
                encoder.set(texel, lit);
            }
            (encoder.finish(), started.elapsed().as_secs_f64())
        };
        let (layers, first_s) = encode();
        let seconds = first_s.min(encode().1).min(encode().1);
        let stored = |texel: usize| Intervals::from_unsorted(stored_intervals(&layers, texel, bits));
        let errors = self.exact.iter().enumerate().map(|(texel, lit)| symmetric_difference_t(&stored(texel), lit));
        Turned {
            seconds: self.scaled(seconds),
            gpu_bytes: self.layer_bytes(layers.len(), bits),
            sun_min: self.minutes(errors.collect()),
            open: None,
        }
    }

    /// So many lanes, exact, not stored; `layer_cap` bounds the bytes that they would take.
    pub fn lanes(&mut self, count: usize, layer_cap: usize, budget: &Budget) -> Option<Turned> {
        if self.disc.is_none() {
            self.disc = Some(self.disc_of(truth::LANES, DISC_STEP, budget)?.0);
        }
        let (lanes, paths) = self.workload.lanes(count);
        let engine = ExactEngine::new(&self.workload.tracer, &paths);
        let (found, seconds) = self.timed(|| self.workload.solve_visibility(&engine, &self.points, budget))?;
        let of_texel = found.chunks(lanes.len()).step_by(DISC_STEP).enumerate();
        let path = self.workload.path();
        let errors = of_texel
            .zip(self.disc.iter().flatten())
            .map(|((k, answers), best)| metric::apart_t(&metric::of_disc(answers, &lanes, path, start_of(k)), best));
        let errors = errors.collect();
        let most = |lane: usize| found.iter().skip(lane).step_by(lanes.len()).map(|lit| lit.as_slice().len()).max();
        let layers = (0..lanes.len()).map(|lane| most(lane).unwrap_or(0).div_ceil(4).min(layer_cap)).sum();
        Some(Turned {
            seconds: self.scaled(seconds),
            gpu_bytes: self.layer_bytes(layers, Bits::Sixteen),
            sun_min: self.minutes(errors),
            open: None,
        })
    }

    /// What so many lanes see of the disc at every `step`th texel.
    fn disc_of(&self, count: usize, step: usize, budget: &Budget) -> Option<(Vec<Vec<f32>>, f64)> {
        let (lanes, paths) = self.workload.lanes(count);
        let engine = ExactEngine::new(&self.workload.tracer, &paths);
        let points: Vec<SurfacePoint> = self.points.iter().step_by(step).copied().collect();
        let (answers, seconds) = self.workload.solve_visibility(&engine, &points, budget)?;
        let path = self.workload.path();
        let of_texel = |(k, answers): (usize, &[Intervals])| metric::of_disc(answers, &lanes, path, start_of(k));
        let seen = self.workload.on_threads(|| answers.par_chunks(lanes.len()).enumerate().map(of_texel).collect());
        Some((seen, seconds))
    }

    /// So many rays of sky.
    pub fn sky(&mut self, rays: u32, budget: &Budget) -> Option<Turned> {
        let points = self.sky_points();
        if self.sky.is_none() {
            let (runs, _) = self.workload.find_open(&self.workload.sky(RAYS, truth::SEED), &points, budget)?;
            let open = runs.iter().flat_map(|run| run.front.iter().zip(&run.buried));
            self.sky = Some(open.map(|(estimate, &is_buried)| (estimate.open, is_buried)).collect());
        }
        let engine = self.workload.sky(rays, 0);
        let (runs, seconds) = self.timed(|| self.workload.find_open(&engine, &points, budget))?;
        self.sky_ray_s = seconds / (f64::from(rays) * points.len().max(1) as f64);
        let found = runs.iter().flat_map(|run| &run.front).zip(self.sky.iter().flatten());
        let errors = found.filter(|(_, (_, is_buried))| !is_buried);
        let errors = errors.map(|(estimate, (best, _))| f64::from((estimate.open - best).abs())).collect();
        let page = &self.workload.page;
        let sides = if points.iter().any(|point| point.surface.is_double_sided) { 2 } else { 1 };
        Some(Turned {
            seconds: seconds * page.samples.len() as f64 / points.len().max(1) as f64,
            gpu_bytes: page.texel_count * 2 * sides,
            sun_min: None,
            open: distribution(errors),
        })
    }

    /// Seconds until the best answers of the disc are known, if they are not yet.
    pub fn disc_ready_s(&self) -> f64 {
        if self.disc.is_some() { 0.0 } else { self.exact_s * (truth::LANES / DISC_STEP) as f64 }
    }

    /// Seconds that so many rays of sky take, with the best answers if they are not yet known.
    pub fn sky_s(&self, rays: u32) -> f64 {
        let best = if self.sky.is_some() { 0 } else { RAYS };
        self.sky_ready_s + self.sky_ray_s * f64::from(rays + best) * self.sky_points().len() as f64
    }

    /// Texels that are asked about the sky: of some runs, the first of each.
    fn sky_points(&self) -> Vec<AmbientPoint> {
        let step = self.samples.len().div_ceil(RUN).div_ceil(SKY_RUNS).max(1);
        let runs = self.samples.chunks(RUN).step_by(step).flat_map(|run| &run[..run.len().min(SKY_RUN)]);
        let point = |sample: &Sample| AmbientPoint {
            surface: self.workload.point(sample),
            shading_normal: self.workload.shading_normal(sample.triangle, sample.barycentric.map(f64::from)),
        };
        runs.map(point).collect()
    }
}

/// Where a texel's moments start: the golden ratio's multiples, which are spread evenly.
fn start_of(k: usize) -> f64 {
    (k as f64 * 0.618_033_988_749_894_9).fract()
}

/// So many runs of neighbours, evenly spread over all; all of them if there are no more.
fn spread(samples: &[Sample], count: usize) -> Vec<Sample> {
    let runs: Vec<&[Sample]> = samples.chunks(RUN).collect();
    if runs.len() <= count {
        return samples.to_vec();
    }
    // The middles of equal shares: of neither the first run nor the last, which is short, more than its due.
    (0..count).flat_map(|k| runs[(2 * k + 1) * runs.len() / (2 * count)].iter().copied()).collect()
}
