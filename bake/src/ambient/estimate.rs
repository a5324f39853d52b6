//! The estimate: rays over hemispheres, for packets of neighbouring texels.
//!
//! **Error.** With an error E given, a texel's rays are doubled until they are enough. The two halves of its rays are
//! two equally good estimates, and half their difference is one sample of the error of their mean. One sample may be
//! small by chance. So the previous one counts where it was greater, and no texel's error is taken to be less than the
//! mean of its packet. A texel stops once 1.96 times the standard error found in this way is below E. The halves belong
//! to one low-discrepancy sequence and together err less than two independent halves, so more than 95 of 100 texels are
//! within E; of single difficult texels among easy neighbours, four of five. Occluders smaller than the gaps between
//! the first [`LEAST_RAYS`] rays may be missed.

use super::AmbientSettings;
use super::buried::BuriedTest;
use super::directions::{BLOCK, DirectionSample, DirectionSets, NormalFrame};
use super::harmonics::{self, Coefficients};
use super::occluded_share;
use super::point::AmbientPoint;
use crate::scene::{Geometry, Scene};
use crate::trace::{Occluder, PACKET, PacketScratch, PacketTracer, ShadowQuery, Tracer};
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use std::ops::Range;

/// Texels of a packet.
const TOGETHER: usize = PACKET;
/// Texels of a task of one thread. Within it, each packet starts with the occluders that the last one found.
const RUN: usize = 512;
/// Rays before an error is first estimated.
const LEAST_RAYS: u32 = 32;
/// Standard errors on each side of the mean that hold 95 of 100 values of a normal distribution.
const CONFIDENCE: f64 = 1.96;
/// Variance that is left after doubling the rays. It makes the previous difference of halves comparable to this one. It
/// is 2^-1.5 in the best case; a half is the cautious value.
const VARIANCE_AFTER_DOUBLING: f64 = 0.5;
/// Ambient visibility up to which a texel is tested for being buried.
const DARK: f64 = 0.1;

/// Ambient light of one side of a texel.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Estimate {
    /// Ambient visibility: cosine-weighted free share of the hemisphere, 0 to 1.
    pub visibility: f32,
    /// Bent normal: mean free direction, in the axes of world space, 0 to 1 long. Zero unless asked for.
    pub bent: Vec3,
    /// Sky visibility in spherical harmonics. Zero unless asked for.
    pub sky: Coefficients,
}

/// Estimates of a run of texels.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Estimates {
    /// Of the fronts, one per texel.
    pub front: Vec<Estimate>,
    /// Of the backs of double-sided texels, with their index in the run, ascending.
    pub back: Vec<(u32, Estimate)>,
    /// For each texel, whether it lies inside a solid.
    pub buried: Vec<bool>,
    /// Rays traced.
    pub rays: u64,
    /// Sides of texels whose error was not yet small enough after all rays.
    pub unconverged: u64,
}

/// Estimates ambient visibility, bent normals and sky coefficients of points.
pub struct AmbientEngine<'a> {
    tracer: &'a Tracer,
    packet_tracer: PacketTracer<'a>,
    buried_test: BuriedTest<'a>,
    settings: AmbientSettings,
    /// Rays are traced in blocks of these lengths.
    blocks: Vec<u32>,
    directions: DirectionSets,
}

impl<'a> AmbientEngine<'a> {
    /// Builds the hierarchy of the packet tracer and the directions of all sequences.
    pub fn new(scene: &'a Scene, geometry: &'a Geometry, tracer: &'a Tracer, settings: AmbientSettings) -> Self {
        let buried_test = BuriedTest::new(scene, geometry, tracer, settings.distance_m.is_none());
        let blocks = blocks(&settings);
        let directions = DirectionSets::new(settings.seed, settings.rays, &blocks);
        Self { tracer, packet_tracer: PacketTracer::new(tracer), buried_test, settings, blocks, directions }
    }

    /// Adds those of a texel's points that lie outside all solids, or all of them where none does: a point inside would
    /// darken the texel.
    pub fn add_visible(&self, points: impl Iterator<Item = AmbientPoint> + Clone, to: &mut Vec<AmbientPoint>) {
        let (mut scratch, before) = (PacketScratch::default(), to.len());
        let is_seen =
            |point: &AmbientPoint| !self.buried_test.is_buried(&self.packet_tracer, &mut scratch, point, &mut 0);
        to.extend(points.clone().filter(is_seen));
        if to.len() == before {
            to.extend(points);
        }
    }

    /// Settings as they were given to [`AmbientEngine::new`].
    pub fn settings(&self) -> &AmbientSettings {
        &self.settings
    }
}

