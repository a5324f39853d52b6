//! Time per texel of each engine, measured in one run: `cargo bench -p sunbake --bench engines`.
//!
//! Our own scene and four shared ones, where they are on this machine (`SUNBAKE_SHARED`, or `shared` beside the
//! repository), each laid out for about a million texels. Every engine answers the same runs of neighbouring texels,
//! drawn evenly from whole pages; engines take turns, run by run, so that other load on the machine affects all of
//! them. Times are CPU times of the threads where the system provides them (Linux), or else wall-clock times.
//!
//! Options after `--`: `texels=1000000 runs=64 scene=NAME only=engines|exact|scaling|growth`.

mod common;

use rayon::prelude::*;
use std::collections::HashMap;
use std::path::Path;
use std::time::Instant;
use sunbake::atlas::{self, AtlasSettings, Density, SurfacePoint};
use sunbake::maps::Lane;
use sunbake::scene::{Geometry, LoadLimits, Mesh, Scene, load};
use sunbake::sun::{DayOutcome, SunPath, day};
use sunbake::trace::Tracer;
use sunbake::visibility::{BisectEngine, Engine, ExactEngine, IntervalTable, RayEngine, Work};

const SHARED: [&str; 4] = [
    "osrf_city/osrf_city.glb",
    "littlest_tokyo/littlest_tokyo.glb",
    "two_cylinder_engine/2CylinderEngine.glb",
    "delft_3d/delft_node.glb",
];
/// The city that is tessellated.
const CITY: &str = "delft_node";
/// Points of a run.
const RUN: usize = 1024;

fn main() {
    let options = Options::from_arguments();
    let scenes: Vec<Subject> = common::scenes(&SHARED).iter().filter_map(|file| Subject::new(file, &options)).collect();
    if options.only.as_deref() == Some("exact") {
        exact_alone(&scenes);
    }
    if options.wants("engines") {
        engines(&scenes);
    }
    if options.wants("scaling") {
        scaling(&scenes);
    }
    if options.wants("growth") {
        scenes.iter().filter(|scene| scene.name == CITY).for_each(growth);
    }
}

struct Options {
    texels: f64,
    runs: usize,
    scene: Option<String>,
    only: Option<String>,
}

impl Options {
    fn from_arguments() -> Self {
        let given: HashMap<String, String> =
            std::env::args().filter_map(|a| a.split_once('=').map(|(k, v)| (k.to_owned(), v.to_owned()))).collect();
        let number = |key: &str, otherwise: f64| given.get(key).and_then(|v| v.parse().ok()).unwrap_or(otherwise);
        Self {
            texels: number("texels", 1e6),
            runs: number("runs", 64.0) as usize,
            scene: given.get("scene").cloned(),
            only: given.get("only").cloned(),
        }
    }

    fn wants(&self, part: &str) -> bool {
        self.only.as_deref().is_none_or(|only| only == part)
    }
}

/// A scene, and the points that are solved.
struct Subject {
    name: String,
    scene: Scene,
    geometry: Geometry,
    runs: Vec<Vec<SurfacePoint>>,
}

impl Subject {
    fn new(file: &Path, options: &Options) -> Option<Self> {
        let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        if options.scene.as_ref().is_some_and(|wanted| !name.contains(wanted)) {
            return None;
        }
        let scene = load(file, &LoadLimits::default()).expect("the scene loads");
        let geometry = Geometry::new(&scene);
        let runs = runs_of_points(&scene, &geometry, options);
        Some(Self { name, scene, geometry, runs })
    }
}

