//! The estimate: rays over hemispheres, neighbouring texels together.
//!
//! **Error.** With an error E given, a texel's rays are doubled until they are enough. The two halves of its rays are two
//! estimates of equal standing, and half their difference is one draw from the error of their mean. One draw may be small by
//! chance; so the one before counts if it was greater, and no texel is believed to err less than the sixteen that ask
//! together do in the mean. It stops once 1.96 times the standard error so found is below E. Halves of a net err less
//! together than that says, so that more than 95 of 100 texels are within E; of lone hard ones among open neighbours, four of
//! five. What is smaller than the gaps between the first [`LEAST_RAYS`] rays may go unseen.

use super::AmbientSettings;
use super::buried::Burial;
use super::directions::{BLOCK, DirectionSample, DirectionSets, Frame};
use super::harmonics::{self, Coefficients};
use super::hidden_share;
use crate::atlas::SurfacePoint;
use crate::scene::{Geometry, Scene};
use crate::trace::{Occluder, PACKET, PacketScratch, PacketTracer, ShadowQuery, Tracer};
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use std::ops::Range;

/// Texels that ask together.
const TOGETHER: usize = PACKET;
/// Texels whose guesses are kept from one to the next: a task of a thread.
const RUN: usize = 512;
/// Rays before an error is first judged.
const LEAST_RAYS: u32 = 32;
/// Standard errors that hold 95 of 100 of a normal distribution.
const CONFIDENCE: f64 = 1.96;
/// How much less variance twice the rays leave, which makes the halves' difference before this one comparable: 2^-1.5 in
/// the best case, taken as a half.
const EARLIER: f64 = 0.5;
/// Openness up to which a texel is looked at for being buried.
const DARK: f64 = 0.1;

/// A point that ambient light is asked about.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AmbientPoint {
    /// Where it is.
    pub surface: SurfacePoint,
    /// Unit normal that the surface is meant to have there, on its front.
    pub shading_normal: DVec3,
}

/// What one side of a texel sees of the sky.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Estimate {
    /// Cosine-weighted free share of the hemisphere, 0 to 1.
    pub open: f32,
    /// Mean free direction, bake space, which is turned like world space. Zero unless asked for.
    pub bent: Vec3,
    /// Transfer vector. Zero unless asked for.
    pub sky: Coefficients,
}

/// Estimates of a run of texels.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Estimates {
    /// Of the fronts.
    pub front: Vec<Estimate>,
    /// Of the backs of double-sided texels, by their place in the run, ascending.
    pub back: Vec<(u32, Estimate)>,
    /// Whether texels lie inside a solid.
    pub buried: Vec<bool>,
    /// Rays traced.
    pub rays: u64,
    /// Sides of texels whose rays ran out before their error was small enough.
    pub unsettled: u64,
}

/// Estimates ambient light.
pub struct AmbientEngine<'a> {
    tracer: &'a Tracer,
    packet_tracer: PacketTracer<'a>,
    burial: Burial<'a>,
    settings: AmbientSettings,
    /// Rays are traced in blocks of these lengths.
    blocks: Vec<u32>,
    draws: DirectionSets,
}

impl<'a> AmbientEngine<'a> {
    /// Builds its hierarchy.
    pub fn new(scene: &'a Scene, geometry: &'a Geometry, tracer: &'a Tracer, settings: AmbientSettings) -> Self {
        let burial = Burial::new(scene, geometry, tracer, settings.distance_m.is_none());
        let blocks = blocks(&settings);
        let draws = DirectionSets::new(settings.seed, settings.rays, &blocks);
        Self { tracer, packet_tracer: PacketTracer::new(tracer), burial, settings, blocks, draws }
    }

    /// Of points that stand for one place together, adds those outside all solids, or all of them where there is none: what
    /// lies inside would darken the others.
    pub fn add_visible(&self, points: impl Iterator<Item = AmbientPoint> + Clone, to: &mut Vec<AmbientPoint>) {
        let (mut scratch, before) = (PacketScratch::default(), to.len());
        let is_seen = |point: &AmbientPoint| !self.burial.is_buried(&self.packet_tracer, &mut scratch, point, &mut 0);
        to.extend(points.clone().filter(is_seen));
        if to.len() == before {
            to.extend(points);
        }
    }

