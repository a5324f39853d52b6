//! Shadow maps: cost and error of each variant and size: `cargo bench -p sunbake-runtime --bench
//! shadow_maps`.
//!
//! Our own scene and shared ones, where they are on this machine (`SUNBAKE_SHARED`, or `shared` beside the repository),
//! at times of day and through six cameras, two of them in shadow. Hard variants are compared with truth of the sun's
//! centre, soft ones with truth of its disc.
//!
//! Passes are timed by the adapter's own clock; on a software GPU that is the CPU's time. Under a moving sun every
//! frame draws its maps; under a still one, maps that do not follow the view are kept. Sampling is the time of the
//! lighting pass beyond that of the same pass without comparisons.
//!
//! Options after `--`: `size=128 times=12` (pictures compared), `px=512 rounds=3` (pictures timed, at three times
//! through three cameras), `maps=512,1024,2048,4096 scene=NAME variant=NAME only=errors|times|bias map=2048 where=1`.

#[path = "../../bake/benches/common/mod.rs"]
mod common;

use std::path::Path;
use sunbake::scene::{LoadLimits, load};
use sunbake_runtime::compare::Defects;
use sunbake_runtime::gpu::Gpu;
use sunbake_runtime::shadow_maps::{Bias, MapOptimizations, MapSettings, Variant};
use sunbake_runtime::technique::{LightKind, ShadowMaps, Technique};
use sunbake_runtime::testing::maps::{ReferenceDay, defects_of};
use sunbake_runtime::testing::masks::{camera_in_shadow, cameras_around, mask};
use sunbake_runtime::{Moment, Shot, Stage, View};

const SHARED: [&str; 5] = [
    "osrf_city/osrf_city.glb",
    "gazebo_thin/tower_crane.glb",
    "gazebo_thin/ladder_60deg_2rails.glb",
    "gazebo_thin/truss_bridge.glb",
    "two_cylinder_engine/2CylinderEngine.glb",
];

fn main() {
    let given = common::given();
    let number = |key: &str, otherwise: usize| given.get(key).and_then(|v| v.parse().ok()).unwrap_or(otherwise);
    let wants = |part: &str| given.get("only").is_none_or(|only| only == part);
    let sizes: Vec<u32> = given
        .get("maps")
        .map_or_else(|| vec![512, 1024, 2048, 4096], |list| list.split(',').filter_map(|n| n.parse().ok()).collect());
    let named =
        |variant: &Variant| given.get("variant").is_none_or(|name| variant.to_string() == format!("map:{name}"));
    let variants: Vec<Variant> = Variant::ALL.into_iter().filter(named).collect();
    let gpu = match Gpu::open() {
        Ok(gpu) => gpu,
        Err(error) => return println!("{error}"),
    };
    let clock = if gpu.is_software { "a software GPU: its times are the CPU's" } else { "a GPU" };
    println!("{}, {clock}", gpu.name);
    for file in common::scenes(&SHARED) {
        let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        if given.get("scene").is_some_and(|wanted| *wanted != name) {
            continue;
        }
        let stage = match stage(&file) {
            Ok(stage) => stage,
            Err(error) => {
                println!("{name}: {error}");
                continue;
            }
        };
        let at = |count: usize| (0..count).map(move |i| (i as f64 + 0.5) / count as f64);
        let errors = (wants("errors") || wants("bias"))
            .then(|| ReferenceDay::new(&stage, number("size", 128) as u32, at(number("times", 12))));
        let frames = wants("times").then(|| Frames::new(&stage, number("px", 512) as u32, at(3), number("rounds", 3)));
        if wants("errors") || wants("times") {
            println!("\n{name}: {} triangles", stage.geometry.triangles.len());
            table(&gpu, errors.as_ref(), frames.as_ref(), &variants, &sizes, given.contains_key("where"));
        }
        if let Some(day) = errors.filter(|_| wants("bias")) {
            biases(&gpu, &name, &day, number("map", 2048) as u32);
        }
    }
}

fn stage(file: &Path) -> Result<Stage, String> {
    let scene = load(file, &LoadLimits::default()).map_err(|e| e.to_string())?;
    Ok(Stage::plain(scene, Some(common::summer_path()?)))
}

/// Means over frames, in seconds.
#[derive(Debug, Clone, Copy, Default)]
struct Times {
    fit: f64,
    maps: f64,
    light: f64,
    sampling: f64,
    bytes: u64,
}

/// The shots that are timed.
struct Frames<'a> {
    stage: &'a Stage,
    all: Vec<(Moment, Vec<Shot<'a>>)>,
    rounds: usize,
}