/// Estimates texels 0 to `count`, on all threads of the current pool; neighbours should follow one another. `texel`
/// adds the points of a texel, at least one, among which its rays are shared out. The directions of a texel follow from
/// its index. Answers come in that order, run by run. `on_progress` gets the number of texels that were done and
/// returns false to stop; then there is no answer.
pub fn solve_ambient(
    engine: &AmbientEngine,
    count: usize,
    texel: impl Fn(usize, &mut Vec<AmbientPoint>) + Sync,
    on_progress: impl Fn(usize) -> bool + Sync,
) -> Option<Vec<Estimates>> {
    let run = |run: usize| {
        let range = run * RUN..count.min((run + 1) * RUN);
        let mut scratch = EstimateScratch::new(engine.settings.rays);
        let mut answers = Estimates::default();
        for start in range.clone().step_by(TOGETHER) {
            scratch.gather(start..range.end.min(start + TOGETHER), &texel);
            engine.estimate_packet(&mut scratch, &mut answers);
        }
        on_progress(range.len()).then_some(answers)
    };
    (0..count.div_ceil(RUN)).into_par_iter().map(run).collect()
}

/// Lengths of the blocks in which rays are traced: full blocks or, where an error may stop them, a small one and then
/// doublings.
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

/// Selects the directions of a texel. All texels of a packet differ. Packets start at a hashed number (finaliser of
/// MurmurHash3: Appleby, 2011), so that texels with equal directions form no pattern.
fn seed_of(index: usize) -> u32 {
    let (block, texel) = ((index / TOGETHER) as u32, (index % TOGETHER) as u32);
    let mut mixed = (block ^ block >> 16).wrapping_mul(0x85eb_ca6b);
    mixed = (mixed ^ mixed >> 13).wrapping_mul(0xc2b2_ae35);
    (mixed ^ mixed >> 16).wrapping_add(texel)
}

/// Memory of a thread, reused by every packet of texels.
struct EstimateScratch {
    walk: PacketScratch,
    texels: Vec<TexelState>,
    points: Vec<AmbientPoint>,
    queries: Vec<ShadowQuery>,
    /// For each side and cell of the hemisphere, what last occluded a ray: tested first for the next.
    guesses: [Vec<Option<Occluder>>; 2],
}

/// A texel of the current packet.
struct TexelState {
    seed: u32,
    /// Its points, in [`EstimateScratch::points`].
    points: Range<usize>,
    /// Where the rays of its points start, on the current side.
    ray_origins: Vec<RayOrigin>,
    sums: RaySums,
    /// Free rays and all rays of the first half.
    half: (f64, u32),
    /// Half the difference of the last two halves, if there were any.
    half_difference: Option<f64>,
    /// Whether the current side needs no more rays.
    is_done: bool,
}

/// A point of a texel, on one of its sides.
struct RayOrigin {
    origin_m: DVec3,
    /// Unit normal of the triangle, towards the current side.
    plane_normal: DVec3,
    frame: NormalFrame,
    triangle: u32,
}

/// Sums over a texel's rays.
#[derive(Default, Clone, Copy)]
struct RaySums {
    /// Rays in front of the surface's plane.
    count: u32,
    /// Sum of their free shares.
    free: f64,
    bent: DVec3,
    sky: [f64; harmonics::COUNT],
}