    /// The settings.
    pub fn settings(&self) -> &AmbientSettings {
        &self.settings
    }
}

/// Asks about texels 0 to `count`, on all threads of the current pool; neighbours should follow one another. `texel` adds
/// the points of one, one at least, on which its rays are spread. Which directions they take follows from its place in the
/// order. Answers come in that order, run by run. `on_progress` gets the number of texels that were done and returns false to
/// stop; then there is no answer.
pub fn solve_ambient(
    engine: &AmbientEngine,
    count: usize,
    texel: impl Fn(usize, &mut Vec<AmbientPoint>) + Sync,
    on_progress: impl Fn(usize) -> bool + Sync,
) -> Option<Vec<Estimates>> {
    let run = |run: usize| {
        let range = run * RUN..count.min((run + 1) * RUN);
        let mut scratch = Scratch::new(engine.settings.rays);
        let mut answers = Estimates::default();
        for start in range.clone().step_by(TOGETHER) {
            scratch.gather(start..range.end.min(start + TOGETHER), &texel);
            engine.ask(&mut scratch, &mut answers);
        }
        on_progress(range.len()).then_some(answers)
    };
    (0..count.div_ceil(RUN)).into_par_iter().map(run).collect()
}

/// The blocks in which rays are traced: whole ones or, where an error may stop them, first few and then as many again.
fn blocks(settings: &AmbientSettings) -> Vec<u32> {
    let most = settings.rays.min(BLOCK);
    let mut traced = if settings.error.is_some() { LEAST_RAYS.min(most) } else { most };
    let mut blocks = vec![traced];
    while traced < settings.rays {
        blocks.push(traced.min(most));
        traced += traced.min(most);
    }
    blocks
}

/// A number for the directions of the texel at a place in the order: those of a block are all different, and blocks start
/// anywhere (a finaliser of MurmurHash3: Appleby, 2011), so that equal ones lie in no pattern.
fn seed_of(index: usize) -> u32 {
    let (block, texel) = ((index / TOGETHER) as u32, (index % TOGETHER) as u32);
    let mut mixed = (block ^ block >> 16).wrapping_mul(0x85eb_ca6b);
    mixed = (mixed ^ mixed >> 13).wrapping_mul(0xc2b2_ae35);
    (mixed ^ mixed >> 16).wrapping_add(texel)
}

/// What is used anew by every block of texels.
struct Scratch {
    walk: PacketScratch,
    texels: Vec<Texel>,
    points: Vec<AmbientPoint>,
    queries: Vec<ShadowQuery>,
    /// For each side and cell of the hemisphere, what last hid a ray.
    guesses: [Vec<Option<Occluder>>; 2],
}

/// A texel of the block at hand.
struct Texel {
    seed: u32,
    points: Range<usize>,
    /// Where the rays of its points start, on the side at hand.
    ray_origins: Vec<RayOrigin>,
    tally: Tally,
    /// Sum of the first half of the rays, and how many those are.
    half: (f64, u32),
    /// Half the difference of the last two halves, if there were any.
    apart: Option<f64>,
    /// Whether no more rays are wanted on the side at hand.
    is_done: bool,
}

/// A point of a texel on one of its sides.
struct RayOrigin {
    origin_m: DVec3,
    plane: DVec3,
    frame: Frame,
    triangle: u32,
}

/// Sums over a texel's rays.
#[derive(Default, Clone, Copy)]
struct Tally {
    /// Rays before the surface's plane.
    count: u32,
    free: f64,
    bent: DVec3,
    sky: [f64; harmonics::COUNT],
}

impl Scratch {
    fn new(rays: u32) -> Self {
        let cells = rays.min(BLOCK) as usize;
        Self {
            walk: PacketScratch::default(),
            texels: Vec::new(),
            points: Vec::new(),
            queries: Vec::new(),
            guesses: [vec![None; cells], vec![None; cells]],
        }
    }