/// Every engine on every scene, one thread.
fn engines(scenes: &[Subject]) {
    println!("One thread; microseconds a texel, and work a texel:");
    println!(
        "| scene | triangles | rays:256 | bisect:32 to 1 s | exact | nodes | triangles | rays / exact | \
         bisect / exact |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    let mut ratios = Vec::new();
    for Subject { name, scene, geometry, runs } in scenes {
        let tracer = Tracer::new(scene, geometry);
        let lanes = [summer_day()];
        let exact = ExactEngine::new(&tracer, &lanes);
        let (rays, bisect) = (RayEngine::new(&tracer, &lanes, 256), BisectEngine::new(&tracer, &lanes, 32, 1.0));
        let [rays, bisect, exact] = side_by_side([&rays, &bisect, &exact], runs);
        let ratio = [rays.us / exact.us, bisect.us / exact.us];
        println!(
            "| {name} | {} | {:.2} | {:.2} | {:.2} | {:.1} | {:.1} | {:.2} | {:.2} |",
            geometry.triangles.len(),
            rays.us,
            bisect.us,
            exact.us,
            exact.nodes,
            exact.triangles,
            ratio[0],
            ratio[1]
        );
        ratios.push(ratio);
    }
    let mean = |k: usize| (ratios.iter().map(|r| r[k].ln()).sum::<f64>() / ratios.len() as f64).exp();
    let least = |k: usize| ratios.iter().map(|r| r[k]).fold(f64::INFINITY, f64::min);
    println!(
        "Geometric mean: {:.2} times rays:256 (least {:.2}), {:.2} times bisect:32 (least {:.2}).\n",
        mean(0),
        least(0),
        mean(1),
        least(1)
    );
}

/// The exact engine by itself: for a profiler.
fn exact_alone(scenes: &[Subject]) {
    println!("The exact engine, one thread; a texel:\n| scene | us | nodes | triangles |\n|---|---|---|---|");
    for Subject { name, scene, geometry, runs } in scenes {
        let tracer = Tracer::new(scene, geometry);
        let exact = ExactEngine::new(&tracer, &[summer_day()]);
        let [Taken { us, nodes, triangles }] = side_by_side([&exact], runs);
        println!("| {name} | {us:.2} | {nodes:.1} | {triangles:.1} |");
    }
}

/// Time of an engine per texel.
#[derive(Clone, Copy, Default)]
struct Taken {
    us: f64,
    nodes: f64,
    triangles: f64,
}

fn side_by_side<const N: usize>(engines: [&dyn Engine; N], runs: &[Vec<SurfacePoint>]) -> [Taken; N] {
    let mut taken = [Taken::default(); N];
    let texels = runs.iter().map(Vec::len).sum::<usize>() as f64;
    for run in runs {
        for (engine, taken) in engines.iter().zip(&mut taken) {
            let (work, seconds) = ask(*engine, run);
            taken.us += seconds * 1e6 / texels;
            taken.nodes += work.nodes as f64 / texels;
            taken.triangles += work.triangles as f64 / texels;
        }
    }
    taken
}

fn ask(engine: &dyn Engine, run: &[SurfacePoint]) -> (Work, f64) {
    let started = (thread_seconds(), Instant::now());
    let mut session = engine.session();
    session.lit(run, &mut IntervalTable::default());
    let seconds = match (started.0, thread_seconds()) {
        (Some(from), Some(to)) => to - from,
        _ => started.1.elapsed().as_secs_f64(),
    };
    (session.work(), seconds)
}

/// Seconds that this thread has run.
fn thread_seconds() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    Some(text.split(' ').next()?.parse::<f64>().ok()? * 1e-9)
}

/// Two threads against one, by the clock, and three lanes and five against one.
fn scaling(scenes: &[Subject]) {
    println!("The exact engine: two threads against one by the clock, and lanes against one:");
    println!("| scene | texels a second, 1 thread | 2 threads | speed-up | 3 lanes, times as long | 5 lanes |");
    println!("|---|---|---|---|---|---|");
    for Subject { name, scene, geometry, runs } in scenes {
        let tracer = Tracer::new(scene, geometry);
        let path = summer_day();
        let lanes = |count| -> Vec<SunPath> {
            Lane::across_disc(count, path.angular_radius_rad).iter().map(|lane| path.lane(lane.offset_rad)).collect()
        };
        let [one, three, five] = [1, 3, 5].map(|count| ExactEngine::new(&tracer, &lanes(count)));
        let rates = [1, 2].map(|threads| texels_a_second(&one, runs, threads));
        let taken = side_by_side([&one, &three, &five], runs);
        println!(
            "| {name} | {:.0} | {:.0} | {:.2} | {:.2} | {:.2} |",
            rates[0],
            rates[1],
            rates[1] / rates[0],
            taken[1].us / taken[0].us,
            taken[2].us / taken[0].us
        );
    }
    println!();
}

fn texels_a_second(engine: &dyn Engine, runs: &[Vec<SurfacePoint>], threads: usize) -> f64 {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads start");
    let started = Instant::now();
    pool.install(|| {
        runs.par_iter().for_each(|run| {
            ask(engine, run);
        });
    });
    runs.iter().map(Vec::len).sum::<usize>() as f64 / started.elapsed().as_secs_f64()
}