impl EstimateScratch {
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
            let texel = TexelState {
                seed,
                points: first..self.points.len(),
                ray_origins: Vec::new(),
                sums: RaySums::default(),
                half: (0.0, 0),
                half_difference: None,
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
    /// Adds the answers for the gathered texels.
    fn estimate_packet(&self, scratch: &mut EstimateScratch, answers: &mut Estimates) {
        let first = answers.front.len();
        self.estimate_side(scratch, 0, answers);
        for index in 0..scratch.texels.len() {
            let estimate = self.estimate(&scratch.texels[index].sums);
            answers.front.push(estimate);
            answers.buried.push(self.is_buried(scratch, index, &estimate, &mut answers.rays));
        }
        if (0..scratch.texels.len()).any(|index| scratch.is_double_sided(index)) {
            self.estimate_side(scratch, 1, answers);
            for index in (0..scratch.texels.len()).filter(|&index| scratch.is_double_sided(index)) {
                answers.back.push(((first + index) as u32, self.estimate(&scratch.texels[index].sums)));
            }
        }
    }

    fn is_buried(&self, scratch: &mut EstimateScratch, texel: usize, estimate: &Estimate, rays: &mut u64) -> bool {
        // Without a distance, a buried point sees nothing.
        if self.settings.distance_m.is_none() && f64::from(estimate.visibility) > DARK {
            return false;
        }
        let points = scratch.texels[texel].points.clone();
        scratch.points[points]
            .iter()
            .all(|point| self.buried_test.is_buried(&self.packet_tracer, &mut scratch.walk, point, rays))
    }

    fn estimate_side(
        &self,
        scratch: &mut EstimateScratch,
        side: usize,
        Estimates { rays, unconverged, .. }: &mut Estimates,
    ) {
        let sign = if side == 0 { 1.0 } else { -1.0 };
        for texel in &mut scratch.texels {
            let ray_origin = |point: &AmbientPoint| {
                let plane_normal = point.surface.normal * sign;
                let origin_m = self.tracer.lift(point.surface.position_m, plane_normal, point.surface.triangle);
                RayOrigin {
                    origin_m,
                    plane_normal,
                    frame: NormalFrame::new(point.shading_normal * sign),
                    triangle: point.surface.triangle,
                }
            };
            let points = &scratch.points[texel.points.clone()];
            let is_asked = side == 0 || points[0].surface.is_double_sided;
            texel.ray_origins.clear();
            texel.ray_origins.extend(points.iter().filter(|_| is_asked).map(ray_origin));
            (texel.sums, texel.half) = (RaySums::default(), (0.0, 0));
            (texel.half_difference, texel.is_done) = (None, !is_asked);
        }
        let mut traced = 0;
        for &count in &self.blocks {
            self.trace(scratch, side, traced, count as usize);
            traced += count;
            if let Some(error) = self.settings.error.filter(|_| traced.is_power_of_two()) {
                mark_converged(&mut scratch.texels, traced, error);
            }
            if scratch.texels.iter().all(|texel| texel.is_done) {
                break;
            }
        }
        if self.settings.error.is_some() {
            *unconverged += scratch.texels.iter().filter(|texel| !texel.is_done).count() as u64;
        }
        *rays += scratch.texels.iter().map(|texel| u64::from(texel.sums.count)).sum::<u64>();
    }

    /// Traces a block of every texel's rays, one cell of the hemisphere after the other.
    fn trace(&self, scratch: &mut EstimateScratch, side: usize, first: u32, cells: usize) {
        let EstimateScratch { walk, texels, guesses, queries, .. } = scratch;
        let guesses = &mut guesses[side];
        for cell in 0..cells {
            queries.clear();
            let mut asking = [0; TOGETHER];
            for (index, texel) in texels.iter().enumerate().filter(|(_, texel)| !texel.is_done) {
                let sample: &DirectionSample = &self.directions.of(texel.seed)[first as usize + cell];
                let ray_origin = &texel.ray_origins[(sample.pick * texel.ray_origins.len() as f32) as usize];
                let direction = ray_origin.frame.direction(sample);
                if direction.dot(ray_origin.plane_normal) > 0.0 {
                    asking[queries.len()] = index;
                    queries.push(ShadowQuery {
                        origin_m: ray_origin.origin_m,
                        direction,
                        triangle: ray_origin.triangle,
                    });
                }
            }
            let place = cell * guesses.len() / cells;
            let occluded = self.occluded(walk, queries, &mut guesses[place]);
            for ((query, &texel), occluded) in queries.iter().zip(&asking).zip(occluded) {
                texels[texel].sums.add(query.direction, 1.0 - occluded, &self.settings);
            }
        }
    }

    /// How much of each ray is occluded, 0 to 1.
    #[inline]
    fn occluded(&self, walk: &mut PacketScratch, rays: &[ShadowQuery], guess: &mut Option<Occluder>) -> [f64; PACKET] {
        let mut occluded = [0.0; PACKET];
        match self.settings.distance_m {
            None => {
                let stopped = self.packet_tracer.occluded(walk, rays, guess);
                (0..rays.len()).for_each(|ray| occluded[ray] = f64::from(stopped >> ray & 1));
            }
            Some(reach_m) => {
                let hits = self.packet_tracer.nearest(walk, rays, reach_m);
                occluded = hits.map(|hit| hit.map_or(0.0, |hit| occluded_share(hit.distance_m, reach_m)));
            }
        }
        occluded
    }

    fn estimate(&self, sums: &RaySums) -> Estimate {
        let count = f64::from(sums.count.max(1));
        Estimate {
            visibility: (sums.free / count) as f32,
            bent: (sums.bent / sums.free.max(1e-9)).as_vec3(),
            sky: sums.sky.map(|sum| (sum / count) as f32),
        }
    }
}

impl RaySums {
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

/// Marks the texels of a packet whose error is small enough.
fn mark_converged(texels: &mut [TexelState], traced: u32, error: f64) {
    let mut asking: Vec<&mut TexelState> = texels.iter_mut().filter(|texel| !texel.is_done).collect();
    if traced > LEAST_RAYS {
        let squares: Vec<f64> = asking.iter().map(|texel| half_difference(texel).powi(2)).collect();
        let pooled = squares.iter().sum::<f64>() / (squares.len() as f64).max(1.0);
        for (texel, &now) in asking.iter_mut().zip(&squares) {
            let own = texel.half_difference.map_or(now, |earlier| now.max(VARIANCE_AFTER_DOUBLING * earlier * earlier));
            texel.is_done = CONFIDENCE * own.max(pooled).sqrt() <= error;
            texel.half_difference = Some(now.sqrt());
        }
    }
    for texel in asking {
        texel.half = (texel.sums.free, texel.sums.count);
    }
}

/// Half the difference between the means of the two halves of a texel's rays.
fn half_difference(texel: &TexelState) -> f64 {
    let (free, count) = texel.half;
    let first = free / f64::from(count.max(1));
    let second = (texel.sums.free - free) / f64::from((texel.sums.count - count).max(1));
    0.5 * (first - second).abs()
}
