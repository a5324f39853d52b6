//! Sweeps of one setting at a time on runs of neighbouring texels of the page, each against the best answer for the
//! same texel.
//!
//! * *Engines*: minutes in which a list differs from the exact one. `exact` is the reference, so its error is zero;
//!   other tests compare it with brute force.
//! * *Bits* and *layers*: minutes in which the stored list differs from the exact one.
//! * *Lanes*: minutes by which the disc's visibility differs from that of [`truth::LANES`] lanes at the same texel,
//!   before anything is stored.
//! * *Sky*: difference of ambient visibility from that of [`RAYS`] rays with another seed.

use super::budget::Budget;
use super::metric::{self, summary, symmetric_difference_t};
use super::report::ErrorSummary;
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
/// Texels of each run for which the sky is measured.
const SKY_RUN: usize = 512;
/// Most runs on which the sky is measured.
const SKY_RUNS: usize = 8;
/// The disc is compared at every fourth texel.
const DISC_STEP: usize = 4;
/// Rays of sky of the best answer for a texel.
pub(super) const RAYS: u32 = 16_384;
/// Seconds below which a measurement is made three times and the least is taken, because short measurements are noisy.
const SHORT_S: f64 = 0.4;

/// A setting's time, bytes and error.
#[derive(Clone, Copy)]
pub(super) struct SweepPoint {
    /// Seconds, scaled to all texels of the page.
    pub seconds: f64,
    /// Bytes of what the setting changes, on the GPU, for the whole page.
    pub gpu_bytes: u64,
    pub sun_min: Option<ErrorSummary>,
    pub ambient: Option<ErrorSummary>,
}

/// A sample of the page's texels, with the best answers that were needed so far.
pub(super) struct TexelSweeps<'a> {
    workload: &'a Workload,
    samples: Vec<Sample>,
    points: Vec<SurfacePoint>,
    exact: Vec<Intervals>,
    /// Seconds that the exact engine took for the sample.
    pub exact_s: f64,
    /// Seconds that a ray of sky takes, of one texel.
    pub sky_ray_s: f64,
    /// Seconds to build the engine for the sky.
    pub sky_ready_s: f64,
    /// Least seconds that one position of the sun took for the sample: by rays, by bisection.
    pub sun_s: [Option<f64>; 2],
    /// The best answers for the disc: visibility at each moment of every fourth texel.
    disc: Option<Vec<Vec<f32>>>,
    /// The best answers for the sky: ambient visibility, and whether the texel is buried.
    sky: Option<Vec<(f32, bool)>>,
}