impl<'a> Frames<'a> {
    fn new(stage: &'a Stage, edge_px: u32, times: impl Iterator<Item = f64>, rounds: usize) -> Self {
        let shots = |t: f64| {
            let moment = Moment::new(stage.path.as_ref(), t);
            let [front, _, back, _] = cameras_around(stage);
            let in_shadow = camera_in_shadow(stage, moment.sun_direction.as_dvec3(), 1);
            let cameras = [Some(front), Some(back), in_shadow].into_iter().flatten();
            let shot = |camera| Shot::new(stage, View::new(&camera, [edge_px; 2], &stage.scene));
            (moment, cameras.map(shot).collect())
        };
        Self { stage, all: times.map(shots).collect(), rounds }
    }

    /// Draws every frame several times, maps again each time, with and without comparisons in turn; the least of each
    /// frame's times counts.
    fn times(&self, gpu: &Gpu, settings: MapSettings) -> Times {
        let optimizations = |sampling| MapOptimizations { cache: false, sampling, ..MapOptimizations::default() };
        let open = |sampling| {
            let settings = MapSettings { is_timed: true, optimizations: optimizations(sampling), ..settings };
            ShadowMaps::new(gpu, self.stage, settings).unwrap_or_else(|error| panic!("{error}"))
        };
        let mut rivals = [open(true), open(false)];
        let mut found = Times::default();
        let share = 1.0 / self.all.iter().map(|(_, shots)| shots.len()).sum::<usize>() as f64;
        for (moment, shot) in self.all.iter().flat_map(|(moment, shots)| shots.iter().map(move |shot| (moment, shot))) {
            let mut least = [[f64::INFINITY; 3]; 2];
            for _ in 0..self.rounds {
                for (rival, least) in rivals.iter_mut().zip(&mut least) {
                    mask(rival, shot, moment, LightKind::Sun);
                    let times = rival.report().times.unwrap_or_default();
                    let now = [rival.report().fit_seconds, times.maps, times.light];
                    *least = std::array::from_fn(|k| least[k].min(now[k]));
                }
            }
            let [[fit, maps, light], [_, _, without]] = least;
            found.fit += fit * share;
            found.maps += maps * share;
            found.light += light * share;
            found.sampling += (light - without) * share;
        }
        Times { bytes: rivals[0].bytes(), ..found }
    }
}

fn table(
    gpu: &Gpu,
    day: Option<&ReferenceDay>,
    frames: Option<&Frames>,
    variants: &[Variant],
    sizes: &[u32],
    says_where: bool,
) {
    println!(
        "| variant | map | wrong | mean error | acne | leaks | fit | map pass | light pass | of it sampling | MiB |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|");
    for &variant in variants {
        // What has no map has no size.
        let sizes = if variant == Variant::Planar { &sizes[..1] } else { sizes };
        for &size_texels in sizes {
            let settings = MapSettings { size_texels, ..MapSettings::new(variant) };
            let size = if variant == Variant::Planar { "-".to_owned() } else { size_texels.to_string() };
            let errors = day.map_or_else(
                || "- | - | - | -".to_owned(),
                |day| {
                    let found = defects_of(gpu, day, settings, says_where).unwrap_or_else(|error| panic!("{error}"));
                    errors_of(&found)
                },
            );
            let costs = frames.map_or_else(
                || "- | - | - | - | -".to_owned(),
                |frames| {
                    let times = frames.times(gpu, settings);
                    let ms = |seconds: f64| format!("{:.3} ms", seconds * 1e3);
                    let [fit, maps, light, sampling] = [times.fit, times.maps, times.light, times.sampling].map(ms);
                    let mebibytes = times.bytes as f64 / f64::from(1 << 20);
                    format!("{fit} | {maps} | {light} | {sampling} | {mebibytes:.1}")
                },
            );
            println!("| {variant} | {size} | {errors} | {costs} |");
        }
    }
}

fn errors_of(found: &Defects) -> String {
    format!(
        "{:.3} % | {:.5} | {} | {}",
        found.share_wrong() * 100.0,
        found.mean_error(),
        found.acne.len(),
        found.leaks.len()
    )
}

/// What each part of the bias is for.
fn biases(gpu: &Gpu, name: &str, day: &ReferenceDay, size_texels: u32) {
    println!("\n{name}: biases, maps of {size_texels}");
    println!("| variant | bias | wrong | mean error | acne | leaks |");
    println!("|---|---|---|---|---|---|");
    let parts = [
        "none",
        "texels:0.5",
        "texels:2",
        "texels:8",
        "slope",
        "normal",
        "plane",
        "normal,plane",
        "texels:0.5,normal,plane",
        "texels:0.5,slope,plane",
        "texels:1,normal",
        "texels:1,normal,plane",
    ];
    for variant in [Variant::Compare, Variant::Pcf16, Variant::Cascades] {
        for part in parts {
            let bias: Bias = part.parse().unwrap_or_else(|error| panic!("{error}"));
            let settings = MapSettings { size_texels, bias, ..MapSettings::new(variant) };
            let found = defects_of(gpu, day, settings, false).unwrap_or_else(|error| panic!("{error}"));
            println!("| {variant} | {part} | {} |", errors_of(&found));
        }
    }
}
