//! The scene that is measured, with its hierarchy, its sun, and a page of texels.

use super::budget::Budget;
use super::cpu_share::CpuShare;
use super::error::CostError;
use super::settings::CostSettings;
use crate::BakeError;
use crate::ambient::{AmbientEngine, AmbientPoint, AmbientSettings, Estimates, solve_ambient};
use crate::atlas::{self, Atlas, Sample, SurfacePoint};
use crate::bake::{Prepared, fitting_atlas, prepare};
use crate::maps::Lane;
use crate::progress::{BakeStep, Progress};
use crate::scene::{Geometry, Scene, ShadingNormals};
use crate::settings::BakeSettings;
use crate::sun::SunPath;
use crate::trace::Tracer;
use crate::visibility::{Engine, Intervals, solve_visibility};
use crate::warning::Warning;
use glam::DVec3;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::Instant;

/// A scene with everything that is built from it once.
pub(super) struct Workload {
    /// Where it was read from.
    pub scene_file: PathBuf,
    prepared: Prepared,
    path: SunPath,
    pub geometry: Geometry,
    pub tracer: Tracer,
    normals: ShadingNormals,
    pool: rayon::ThreadPool,
    /// The page whose texels the sweeps sample.
    pub page: MeasuredPage,
    /// Seconds of every bake before its first texel: reading, unwrapping, building the hierarchy.
    pub fixed_s: f64,
    warnings: Vec<Warning>,
    cpu_share: Mutex<CpuShare>,
}

/// A page laid out as by a bake; or several, where a scene does not fit one.
pub(super) struct MeasuredPage {
    /// Texels, covered or not.
    pub texel_count: u64,
    /// Edge as asked for.
    pub edge_texels: u32,
    /// Covered texels, neighbours together.
    pub samples: Vec<Sample>,
}

impl Workload {
    pub fn new(scene_file: &Path, settings: &CostSettings, budget: &Budget) -> Result<Self, CostError> {
        budget.task("reading the scene and laying it out");
        let started = Instant::now();
        let asked =
            BakeSettings { page_size_texels: settings.page_size_texels, ..settings.preset(BakeSettings::standard) };
        let pool = pool(settings.threads)?;
        let prepared = prepare(scene_file, &asked, budget)?;
        let mut warnings = prepared.warnings.clone();
        let Some(path) = prepared.path.clone() else { return Err(no_sun(&prepared)) };
        let (atlas, asked) = pool.install(|| fitting_atlas(&prepared.scene, &asked, &mut warnings, budget))?;
        warnings.extend(atlas.warnings.iter().cloned());
        budget.start(BakeStep::Bvh, 0);
        let geometry = prepared.geometry();
        let tracer = pool.install(|| Tracer::new(&prepared.scene, &geometry));
        let fixed_s = started.elapsed().as_secs_f64();
        if atlas.pages.is_empty() {
            return Err(CostError::NoSurface);
        }
        let samples = pool.install(|| neighbours(&prepared.scene, &geometry, &atlas));
        let page = MeasuredPage { texel_count: atlas.texel_count(), edge_texels: asked.page_size_texels, samples };
        let normals = ShadingNormals::new(&prepared.scene);
        let scene_file = scene_file.to_owned();
        Ok(Self {
            scene_file,
            path,
            geometry,
            tracer,
            normals,
            pool,
            page,
            fixed_s,
            warnings,
            cpu_share: Mutex::default(),
            prepared,
        })
    }

    pub fn scene(&self) -> &Scene {
        &self.prepared.scene
    }