    fn gather(&mut self, range: Range<usize>, texel: &(impl Fn(usize, &mut Vec<AmbientPoint>) + Sync)) {
        self.points.clear();
        self.texels.clear();
        for index in range {
            let first = self.points.len();
            texel(index, &mut self.points);
            let seed = seed_of(index);
            debug_assert!(first < self.points.len(), "a texel has a point at least");
            let texel = Texel {
                seed,
                points: first..self.points.len(),
                ray_origins: Vec::new(),
                tally: Tally::default(),
                half: (0.0, 0),
                apart: None,
                is_done: false,
            };
            self.texels.push(texel);
        }
    }

    fn is_double_sided(&self, texel: usize) -> bool {
        self.points[self.texels[texel].points.start].surface.is_double_sided
    }
}

impl AmbientEngine<'_> {
    /// Answers for the texels that were gathered.
    fn ask(&self, scratch: &mut Scratch, answers: &mut Estimates) {
        let first = answers.front.len();
        self.ask_side(scratch, 0, answers);
        for index in 0..scratch.texels.len() {
            let estimate = self.estimate(&scratch.texels[index].tally);
            answers.front.push(estimate);
            answers.buried.push(self.is_buried(scratch, index, &estimate, &mut answers.rays));
        }
        if (0..scratch.texels.len()).any(|index| scratch.is_double_sided(index)) {
            self.ask_side(scratch, 1, answers);
            for index in (0..scratch.texels.len()).filter(|&index| scratch.is_double_sided(index)) {
                answers.back.push(((first + index) as u32, self.estimate(&scratch.texels[index].tally)));
            }
        }
    }

    fn is_buried(&self, scratch: &mut Scratch, texel: usize, estimate: &Estimate, rays: &mut u64) -> bool {
        // Without a distance, what is buried sees nothing.
        if self.settings.distance_m.is_none() && f64::from(estimate.open) > DARK {
            return false;
        }
        let points = scratch.texels[texel].points.clone();
        scratch.points[points]
            .iter()
            .all(|point| self.burial.is_buried(&self.packet_tracer, &mut scratch.walk, point, rays))
    }

    fn ask_side(&self, scratch: &mut Scratch, side: usize, Estimates { rays, unsettled, .. }: &mut Estimates) {
        let sign = if side == 0 { 1.0 } else { -1.0 };
        for texel in &mut scratch.texels {
            let ray_origin = |point: &AmbientPoint| {
                let plane = point.surface.normal * sign;
                let origin_m = self.tracer.lift(point.surface.position_m, plane, point.surface.triangle);
                RayOrigin {
                    origin_m,
                    plane,
                    frame: Frame::new(point.shading_normal * sign),
                    triangle: point.surface.triangle,
                }
            };
            let points = &scratch.points[texel.points.clone()];
            let is_asked = side == 0 || points[0].surface.is_double_sided;
            texel.ray_origins.clear();
            texel.ray_origins.extend(points.iter().filter(|_| is_asked).map(ray_origin));
            (texel.tally, texel.half) = (Tally::default(), (0.0, 0));
            (texel.apart, texel.is_done) = (None, !is_asked);
        }
        let mut traced = 0;
        for &count in &self.blocks {
            self.trace(scratch, side, traced, count as usize);
            traced += count;
            if let Some(error) = self.settings.error.filter(|_| traced.is_power_of_two()) {
                judge(&mut scratch.texels, traced, error);
            }
            if scratch.texels.iter().all(|texel| texel.is_done) {
                break;
            }
        }
        if self.settings.error.is_some() {
            *unsettled += scratch.texels.iter().filter(|texel| !texel.is_done).count() as u64;
        }
        *rays += scratch.texels.iter().map(|texel| u64::from(texel.tally.count)).sum::<u64>();
    }

    /// Traces a block of every texel's rays, cell by cell of the hemisphere.
    fn trace(&self, scratch: &mut Scratch, side: usize, first: u32, cells: usize) {
        let Scratch { walk, texels, guesses, queries, .. } = scratch;
        let guesses = &mut guesses[side];
        for cell in 0..cells {
            queries.clear();
            let mut asking = [0; TOGETHER];
            for (index, texel) in texels.iter().enumerate().filter(|(_, texel)| !texel.is_done) {
                let draw: &DirectionSample = &self.draws.of(texel.seed)[first as usize + cell];
                let ray_origin = &texel.ray_origins[(draw.pick * texel.ray_origins.len() as f32) as usize];
                let direction = ray_origin.frame.direction(draw);
                if direction.dot(ray_origin.plane) > 0.0 {
                    asking[queries.len()] = index;
                    queries.push(ShadowQuery {
                        origin_m: ray_origin.origin_m,
                        direction,
                        triangle: ray_origin.triangle,
                    });
                }
            }
            let place = cell * guesses.len() / cells;
            let hidden = self.hidden(walk, queries, &mut guesses[place]);
            for ((query, &texel), hidden) in queries.iter().zip(&asking).zip(hidden) {
                texels[texel].tally.add(query.direction, 1.0 - hidden, &self.settings);
            }
        }
    }

    /// The shares of rays that are hidden.
    #[inline]
    fn hidden(&self, walk: &mut PacketScratch, rays: &[ShadowQuery], guess: &mut Option<Occluder>) -> [f64; PACKET] {
        let mut hidden = [0.0; PACKET];
        match self.settings.distance_m {
            None => {
                let stopped = self.packet_tracer.occluded(walk, rays, guess);
                (0..rays.len()).for_each(|ray| hidden[ray] = f64::from(stopped >> ray & 1));
            }
            Some(reach_m) => {
                let hits = self.packet_tracer.nearest(walk, rays, reach_m);
                hidden = hits.map(|hit| hit.map_or(0.0, |hit| hidden_share(hit.distance_m, reach_m)));
            }
        }
        hidden
    }

    fn estimate(&self, tally: &Tally) -> Estimate {
        let count = f64::from(tally.count.max(1));
        Estimate {
            open: (tally.free / count) as f32,
            bent: (tally.bent / tally.free.max(1e-9)).as_vec3(),
            sky: tally.sky.map(|sum| (sum / count) as f32),
        }
    }
}