/// The same points of the same city at 1, 4 and 16 times the tessellation.
fn growth(subject: &Subject) {
    println!("{}, its triangles cut in four, and again:", subject.name);
    println!("| triangles | rays:256, us | exact, us | nodes | triangles |");
    println!("|---|---|---|---|---|");
    let mut scene = subject.scene.clone();
    let mut us = Vec::new();
    for level in 0..3 {
        let geometry = Geometry::new(&scene);
        let tracer = Tracer::new(&scene, &geometry);
        let lanes = [summer_day()];
        let (rays, exact) = (RayEngine::new(&tracer, &lanes, 256), ExactEngine::new(&tracer, &lanes));
        let of_level = |point: &SurfacePoint| SurfacePoint { triangle: point.triangle << (2 * level), ..*point };
        let runs: Vec<Vec<SurfacePoint>> = subject.runs.iter().map(|run| run.iter().map(of_level).collect()).collect();
        let [rays, exact] = side_by_side([&rays, &exact], &runs);
        println!(
            "| {} | {:.2} | {:.2} | {:.1} | {:.1} |",
            geometry.triangles.len(),
            rays.us,
            exact.us,
            exact.nodes,
            exact.triangles
        );
        us.push([rays.us, exact.us]);
        scene.meshes.iter_mut().for_each(quarter);
    }
    let exponent = |k: usize| (us[2][k] / us[0][k]).ln() / 16f64.ln();
    println!("Time grows as triangles to the power of {:.2} (rays:256: {:.2}).", exponent(1), exponent(0));
}

/// Cuts every triangle in four at the middles of its edges; the first of the four stands where its parent stood.
fn quarter(mesh: &mut Mesh) {
    let old = std::mem::take(&mut mesh.positions);
    let triangles: Vec<[u32; 3]> = mesh.indices.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect();
    mesh.indices.clear();
    for corners in triangles {
        let [a, b, c] = corners.map(|i| old[i as usize]);
        let [ab, bc, ca] = [(a + b) * 0.5, (b + c) * 0.5, (c + a) * 0.5];
        for triangle in [[ab, bc, ca], [a, ab, ca], [ab, b, bc], [ca, bc, c]] {
            mesh.indices.extend((0..3).map(|k| (mesh.positions.len() + k) as u32));
            mesh.positions.extend(triangle);
        }
    }
    mesh.texcoords = Vec::new();
    (mesh.normals, mesh.colors) = Default::default();
}

/// Runs of neighbouring points, evenly drawn from all pages.
fn runs_of_points(scene: &Scene, geometry: &Geometry, options: &Options) -> Vec<Vec<SurfacePoint>> {
    let density = density_for(scene, geometry, options.texels);
    let settings = AtlasSettings { density, page_size_texels: 4096, padding_texels: 2, ..AtlasSettings::default() };
    let atlas = atlas::build(scene, &settings, &|_| true).expect("the scene is laid out");
    let mut runs = Vec::new();
    for (page, &size) in atlas.pages.iter().enumerate() {
        let samples = atlas::sample_page(scene, geometry, &atlas, page as u32);
        let order = atlas::in_tile_order(&samples, size);
        let point = |&i: &u32| atlas::surface_point(scene, geometry, &samples.samples[i as usize]);
        runs.extend(order.chunks(RUN).map(|run| run.iter().map(point).collect::<Vec<_>>()));
    }
    let step = (runs.len() / options.runs).max(1);
    runs.into_iter().step_by(step).collect()
}

/// Texels a metre that give about this many texels, were every surface seen once.
fn density_for(scene: &Scene, geometry: &Geometry, texels: f64) -> Density {
    let area = |i: usize| {
        let [a, b, c] = geometry.triangles[i].map(|v| v.as_dvec3());
        0.5 * (b - a).cross(c - a).length()
    };
    let total: f64 = (0..geometry.triangles.len()).filter(|&i| geometry.receives(scene, i)).map(area).sum();
    Density::TexelsPerMetre((texels / total).sqrt())
}

fn summer_day() -> SunPath {
    match day(&common::summer_day()) {
        Ok(DayOutcome::Path(path)) => path,
        other => panic!("the sun rises there: {other:?}"),
    }
}
