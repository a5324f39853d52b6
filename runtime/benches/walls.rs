//! What keeping filters from blending across walls is worth, and what it takes: `cargo bench -p sunbake-runtime --bench
//! walls`.
//!
//! Points drawn evenly over all surfaces, at 24 times of a June day, played back with and without the maps of walls,
//! against the exact engine at each point. *Leak* is the light shown where the truth has none, *shade* what is missing
//! where the sun is seen: means over all points and times, in percent of the sun. *Worst* is the most light shown at a
//! point that never sees the sun. Times of playback are of one thread, in turn.
//!
//! Options after `--`: `points=40000 density=10 scene=NAME`.

#[path = "../../bake/benches/common/mod.rs"]
#[expect(dead_code, reason = "scenes are named with their densities here")]
mod common;

use std::path::Path;
use std::time::Instant;
use sunbake::atlas::{Density, SurfacePoint};
use sunbake::progress::Silent;
use sunbake::scene::{LoadLimits, load};
use sunbake::settings::{BakeSettings, SunRequest};
use sunbake::sun::DayRequest;
use sunbake::visibility::{ExactEngine, IntervalTable, solve_visibility};
use sunbake_runtime::playback::Page;
use sunbake_runtime::{Filter, Stage};

const TIMES: usize = 24;

/// Scenes with the densities that they are baked at, in texels a metre.
const SCENES: [(&str, f64); 7] = [
    ("tests/cases/27_sheets/scene.glb", 4.0),
    ("tests/cases/11_leak/one.glb", 4.0),
    ("tests/cases/20_house/T0.1.glb", 4.0),
    ("tests/cases/20_house/T0.1.glb", 10.0),
    ("assets/gas_station.glb", 5.0),
    ("../shared/scenes/osrf_city/osrf_city.glb", 1.0),
    ("../shared/scenes/pc_house/house.glb", 10.0),
];

fn main() {
    let given = common::given();
    let number = |key: &str, otherwise: f64| given.get(key).and_then(|v| v.parse().ok()).unwrap_or(otherwise);
    println!("| scene | texels/m | leak % | shade % | worst | playback, of plain | MiB, of plain |");
    println!("|---|---|---|---|---|---|---|");
    for (name, density) in SCENES {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(name);
        if !path.exists() || given.get("scene").is_some_and(|wanted| !name.contains(wanted)) {
            continue;
        }
        measure(&path, number("density", density), number("points", 40_000.0) as usize);
    }
}

fn measure(path: &Path, texels_per_metre: f64, point_count: usize) {
    let day = DayRequest::new(Some([40.0, 0.0]), "2026-06-21".parse().ok()).expect("a day");
    let settings = BakeSettings {
        density: Density::TexelsPerMetre(texels_per_metre),
        ambient: None,
        ..BakeSettings::standard(SunRequest::Day(day))
    };
    let scene = load(path, &LoadLimits::default()).expect("it loads");
    let with = sunbake::bake_scene(&scene, &settings, &Silent).expect("it bakes");
    let mut without = with.clone();
    without.pages.iter_mut().for_each(|page| page.maps.walls = None);
    let stages = [without, with].map(|bake| Stage::of_bake(bake).expect("a stage"));
    let points = points_on(&stages[0], point_count);
    let truth = truth_at(&stages[0], &points);
    let [plain, walled] = stages.each_ref().map(|stage| Errors::of(stage, &points, &truth));
    let [before, after] = stages.each_ref().map(|stage| stage.gpu_bytes() as f64);
    println!(
        "| {} | {texels_per_metre} | {:.3} -> {:.3} | {:.3} -> {:.3} | {:.2} -> {:.2} | {:.2} | {:.2} |",
        path.file_name().map(|name| name.to_string_lossy()).unwrap_or_default(),
        plain.leak_percent,
        walled.leak_percent,
        plain.shade_percent,
        walled.shade_percent,
        plain.worst,
        walled.worst,
        walled.seconds / plain.seconds,
        after / before,
    );
}