impl<'a> TexelSweeps<'a> {
    /// Draws as many runs as the budget allows, and finds their exact times. None if it was stopped.
    pub fn new(workload: &'a Workload, budget: &Budget) -> Option<Self> {
        budget.task("measuring the exact engine");
        let all = &workload.page.samples;
        let probe: Vec<SurfacePoint> = spread(all, 2).iter().map(|sample| workload.point(sample)).collect();
        let engine = ExactEngine::new(&workload.tracer, &[workload.path().clone()]);
        let (_, probe_s) = workload.solve_visibility(&engine, &probe, budget)?;
        // 4,096 rays take about fifty times as long as the exact answer, and should take a twentieth of the budget.
        let run_s = probe_s * RUN as f64 / probe.len().max(1) as f64;
        let runs = (0.05 * budget.seconds() / (50.0 * run_s.max(1e-9))) as usize;
        let samples = spread(all, runs.clamp(4, 32));
        let points: Vec<SurfacePoint> = samples.iter().map(|sample| workload.point(sample)).collect();
        let (exact, exact_s) = workload.solve_visibility(&engine, &points, budget)?;
        let mut sweeps = Self {
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
        let engine = workload.ambient_engine(64, 0);
        sweeps.sky_ready_s = started.elapsed().as_secs_f64();
        let points = sweeps.sky_points();
        sweeps.sky_ray_s = workload.solve_ambient_at(&engine, &points, budget)?.1 / (64.0 * points.len().max(1) as f64);
        Some(sweeps)
    }

    /// Number of texels that are measured.
    pub fn texel_count(&self) -> usize {
        self.points.len()
    }

    /// Seconds of the sample, scaled to all texels of the page.
    fn scaled(&self, seconds: f64) -> f64 {
        seconds * self.workload.page.samples.len() as f64 / self.points.len().max(1) as f64
    }

    /// Seconds of the exact engine for a texel.
    pub fn exact_texel_s(&self) -> f64 {
        self.exact_s / self.points.len().max(1) as f64
    }

    /// Bytes of this many layers of times for the page on the GPU.
    fn layer_bytes(&self, layers: usize, bits: Bits) -> u64 {
        self.workload.page.texel_count * layers as u64 * 8 * u64::from(bits.count() / 8)
    }

    fn minutes(&self, errors_t: Vec<f64>) -> Option<ErrorSummary> {
        let duration_min = self.workload.path().duration_min;
        summary(errors_t.into_iter().map(|t| t * duration_min).collect())
    }

    /// Measures once, or three times and takes the least if that is short.
    fn timed<T>(&self, mut measure: impl FnMut() -> Option<(T, f64)>) -> Option<(T, f64)> {
        let (answer, mut seconds) = measure()?;
        for _ in 0..if seconds < SHORT_S { 2 } else { 0 } {
            seconds = seconds.min(measure()?.1);
        }
        Some((answer, seconds))
    }

    /// Measures an engine; `layer_cap` limits the bytes of its answers.
    pub fn engine(&mut self, choice: EngineChoice, layer_cap: usize, budget: &Budget) -> Option<SweepPoint> {
        let engine = choice.engine(&self.workload.tracer, &[self.workload.path().clone()], 1.0, None);
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
        Some(SweepPoint {
            seconds: self.scaled(seconds),
            gpu_bytes: self.layer_bytes(most.div_ceil(4).min(layer_cap), Bits::Sixteen),
            sun_min: self.minutes(errors),
            ambient: None,
        })
    }

    /// Measures storing the exact times with these bits and at most `layer_cap` layers.
    pub fn stored(&self, bits: Bits, layer_cap: usize) -> SweepPoint {
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
        SweepPoint {
            seconds: self.scaled(seconds),
            gpu_bytes: self.layer_bytes(layers.len(), bits),
            sun_min: self.minutes(errors.collect()),
            ambient: None,
        }
    }

    /// Measures this many lanes, exact and not stored; `layer_cap` limits the bytes that they would take.
    pub fn lanes(&mut self, count: usize, layer_cap: usize, budget: &Budget) -> Option<SweepPoint> {
        if self.disc.is_none() {
            self.disc = Some(self.disc_of(truth::LANES, DISC_STEP, budget)?.0);
        }
        let (lanes, paths) = self.workload.lanes(count);
        let engine = ExactEngine::new(&self.workload.tracer, &paths);
        let (found, seconds) = self.timed(|| self.workload.solve_visibility(&engine, &self.points, budget))?;
        let of_texel = found.chunks(lanes.len()).step_by(DISC_STEP).enumerate();
        let path = self.workload.path();
        let errors = of_texel.zip(self.disc.iter().flatten()).map(|((k, answers), best)| {
            metric::mean_difference_t(&metric::disc_visibility(answers, &lanes, path, start_of(k)), best)
        });
        let errors = errors.collect();
        let most = |lane: usize| found.iter().skip(lane).step_by(lanes.len()).map(|lit| lit.as_slice().len()).max();
        let layers = (0..lanes.len()).map(|lane| most(lane).unwrap_or(0).div_ceil(4).min(layer_cap)).sum();
        Some(SweepPoint {
            seconds: self.scaled(seconds),
            gpu_bytes: self.layer_bytes(layers, Bits::Sixteen),
            sun_min: self.minutes(errors),
            ambient: None,
        })
    }

    /// Visibility of the disc by this many lanes at every `step`th texel.
    fn disc_of(&self, count: usize, step: usize, budget: &Budget) -> Option<(Vec<Vec<f32>>, f64)> {
        let (lanes, paths) = self.workload.lanes(count);
        let engine = ExactEngine::new(&self.workload.tracer, &paths);
        let points: Vec<SurfacePoint> = self.points.iter().step_by(step).copied().collect();
        let (answers, seconds) = self.workload.solve_visibility(&engine, &points, budget)?;
        let path = self.workload.path();
        let of_texel =
            |(k, answers): (usize, &[Intervals])| metric::disc_visibility(answers, &lanes, path, start_of(k));
        let seen = self.workload.on_threads(|| answers.par_chunks(lanes.len()).enumerate().map(of_texel).collect());
        Some((seen, seconds))
    }

    /// Measures this many rays of sky.
    pub fn sky(&mut self, rays: u32, budget: &Budget) -> Option<SweepPoint> {
        let points = self.sky_points();
        if self.sky.is_none() {
            let (runs, _) =
                self.workload.solve_ambient_at(&self.workload.ambient_engine(RAYS, truth::SEED), &points, budget)?;
            let found = runs.iter().flat_map(|run| run.front.iter().zip(&run.buried));
            self.sky = Some(found.map(|(estimate, &is_buried)| (estimate.visibility, is_buried)).collect());
        }
        let engine = self.workload.ambient_engine(rays, 0);
        let (runs, seconds) = self.timed(|| self.workload.solve_ambient_at(&engine, &points, budget))?;
        self.sky_ray_s = seconds / (f64::from(rays) * points.len().max(1) as f64);
        let found = runs.iter().flat_map(|run| &run.front).zip(self.sky.iter().flatten());
        let errors = found.filter(|(_, (_, is_buried))| !is_buried);
        let errors = errors.map(|(estimate, (best, _))| f64::from((estimate.visibility - best).abs())).collect();
        let page = &self.workload.page;
        let sides = if points.iter().any(|point| point.surface.is_double_sided) { 2 } else { 1 };
        Some(SweepPoint {
            seconds: seconds * page.samples.len() as f64 / points.len().max(1) as f64,
            gpu_bytes: page.texel_count * 2 * sides,
            sun_min: None,
            ambient: summary(errors),
        })
    }

    /// Predicted seconds to find the best answers for the disc; 0 if they are known.
    pub fn disc_ready_s(&self) -> f64 {
        if self.disc.is_some() { 0.0 } else { self.exact_s * (truth::LANES / DISC_STEP) as f64 }
    }

    /// Predicted seconds of this many rays of sky, including the best answers if they are not known yet.
    pub fn sky_s(&self, rays: u32) -> f64 {
        let best = if self.sky.is_some() { 0 } else { RAYS };
        self.sky_ready_s + self.sky_ray_s * f64::from(rays + best) * self.sky_points().len() as f64
    }

    /// Points for which the sky is measured: the first texels of some runs.
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

/// Where a texel's moments start: multiples of the golden ratio, which are evenly spread.
fn start_of(k: usize) -> f64 {
    (k as f64 * 0.618_033_988_749_894_9).fract()
}

/// This many runs of neighbours, evenly spread over all; all of them if there are no more.
fn spread(samples: &[Sample], count: usize) -> Vec<Sample> {
    let runs: Vec<&[Sample]> = samples.chunks(RUN).collect();
    if runs.len() <= count {
        return samples.to_vec();
    }
    // The middles of equal shares: the last run is short, and should not be chosen more often than others.
    (0..count).flat_map(|k| runs[(2 * k + 1) * runs.len() / (2 * count)].iter().copied()).collect()
}
