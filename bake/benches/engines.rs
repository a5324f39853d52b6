//! What each engine takes for a texel, side by side in one run: `cargo bench -p sunbake --bench engines`.
//!
//! Our own scene and four shared ones, where they are on this machine (`SUNBAKE_SHARED`, or `shared` beside the
//! repository), each laid out for about a million texels. Every engine answers the same runs of neighbouring texels, drawn
//! evenly from whole pages; engines take turns, run by run, so that whatever else the machine does falls on all alike.
//! Arguments after `--`: `texels=1000000 runs=64 rays=256 threads=1 lanes=1 scene=NAME`.

use rayon::prelude::*;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::time::Instant;
use sunbake::atlas::{self, AtlasSettings, Density, SurfacePoint};
use sunbake::scene::{Geometry, LoadLimits, Scene, load};
use sunbake::sun::{DayOutcome, DayRequest, SunPath, day};
use sunbake::trace::Tracer;
use sunbake::visibility::{Engine, ExactEngine, IntervalTable, RayEngine, Work};

const SHARED: [&str; 4] = [
    "osrf_city/osrf_city.glb",
    "littlest_tokyo/littlest_tokyo.glb",
    "two_cylinder_engine/2CylinderEngine.glb",
    "delft_3d/delft_node.glb",
];

fn main() {
    let options = Options::from_arguments();
    println!("about {} texels, {} runs of {RUN}, {} lane(s)", options.texels, options.runs, options.lanes);
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("../assets/gas_station.glb");
    for file in std::iter::once(own).chain(shared_scenes()) {
        let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        if options.scene.as_ref().is_none_or(|wanted| name.contains(wanted)) {
            bench(&name, &file, &options);
        }
    }
}

/// Points of a run: what a thread is given at once in a bake.
const RUN: usize = 1024;

struct Options {
    texels: usize,
    runs: usize,
    rays: usize,
    threads: usize,
    lanes: usize,
    scene: Option<String>,
}

impl Options {
    fn from_arguments() -> Self {
        let given: HashMap<String, String> =
            std::env::args().filter_map(|a| a.split_once('=').map(|(k, v)| (k.to_owned(), v.to_owned()))).collect();
        let number = |key: &str, otherwise| given.get(key).and_then(|v| v.parse().ok()).unwrap_or(otherwise);
        Self {
            texels: number("texels", 1_000_000),
            runs: number("runs", 64),
            rays: number("rays", 256),
            threads: number("threads", 1),
            lanes: number("lanes", 1),
            scene: given.get("scene").cloned(),
        }
    }
}

fn shared_scenes() -> Vec<PathBuf> {
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared");
    let folder = std::env::var_os("SUNBAKE_SHARED").map_or_else(beside, PathBuf::from).join("scenes");
    let (present, absent): (Vec<_>, Vec<_>) = SHARED.iter().map(|name| folder.join(name)).partition(|f| f.is_file());
    absent.iter().for_each(|file| println!("not on this machine: {}", file.display()));
    present
}