/// Evenly drawn points: a triangle and the weights of its second and third corner.
fn points_on(stage: &Stage, count: usize) -> Vec<(usize, [f64; 2])> {
    let mut state = 1u64;
    let mut next = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as f64 / (1u64 << 31) as f64
    };
    let drawn: Vec<usize> = (0..stage.geometry.triangles.len())
        .filter(|&triangle| stage.chart(stage.geometry.instance[triangle] as usize).is_some())
        .collect();
    let area = |triangle: usize| {
        let [a, b, c] = stage.geometry.triangles[triangle].map(|v| v.as_dvec3());
        (b - a).cross(c - a).length()
    };
    let mut sums = Vec::with_capacity(drawn.len());
    let mut total = 0.0;
    for &triangle in &drawn {
        total += area(triangle);
        sums.push(total);
    }
    let mut draw = |_| {
        let wanted = next() * total;
        let triangle = drawn[sums.partition_point(|sum| *sum < wanted).min(drawn.len() - 1)];
        let (u, v) = (next(), next());
        (triangle, if u + v > 1.0 { [1.0 - u, 1.0 - v] } else { [u, v] })
    };
    (0..count).map(&mut draw).collect()
}

fn truth_at(stage: &Stage, points: &[(usize, [f64; 2])]) -> Vec<Vec<[f64; 2]>> {
    let path = stage.path.clone().expect("a June day");
    let engine = ExactEngine::new(stage.tracer(), &[path]);
    let surface = |index: usize| {
        let (triangle, weights) = points[index];
        SurfacePoint::of_triangle(&stage.scene, &stage.geometry, triangle, weights)
    };
    let solved = solve_visibility(&engine, points.len(), surface, |_| true).expect("nothing stops it");
    solved.tables.iter().flat_map(IntervalTable::iter).map(|lit| lit.as_slice().to_vec()).collect()
}

struct Errors {
    leak_percent: f64,
    shade_percent: f64,
    worst: f32,
    seconds: f64,
}

impl Errors {
    fn of(stage: &Stage, points: &[(usize, [f64; 2])], truth: &[Vec<[f64; 2]>]) -> Self {
        let path = stage.path.as_ref().expect("a June day");
        let page = |page| Page::new(page, stage.bits, path.angular_radius_rad);
        let pages: Vec<Page> = stage.pages.iter().map(page).collect();
        let times: Vec<f64> = (0..TIMES).map(|k| (k as f64 + 0.5) / TIMES as f64).collect();
        let moments: Vec<_> = times.iter().map(|&t| stage.moment(t)).collect();
        let (mut leak, mut shade, mut worst, mut seconds) = (0.0, 0.0, 0.0f32, 0.0);
        for ((triangle, [u, v]), lit) in points.iter().zip(truth) {
            let [a, b, c] = stage.corners(*triangle).page_uv;
            let page_uv = a * (1.0 - u - v) as f32 + b * *u as f32 + c * *v as f32;
            let chart = stage.chart(stage.geometry.instance[*triangle] as usize).expect("it has texels");
            let normal = stage.geometry.normal(*triangle).as_vec3();
            let started = Instant::now();
            let shown: Vec<f32> = moments
                .iter()
                .map(|m| pages[chart.page as usize].sun_visibility(page_uv, normal, Filter::Bilinear, m))
                .collect();
            seconds += started.elapsed().as_secs_f64();
            for (&shown, t) in shown.iter().zip(&times) {
                match lit.iter().any(|[start, end]| (start..=end).contains(&t)) {
                    true => shade += f64::from(1.0 - shown),
                    false => leak += f64::from(shown),
                }
                worst = if lit.is_empty() { worst.max(shown) } else { worst };
            }
        }
        let percent = 100.0 / (points.len() * TIMES) as f64;
        Self { leak_percent: leak * percent, shade_percent: shade * percent, worst, seconds }
    }
}
