//! Ambient occlusion: rays a second, error against time, threads: `cargo bench -p sunbake --bench ambient`.
//!
//! Our own scene and three shared ones, where they are on this machine (`SUNBAKE_SHARED`, or `shared` beside the
//! repository), each laid out on a page of 1024. Error is measured on runs of neighbouring texels drawn evenly from the
//! page, against [`TRUTH_RAYS`] rays of other seeds. The two methods take turns, so that other load on the machine
//! affects both: this crate's estimate, and *plain random* sampling, which traces the same hierarchy in independent
//! directions.
//!
//! Options after `--`: `size=1024 runs=6 scene=NAME only=error|pages|threads plot=FILE.svg`. The plot shows errors
//! against time.

mod common;
mod plot;

use glam::DVec3;
use std::collections::HashMap;
use std::path::Path;
use std::time::Instant;
use sunbake::ambient::{AmbientEngine, AmbientPoint, AmbientSettings, solve_ambient};
use sunbake::atlas::{self, Atlas, AtlasSettings, PageSamples, Sample};
use sunbake::scene::{Geometry, LoadLimits, Scene, ShadingNormals, load};
use sunbake::testing::pseudo_random;
use sunbake::trace::{PacketScratch, PacketTracer, ShadowQuery, Tracer};

const SHARED: [&str; 3] =
    ["osrf_city/osrf_city.glb", "littlest_tokyo/littlest_tokyo.glb", "two_cylinder_engine/2CylinderEngine.glb"];
/// Rays of the reference.
const TRUTH_RAYS: u32 = 65_536;
/// Texels of a run.
const RUN: usize = 512;

fn main() {
    let given: HashMap<String, String> =
        std::env::args().filter_map(|a| a.split_once('=').map(|(k, v)| (k.to_owned(), v.to_owned()))).collect();
    let number = |key: &str, otherwise: usize| given.get(key).and_then(|v| v.parse().ok()).unwrap_or(otherwise);
    let wants = |part: &str| given.get("only").is_none_or(|only| only == part);
    let mut curves: Vec<(String, Curves)> = Vec::new();
    for file in common::scenes(&SHARED) {
        let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        if given.get("scene").is_some_and(|wanted| *wanted != name) {
            continue;
        }
        let scene = match load(&file, &LoadLimits::default()) {
            Ok(scene) => scene,
            Err(error) => {
                println!("{name}: {error}");
                continue;
            }
        };
        let page = Page::new(&scene, number("size", 1024) as u32);
        println!("\n{name}: {} triangles, {} texels", scene.triangle_count(), page.texels.len());
        if wants("pages") {
            pages(&page);
        }
        if wants("threads") {
            threads(&page);
        }
        if wants("error") {
            curves.push((name, errors(&page, number("runs", 6))));
        }
    }
    if let Some(file) = given.get("plot").filter(|_| !curves.is_empty()) {
        match plot::draw(Path::new(file), &curves) {
            Ok(()) => println!("\nplotted in {file}"),
            Err(error) => println!("\n{file}: {error}"),
        }
    }
}

/// Microseconds a texel and root mean square error, with more and more rays: ours, and plain random sampling's.
type Curves = [Vec<(f64, f64)>; 2];

/// A page of a scene.
struct Page<'a> {
    scene: &'a Scene,
    geometry: Geometry,
    normals: ShadingNormals,
    tracer: Tracer,
    texels: Vec<Sample>,
}

impl<'a> Page<'a> {
    fn new(scene: &'a Scene, edge: u32) -> Self {
        let settings = AtlasSettings { page_size_texels: edge, ..AtlasSettings::default() };
        let atlas: Atlas = atlas::build(scene, &settings, &|_| true).expect("an atlas");
        let geometry = Geometry::new(scene);
        let PageSamples { samples } = atlas::sample_page(scene, &geometry, &atlas, 0);
        let order = atlas::in_tile_order(&PageSamples { samples: samples.clone() }, atlas.pages[0]);
        let texels = order.iter().map(|&i| samples[i as usize]).collect();
        let tracer = Tracer::new(scene, &geometry);
        Self { scene, normals: ShadingNormals::new(scene), tracer, geometry, texels }
    }

    fn point(&self, index: usize) -> AmbientPoint {
        let sample = &self.texels[index];
        let weights = sample.barycentric.map(f64::from);
        let shading_normal = self.normals.at(self.scene, &self.geometry, sample.triangle as usize, weights);
        AmbientPoint { surface: atlas::surface_point(self.scene, &self.geometry, sample), shading_normal }
    }

    fn engine(&self, settings: AmbientSettings) -> AmbientEngine<'_> {
        AmbientEngine::new(self.scene, &self.geometry, &self.tracer, settings)
    }

    /// Ambient visibility of some texels, and rays traced.
    fn visibility(&self, engine: &AmbientEngine, texels: &[usize]) -> (Vec<f64>, u64) {
        let texel = |i: usize, points: &mut Vec<AmbientPoint>| {
            points.push(self.point(texels[i]));
        };
        let runs = solve_ambient(engine, texels.len(), texel, |_| true).expect("nobody stops it");
        let rays = runs.iter().map(|run| run.rays).sum();
        (runs.iter().flat_map(|run| &run.front).map(|estimate| f64::from(estimate.visibility)).collect(), rays)
    }
}

fn settings(rays: u32) -> AmbientSettings {
    AmbientSettings { rays, distance_m: None, error: None, wants_bent: false, wants_sky: false, seed: 0 }
}

