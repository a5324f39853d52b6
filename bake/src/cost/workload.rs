//! The scene that is measured, ready to be asked: its hierarchy, its sun, and a page of texels.

use super::budget::Budget;
use super::load::Load;
use super::{CostError, CostSettings};
use crate::BakeError;
use crate::ambient::{AmbientEngine, AmbientPoint, AmbientSettings, Estimates, solve_ambient};
use crate::atlas::{self, Atlas, Sample, SurfacePoint};
use crate::bake::{Prepared, prepare, unwrap_somehow};
use crate::maps::Lane;
use crate::progress::{BakeStage, Progress};
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

/// A scene with all that is made of it once.
pub(super) struct Workload {
    /// Where it was read from.
    pub scene_file: PathBuf,
    prepared: Prepared,
    path: SunPath,
    pub geometry: Geometry,
    pub tracer: Tracer,
    normals: ShadingNormals,
    pool: rayon::ThreadPool,
    /// The page on which knobs are turned.
    pub page: Page,
    /// Seconds that every bake takes before its first texel: reading, unwrapping, building the hierarchy.
    pub fixed_s: f64,
    warnings: Vec<Warning>,
    load: Mutex<Load>,
}

/// A page laid out as a bake would; or several, where a scene does not fit one.
pub(super) struct Page {
    /// Texels, whether or not they stand for a point.
    pub texel_count: u64,
    /// What its edge was asked to be.
    pub edge_texels: u32,
    /// Texels that stand for a point, neighbours together.
    pub samples: Vec<Sample>,
}

impl Workload {
    pub fn new(scene_file: &Path, settings: &CostSettings, budget: &Budget) -> Result<Self, CostError> {
        budget.task("getting ready");
        let started = Instant::now();
        let asked =
            BakeSettings { page_size_texels: settings.page_size_texels, ..settings.preset(BakeSettings::standard) };
        let pool = pool(settings.threads)?;
        let prepared = prepare(scene_file, &asked, budget)?;
        let mut warnings = prepared.warnings.clone();
        let Some(path) = prepared.path.clone() else { return Err(no_sun(&prepared)) };
        let (atlas, asked) = pool.install(|| unwrap_somehow(&prepared.scene, &asked, &mut warnings, budget))?;
        warnings.extend(atlas.warnings.iter().cloned());
        budget.start(BakeStage::Bvh, 0);
        let geometry = Geometry::new(&prepared.scene);
        let tracer = pool.install(|| Tracer::new(&prepared.scene, &geometry));
        let fixed_s = started.elapsed().as_secs_f64();
        if atlas.pages.is_empty() {
            return Err(CostError::NoSurface);
        }
        let samples = pool.install(|| neighbours(&prepared.scene, &geometry, &atlas));
        let page = Page { texel_count: atlas.texel_count(), edge_texels: asked.page_size_texels, samples };
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
            load: Mutex::default(),
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

    /// Runs on as many threads as are asked for.
    pub fn on_threads<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        self.pool.install(work)
    }

    /// The same, with an eye on how much of the cores' time they get.
    fn watched<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        let before = Load::now();
        let value = self.on_threads(work);
        if let Ok(mut load) = self.load.lock() {
            load.add(&before, &Load::now());
        }
        value
    }

    /// Share of its threads' time that this process got while all of them worked, if the system tells.
    pub fn cores_share(&self) -> Option<f64> {
        self.load.lock().ok()?.share(self.pool.current_num_threads())
    }

    /// So many lanes across the disc, and the path of each. A light without width has one.
    pub fn lanes(&self, count: usize) -> (Vec<Lane>, Vec<SunPath>) {
        let count = if self.path.angular_radius_rad > 0.0 { count } else { 1 };
        let lanes = Lane::across_disc(count, self.path.angular_radius_rad);
        let paths = lanes.iter().map(|lane| self.path.lane(lane.offset_rad)).collect();
        (lanes, paths)
    }

    /// A texel's point.
    pub fn point(&self, sample: &Sample) -> SurfacePoint {
        atlas::surface_point(self.scene(), &self.geometry, sample)
    }

    /// The normal that a surface is meant to have at a point of a triangle.
    pub fn shading_normal(&self, triangle: u32, barycentric: [f64; 2]) -> DVec3 {
        self.normals.at(self.scene(), &self.geometry, triangle as usize, barycentric)
    }

    /// Who answers about the sky.
    pub fn sky(&self, rays: u32, seed: u32) -> AmbientEngine<'_> {
        let settings =
            AmbientSettings { rays, distance_m: None, error: None, wants_bent: false, wants_sky: false, seed };
        self.on_threads(|| AmbientEngine::new(self.scene(), &self.geometry, &self.tracer, settings))
    }

    /// When points see the sun: of each point an answer a lane, and the seconds it took. None if it was stopped.
    pub fn solve_visibility(
        &self,
        engine: &dyn Engine,
        points: &[SurfacePoint],
        budget: &Budget,
    ) -> Option<(Vec<Intervals>, f64)> {
        budget.start(BakeStage::Visibility, points.len() as u64);
        let started = Instant::now();
        let told = |count: usize| {
            budget.advance(count as u64);
            !budget.is_cancelled()
        };
        let (tables, _) = self.watched(|| solve_visibility(engine, points.len(), |i| points[i], told))?;
        let seconds = started.elapsed().as_secs_f64();
        Some((tables.iter().flat_map(|table| table.iter()).collect(), seconds))
    }

    /// How much of the sky points see, run by run, and the seconds it took. None if it was stopped.
    pub fn find_open(
        &self,
        engine: &AmbientEngine,
        points: &[AmbientPoint],
        budget: &Budget,
    ) -> Option<(Vec<Estimates>, f64)> {
        budget.start(BakeStage::Ambient, points.len() as u64);
        let started = Instant::now();
        let told = |count: usize| {
            budget.advance(count as u64);
            !budget.is_cancelled()
        };
        let texel = |i: usize, to: &mut Vec<AmbientPoint>| to.push(points[i]);
        let runs = self.watched(|| solve_ambient(engine, points.len(), texel, told))?;
        Some((runs, started.elapsed().as_secs_f64()))
    }
}

/// Samples of all pages, what lies side by side on a surface one after the other.
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
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.map_err(|error| BakeError::Threads { threads, reason: error.to_string() })
}