fn bench(name: &str, file: &Path, options: &Options) {
    let scene = load(file, &LoadLimits::default()).expect("the scene loads");
    let geometry = Geometry::new(&scene);
    let points = runs_of_points(&scene, &geometry, options);
    let path = summer_day();
    let lanes: Vec<SunPath> = match options.lanes {
        1 => vec![path],
        count => (0..count)
            .map(|i| path.lane(path.angular_radius_rad * (2.0 * i as f64 / (count - 1) as f64 - 1.0) * 0.7))
            .collect(),
    };
    let started = Instant::now();
    let tracer = Tracer::new(&scene, &geometry);
    let tracer_s = started.elapsed().as_secs_f64();
    let started = Instant::now();
    let exact = ExactEngine::new(&tracer, &lanes);
    let exact_s = started.elapsed().as_secs_f64();
    let rays = RayEngine::new(&tracer, &lanes, options.rays);
    let count: usize = points.iter().map(Vec::len).sum();
    println!(
        "{name}: {} triangles, {count} texels looked at; tracer {tracer_s:.2} s, exact hierarchy {exact_s:.2} s",
        geometry.triangles.len()
    );
    let engines: [&dyn Engine; 2] = [&rays, &exact];
    let mut seconds = [0.0; 2];
    let mut work = [Work::default(); 2];
    let mut worst: f64 = 0.0;
    let mut sums = [0.0; 2];
    let mut different = 0;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(options.threads).build().expect("threads");
    for some in points.chunks(options.threads) {
        let mut answers: [Vec<IntervalTable>; 2] = [Vec::new(), Vec::new()];
        for (index, engine) in engines.iter().enumerate() {
            let found: Vec<(IntervalTable, Work, f64)> =
                pool.install(|| some.par_iter().map(|run| ask(*engine, run)).collect());
            for (table, done, s) in found {
                seconds[index] += s;
                work[index] = work[index] + done;
                answers[index].push(table);
            }
        }
        for (a, b) in answers[0].iter().zip(&answers[1]) {
            for (a, b) in a.iter().zip(b.iter()) {
                sums[0] += a.lit_length();
                sums[1] += b.lit_length();
                let difference = (a.lit_length() - b.lit_length()).abs();
                worst = worst.max(difference);
                different += usize::from(difference > 2.0 / options.rays as f64);
            }
        }
    }
    for (engine, (seconds, work)) in engines.iter().zip(seconds.iter().zip(&work)) {
        let each = |x: u64| x as f64 / count as f64;
        println!(
            "  {:<12}{:>9.3} us a texel {:>8.1} rays {:>8.1} nodes {:>8.1} triangles",
            engine.name(),
            seconds / count as f64 * 1e6,
            each(work.rays),
            each(work.nodes),
            each(work.triangles)
        );
    }
    println!(
        "  ratio {:.2}; mean lit {:.6} {:.6}; largest difference {worst:.4}, {different} texels over two steps",
        seconds[0] / seconds[1],
        sums[0] / (count * options.lanes) as f64,
        sums[1] / (count * options.lanes) as f64
    );
}

fn cpu_seconds() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    text.split(' ').next().and_then(|ns| ns.parse::<f64>().ok()).unwrap_or(0.0) * 1e-9
}

fn ask(engine: &dyn Engine, run: &[SurfacePoint]) -> (IntervalTable, Work, f64) {
    let started = cpu_seconds();
    let mut table = IntervalTable::default();
    let mut session = engine.session();
    session.lit(run, &mut table);
    let work = session.work();
    (table, work, cpu_seconds() - started)
}

/// Runs of neighbouring points, evenly drawn from all pages.
fn runs_of_points(scene: &Scene, geometry: &Geometry, options: &Options) -> Vec<Vec<SurfacePoint>> {
    let density = density_for(scene, options.texels);
    let settings = AtlasSettings { density, page_size_texels: 4096, padding_texels: 2, ..AtlasSettings::default() };
    let atlas = atlas::build(scene, &settings, &|_| true).expect("the scene is laid out");
    let mut runs = Vec::new();
    for (page, &size) in atlas.pages.iter().enumerate() {
        let samples = atlas::sample_page(scene, geometry, &atlas, page as u32);
        let order = atlas::by_tiles(&samples, size);
        let point = |&i: &u32| atlas::surface_point(scene, geometry, &samples.samples[i as usize]);
        runs.extend(order.chunks(RUN).map(|run| run.iter().map(point).collect::<Vec<_>>()));
    }
    println!("{} texels in all", runs.iter().map(Vec::len).sum::<usize>());
    let step = (runs.len() / options.runs).max(1);
    runs.into_iter().step_by(step).collect()
}

/// Texels a metre that give about this many texels, were all of the surface seen once.
fn density_for(scene: &Scene, texels: usize) -> Density {
    let geometry = Geometry::new(scene);
    let area = |i: usize| {
        let [a, b, c] = geometry.triangles[i].map(|v| v.as_dvec3());
        0.5 * (b - a).cross(c - a).length()
    };
    let total: f64 = (0..geometry.triangles.len()).filter(|&i| geometry.is_solid(scene, i)).map(area).sum();
    Density::TexelsPerMetre((texels as f64 / total).sqrt())
}

fn summer_day() -> SunPath {
    let request = DayRequest {
        latitude_deg: 35.0,
        longitude_deg: -116.0,
        date: "2026-06-21".parse().expect("a date"),
        utc_offset_h: Some(-7.0),
        north_deg: 0.0,
        window: None,
    };
    match day(&request) {
        Ok(DayOutcome::Path(path)) => path,
        other => panic!("the sun rises there: {other:?}"),
    }
}