    pub fn path(&self) -> &SunPath {
        &self.path
    }

    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }

    /// Runs `work` on the threads that were asked for.
    pub fn on_threads<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        self.pool.install(work)
    }

    /// The same, and adds up the share of the cores' time that the threads get.
    fn with_cpu_share<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        let before = CpuShare::now();
        let value = self.on_threads(work);
        if let Ok(mut share) = self.cpu_share.lock() {
            share.add(&before, &CpuShare::now());
        }
        value
    }

    /// Share of its threads' time that this process got while all of them worked, 0 to 1; none where the system does
    /// not tell.
    pub fn cores_share(&self) -> Option<f64> {
        self.cpu_share.lock().ok()?.share(self.pool.current_num_threads())
    }

    /// This many lanes across the disc, and the path of each. A light without width has one lane.
    pub fn lanes(&self, count: usize) -> (Vec<Lane>, Vec<SunPath>) {
        let count = if self.path.angular_radius_rad > 0.0 { count } else { 1 };
        let lanes = Lane::across_disc(count, self.path.angular_radius_rad);
        let paths = lanes.iter().map(|lane| self.path.lane(lane.offset_rad)).collect();
        (lanes, paths)
    }

    /// The surface point that a texel stands for, bake space.
    pub fn point(&self, sample: &Sample) -> SurfacePoint {
        atlas::surface_point(self.scene(), &self.geometry, sample)
    }

    /// Unit shading normal at a point of a triangle, on its front.
    pub fn shading_normal(&self, triangle: u32, barycentric: [f64; 2]) -> DVec3 {
        self.normals.at(self.scene(), &self.geometry, triangle as usize, barycentric)
    }

    /// The engine for ambient visibility, with this many rays a point.
    pub fn ambient_engine(&self, rays: u32, seed: u32) -> AmbientEngine<'_> {
        let settings =
            AmbientSettings { rays, distance_m: None, error: None, wants_bent: false, wants_sky: false, seed };
        self.on_threads(|| AmbientEngine::new(self.scene(), &self.geometry, &self.tracer, settings))
    }

    /// Lit intervals of points, for each point one list a lane, and the seconds it took. None if it was stopped.
    pub fn solve_visibility(
        &self,
        engine: &dyn Engine,
        points: &[SurfacePoint],
        budget: &Budget,
    ) -> Option<(Vec<Intervals>, f64)> {
        budget.start(BakeStep::Visibility, points.len() as u64);
        let started = Instant::now();
        let on_progress = |count: usize| {
            budget.advance(count as u64);
            !budget.is_cancelled()
        };
        let solved = self.with_cpu_share(|| solve_visibility(engine, points.len(), |i| points[i], on_progress))?;
        let seconds = started.elapsed().as_secs_f64();
        Some((solved.tables.iter().flat_map(|table| table.iter()).collect(), seconds))
    }

    /// Ambient light of points, run by run, and the seconds it took. None if it was stopped.
    pub fn solve_ambient_at(
        &self,
        engine: &AmbientEngine,
        points: &[AmbientPoint],
        budget: &Budget,
    ) -> Option<(Vec<Estimates>, f64)> {
        budget.start(BakeStep::Ambient, points.len() as u64);
        let started = Instant::now();
        let on_progress = |count: usize| {
            budget.advance(count as u64);
            !budget.is_cancelled()
        };
        let texel = |i: usize, to: &mut Vec<AmbientPoint>| to.push(points[i]);
        let runs = self.with_cpu_share(|| solve_ambient(engine, points.len(), texel, on_progress))?;
        Some((runs, started.elapsed().as_secs_f64()))
    }
}

/// Samples of all pages, neighbours on a surface one after the other.
fn neighbours(scene: &Scene, geometry: &Geometry, atlas: &Atlas) -> Vec<Sample> {
    let of_page = |(page, &size)| {
        let samples = atlas::sample_page(scene, geometry, atlas, page as u32);
        let order = atlas::in_tile_order(&samples, size);
        order.into_iter().map(move |i| samples.samples[i as usize])
    };
    atlas.pages.iter().enumerate().flat_map(of_page).collect()
}

fn no_sun(prepared: &Prepared) -> CostError {
    let why = if prepared.lamp.is_some() { "the path file is a lamp's" } else { "the sun does not rise" };
    CostError::NoSun(why.into())
}

fn pool(threads: usize) -> Result<rayon::ThreadPool, BakeError> {
    let pool = crate::bake::of_threads(threads)?.build();
    pool.map_err(|error| BakeError::Threads { threads, reason: error.to_string() })
}