fn on<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> (T, f64) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    pool.install(|| {
        let start = Instant::now();
        let value = work();
        (value, start.elapsed().as_secs_f64())
    })
}

/// Whole pages.
fn pages(page: &Page) {
    let all: Vec<usize> = (0..page.texels.len()).collect();
    println!("{:<28}{:>9}{:>12}{:>12}", "whole page, all threads", "seconds", "M rays/s", "us a texel");
    let extent_m = page.scene.half_extent_m.max_element();
    let cases = [
        ("64 rays", settings(64)),
        ("256 rays", settings(256)),
        ("64, bent and sh2", AmbientSettings { wants_bent: true, wants_sky: true, ..settings(64) }),
        ("64, within a tenth", AmbientSettings { distance_m: Some(0.1 * extent_m), ..settings(64) }),
        ("to 0.02, at most 4096", AmbientSettings { error: Some(0.02), ..settings(4096) }),
    ];
    for (name, settings) in cases {
        let start = Instant::now();
        let engine = page.engine(settings);
        let (_, rays) = page.visibility(&engine, &all);
        let seconds = start.elapsed().as_secs_f64();
        let a_texel = seconds / all.len() as f64 * 1e6;
        println!("{name:<28}{seconds:>9.2}{:>12.2}{a_texel:>12.2}", rays as f64 / seconds / 1e6);
    }
}

/// One thread against two.
fn threads(page: &Page) {
    let all: Vec<usize> = (0..page.texels.len()).collect();
    let engine = page.engine(settings(64));
    let mut seconds = [0.0; 2];
    for _ in 0..3 {
        for (threads, sum) in [1, 2].into_iter().zip(&mut seconds) {
            *sum += on(threads, || page.visibility(&engine, &all)).1;
        }
    }
    println!("two threads: {:.2} times one", seconds[0] / seconds[1]);
}

/// Error against time, one thread.
fn errors(page: &Page, runs: usize) -> Curves {
    let runs = runs.max(1);
    let step = (page.texels.len() / runs).max(RUN);
    let texels: Vec<usize> =
        (0..page.texels.len()).step_by(step).flat_map(|s| s..(s + RUN).min(page.texels.len())).collect();
    let truth = page.visibility(&page.engine(AmbientSettings { seed: 1, ..settings(TRUTH_RAYS) }), &texels).0;
    let scatter = PacketTracer::new(&page.tracer);
    println!(
        "{:<8}{:>12}{:>12}{:>12}{:>12}{:>14}",
        "rays", "us a texel", "rms error", "random: us", "rms error", "at equal time"
    );
    let mut last: Option<f64> = None;
    let mut curves: Curves = [Vec::new(), Vec::new()];
    for rays in (2..=12).map(|bits| 1u32 << bits) {
        let engine = page.engine(settings(rays));
        let ((found, _), ours_s) = on(1, || page.visibility(&engine, &texels));
        let (plain, plain_s) = on(1, || random(page, &scatter, &texels, rays));
        let [ours, theirs] = [&found, &plain].map(|found| rms(found, &truth));
        // Random error falls with the square root of time.
        let at_equal_time = theirs * (plain_s / ours_s).sqrt();
        let per = |seconds: f64| seconds / texels.len() as f64 * 1e6;
        let slope = last.map_or(String::new(), |before| format!("  N^{:.2}", (ours / before).log2()));
        println!(
            "{rays:<8}{:>12.2}{ours:>12.5}{:>12.2}{theirs:>12.5}{:>13.2}x{slope}",
            per(ours_s),
            per(plain_s),
            ours / at_equal_time
        );
        last = Some(ours);
        for (curve, point) in curves.iter_mut().zip([(per(ours_s), ours), (per(plain_s), theirs)]) {
            curve.push(point);
        }
    }
    curves
}

fn rms(found: &[f64], truth: &[f64]) -> f64 {
    (found.iter().zip(truth).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / truth.len() as f64).sqrt()
}

/// Independent directions: no low-discrepancy sequence, no order, no guesses. Backs are traced as well where there are
/// any, since the estimate traces them too; the results are those of the fronts.
fn random(page: &Page, scatter: &PacketTracer, texels: &[usize], rays: u32) -> Vec<f64> {
    let mut room = PacketScratch::default();
    let mut state = 0x51_7cc1_b727;
    let mut answer = |&index: &usize| {
        let AmbientPoint { surface, shading_normal } = page.point(index);
        let mut side = |sign: f64| {
            let (plane, normal) = (surface.normal * sign, shading_normal * sign);
            let origin_m = page.tracer.lift(surface.position_m, plane, surface.triangle);
            let (across, up) = normal.any_orthonormal_pair();
            let (mut count, mut free) = (0u32, 0u32);
            for _ in 0..rays {
                let radius = pseudo_random(&mut state).sqrt();
                let (sin, cos) = (pseudo_random(&mut state) * std::f64::consts::TAU).sin_cos();
                let height = (1.0 - radius * radius).max(0.0).sqrt();
                let direction: DVec3 = across * (radius * cos) + up * (radius * sin) + normal * height;
                if direction.dot(plane) > 0.0 {
                    let ray = ShadowQuery { origin_m, direction, triangle: surface.triangle };
                    count += 1;
                    free += u32::from(scatter.occluded(&mut room, &[ray], &mut None) == 0);
                }
            }
            f64::from(free) / f64::from(count.max(1))
        };
        let front = side(1.0);
        if surface.is_double_sided {
            side(-1.0);
        }
        front
    };
    texels.iter().map(&mut answer).collect()
}