impl Tally {
    #[inline]
    fn add(&mut self, direction: DVec3, free: f64, settings: &AmbientSettings) {
        self.count += 1;
        if free > 0.0 {
            self.free += free;
            if settings.wants_bent {
                self.bent += direction * free;
            }
            if settings.wants_sky {
                let values = harmonics::basis(direction);
                self.sky.iter_mut().zip(values).for_each(|(sum, value)| *sum += free * value);
            }
        }
    }
}

/// Notes which of the texels that ask together have rays enough.
fn judge(texels: &mut [Texel], traced: u32, error: f64) {
    let mut asking: Vec<&mut Texel> = texels.iter_mut().filter(|texel| !texel.is_done).collect();
    if traced > LEAST_RAYS {
        let squares: Vec<f64> = asking.iter().map(|texel| apart(texel).powi(2)).collect();
        let pooled = squares.iter().sum::<f64>() / (squares.len() as f64).max(1.0);
        for (texel, &now) in asking.iter_mut().zip(&squares) {
            let own = texel.apart.map_or(now, |earlier| now.max(EARLIER * earlier * earlier));
            texel.is_done = CONFIDENCE * own.max(pooled).sqrt() <= error;
            texel.apart = Some(now.sqrt());
        }
    }
    for texel in asking {
        texel.half = (texel.tally.free, texel.tally.count);
    }
}

/// Half the difference between the means of the two halves of a texel's rays.
fn apart(texel: &Texel) -> f64 {
    let (free, count) = texel.half;
    let first = free / f64::from(count.max(1));
    let second = (texel.tally.free - free) / f64::from((texel.tally.count - count).max(1));
    0.5 * (first - second).abs()
}
