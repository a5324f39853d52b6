//! Shadow volumes: the cost of each way of drawing them, and the gain of each saving: `cargo bench -p sunbake-runtime`.
//!
//! Our own scene and shared ones, where they are on this machine (`SUNBAKE_SHARED`, or `shared` beside the repository),
//! at times of day and through cameras spread around, one of them in shadow. Alpha masks are left out, as volumes
//! ignore them, so that errors are those of the technique. The ways take turns, so that other load of the machine falls
//! on all alike.
//!
//! Passes are timed by the adapter's own clock; on a software GPU that is the CPU's time. A *still* frame reuses the
//! volumes of the last one; a *moving* frame computes its own. Wrong pixels are those that differ from hard truth,
//! including those at edges.
//!
//! Options after `--`: `size=256 times=3 rounds=3 scene=NAME only=ways|savings|suns`.

#[path = "../../bake/benches/common/mod.rs"]
mod common;

use std::path::Path;
use sunbake::scene::{LoadLimits, load};
use sunbake_runtime::compare::{mean, visibility_difference};
use sunbake_runtime::gpu::{Gpu, VolumeSettings};
use sunbake_runtime::technique::{LightKind, Technique, Truth, Volumes};
use sunbake_runtime::testing::masks::{camera_in_shadow, cameras_around, mask, with_solid_leaves};
use sunbake_runtime::volumes::{Mode, VolumeOptimizations};
use sunbake_runtime::{Moment, Raster, Shot, Stage, View};

const SHARED: [&str; 4] = [
    "osrf_city/osrf_city.glb",
    "gazebo_thin/tower_crane.glb",
    "gazebo_thin/ladder_60deg_2rails.glb",
    "two_cylinder_engine/2CylinderEngine.glb",
];

/// Rays of the soft truth that soft edges are compared with.
const SOFT_RAYS: u32 = 256;

fn main() {
    let given = common::given();
    let number = |key: &str, otherwise: usize| given.get(key).and_then(|v| v.parse().ok()).unwrap_or(otherwise);
    let wants = |part: &str| given.get("only").is_none_or(|only| only == part);
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
        let frames = Frames::new(&stage, number("size", 256) as u32, number("times", 3));
        if wants("ways") {
            ways(&gpu, &name, &frames, number("rounds", 3));
        }
        if wants("savings") {
            optimizations(&gpu, &name, &frames, number("rounds", 3));
        }
        if wants("suns") {
            suns(&gpu, &name, &frames);
        }
    }
}

fn stage(file: &Path) -> Result<Stage, String> {
    let scene = load(file, &LoadLimits::default()).map_err(|e| e.to_string())?;
    Ok(Stage::plain(with_solid_leaves(scene), Some(common::summer_path()?)))
}

/// A shot, and truth.
type Seen<'a> = (Shot<'a>, Raster<f32>);

/// What is drawn: moments, each through several cameras, with truth.
struct Frames<'a> {
    stage: &'a Stage,
    all: Vec<(Moment, Vec<Seen<'a>>)>,
}

impl<'a> Frames<'a> {
    fn new(stage: &'a Stage, edge_px: u32, times: usize) -> Self {
        let moment = |i: usize| Moment::new(stage.path.as_ref(), (i as f64 + 0.5) / times as f64);
        let shots = |moment: Moment| {
            let [front, _, back, _] = cameras_around(stage);
            let in_shadow = camera_in_shadow(stage, moment.sun_direction.as_dvec3(), 1);
            let cameras = [Some(front), Some(back), in_shadow].into_iter().flatten();
            let shots = cameras.map(|camera| {
                let shot = Shot::new(stage, View::new(&camera, [edge_px; 2], &stage.scene));
                let truth = mask(&mut Truth::Hard, &shot, &moment, LightKind::Sun);
                (shot, truth)
            });
            (moment, shots.collect())
        };
        Self { stage, all: (0..times).map(moment).map(shots).collect() }
    }

    fn count(&self) -> usize {
        self.all.iter().map(|(_, shots)| shots.len()).sum()
    }
}

/// Means over frames: seconds, triangles, filled pixels and shares of wrong ones.
#[derive(Debug, Clone, Default)]
struct Cost {
    find: f64,
    overlap: f64,
    plan: f64,
    volumes: f64,
    rest: f64,
    triangles: f64,
    filled: f64,
    wrong: f64,
    bytes: u64,
}

impl Cost {
    fn still(&self) -> f64 {
        self.plan + self.volumes + self.rest
    }

    fn moving(&self) -> f64 {
        self.find + self.still()
    }
}

/// Draws every frame `rounds` times, the rivals in turn; the least of each frame's times counts.
fn measure(gpu: &Gpu, frames: &Frames, rivals: &[VolumeSettings], rounds: usize) -> Vec<Cost> {
    let open = |settings: &VolumeSettings| {
        let settings = VolumeSettings { is_timed: true, ..*settings };
        Volumes::new(gpu, frames.stage, settings).unwrap_or_else(|error| panic!("{error}"))
    };
    let mut open: Vec<Volumes> = rivals.iter().map(open).collect();
    let mut costs = vec![Cost::default(); rivals.len()];
    let share = 1.0 / frames.count() as f64;
    for (moment, shots) in &frames.all {
        // What a light makes of the casters is found once for all cameras, unless nothing is kept.
        for (volumes, cost) in open.iter_mut().zip(&mut costs) {
            let mut least = [f64::INFINITY; 2];
            for _ in 0..rounds {
                volumes.renderer().forget();
                mask(volumes, &shots[0].0, moment, LightKind::Sun);
                if let Some(light) = volumes.report().lights.first() {
                    least = [least[0].min(light.find_seconds), least[1].min(light.overlap_seconds)];
                }
            }
            cost.find += least[0] * share * shots.len() as f64;
            cost.overlap += least[1] * share * shots.len() as f64;
        }
        for (shot, truth) in shots {
            let mut least = vec![[f64::INFINITY; 3]; rivals.len()];
            for _ in 0..rounds {
                for (volumes, least) in open.iter_mut().zip(&mut least) {
                    mask(volumes, shot, moment, LightKind::Sun);
                    let report = volumes.report();
                    let times = report.times.unwrap_or_default();
                    let plan = report.lights.first().map_or(0.0, |light| light.plan_seconds);
                    let now = [plan, times.volumes, times.depth + times.light];
                    *least = std::array::from_fn(|k| least[k].min(now[k]));
                }
            }
            for ((volumes, cost), least) in open.iter_mut().zip(&mut costs).zip(least) {
                let seen = mask(volumes, shot, moment, LightKind::Sun);
                let wrong = seen.pixels.iter().zip(&truth.pixels).filter(|(a, b)| a != b).count();
                let triangles = volumes.report().lights.first().map_or(0, |light| light.triangles);
                let fill = volumes.renderer().fill(&shot.view, moment, false).unwrap_or_default();
                cost.plan += least[0] * share;
                cost.volumes += least[1] * share;
                cost.rest += least[2] * share;
                cost.triangles += triangles as f64 * share;
                cost.filled += fill.iter().map(|&n| f64::from(n)).sum::<f64>() * share;
                cost.wrong += wrong as f64 / seen.pixels.len() as f64 * share;
                cost.bytes = volumes.bytes();
            }
        }
    }
    costs
}

fn ways(gpu: &Gpu, name: &str, frames: &Frames, rounds: usize) {
    let rivals = Mode::ALL.map(|mode| VolumeSettings { mode, ..VolumeSettings::default() });
    let costs = measure(gpu, frames, &rivals, rounds);
    let mut volumes = Volumes::new(gpu, frames.stage, rivals[0]).unwrap_or_else(|error| panic!("{error}"));
    let welded = volumes.renderer().prepare_seconds();
    println!(
        "\n{name}: {} triangles cast, {} frames; welded in {:.0} ms, once",
        volumes.caster_counts().triangles,
        frames.count(),
        welded * 1e3
    );
    println!(
        "| way | silhouettes (of which counting overlaps) | plan | volumes | depth and light | still frame \
         | moving frame | triangles | filled Mpx | wrong | MiB |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|");
    let best = |of: fn(&Cost) -> f64| costs.iter().map(of).fold(f64::INFINITY, f64::min);
    let (best_still, best_moving) = (best(Cost::still), best(Cost::moving));
    for (rival, cost) in rivals.iter().zip(&costs) {
        let ms = |seconds: f64| format!("{:.1} ms", seconds * 1e3);
        let marked =
            |seconds: f64, best: f64| if seconds == best { format!("**{}**", ms(seconds)) } else { ms(seconds) };
        println!(
            "| {} | {} ({}) | {} | {} | {} | {} | {} | {:.0} | {:.1} | {:.3} % | {:.1} |",
            if rival.mode == Mode::Planned { "volumes (planned)".into() } else { rival.mode.to_string() },
            ms(cost.find),
            ms(cost.overlap),
            ms(cost.plan),
            ms(cost.volumes),
            ms(cost.rest),
            marked(cost.still(), best_still),
            marked(cost.moving(), best_moving),
            cost.triangles,
            cost.filled * 1e-6,
            cost.wrong * 100.0,
            cost.bytes as f64 / f64::from(1 << 20),
        );
    }
}

/// An optimization that is turned off, by name.
type Lacking = (&'static str, fn(&mut VolumeOptimizations));

fn optimizations(gpu: &Gpu, name: &str, frames: &Frames, rounds: usize) {
    let lacking: [Lacking; 6] = [
        ("leaving out what misses the view", |s| s.view_culling = false),
        ("leaving out what shades nothing in view", |s| s.receiver_culling = false),
        ("z-pass where it is right", |s| s.z_pass = false),
        ("leaving out caps", |s| s.cap_culling = false),
        ("scissor", |s| s.scissor = false),
        ("solids' front faces alone", |s| s.solids = false),
    ];
    let without = |edit: fn(&mut VolumeOptimizations)| {
        let mut optimizations = VolumeOptimizations::default();
        edit(&mut optimizations);
        VolumeSettings { optimizations, ..VolumeSettings::default() }
    };
    let mut rivals = vec![
        VolumeSettings::default(),
        VolumeSettings { optimizations: VolumeOptimizations::NONE, ..VolumeSettings::default() },
    ];
    rivals.push(VolumeSettings {
        mode: Mode::Triangles,
        optimizations: VolumeOptimizations::NONE,
        ..VolumeSettings::default()
    });
    rivals.extend(lacking.iter().map(|(_, edit)| without(*edit)));
    let costs = measure(gpu, frames, &rivals, rounds);
    println!("\n{name}: optimizations, each as what its absence costs");
    println!("| without | volumes | against all | triangles | filled Mpx | frame against all |");
    println!("|---|---|---|---|---|---|");
    let names =
        ["nothing", "any of them", "any, a volume a triangle"].into_iter().chain(lacking.iter().map(|(what, _)| *what));
    // Where nothing is kept, a still frame finds its volumes again.
    let frame =
        |rival: &VolumeSettings, cost: &Cost| if rival.optimizations.cache { cost.still() } else { cost.moving() };
    for (what, (rival, cost)) in names.zip(rivals.iter().zip(&costs)) {
        println!(
            "| {what} | {:.1} ms | {:.2} | {:.0} | {:.1} | {:.2} |",
            cost.volumes * 1e3,
            cost.volumes / costs[0].volumes,
            cost.triangles,
            cost.filled * 1e-6,
            frame(rival, cost) / frame(&rivals[0], &costs[0]),
        );
    }
}

/// Soft edges from many hard suns: what they take, and how far they are from truth.
fn suns(gpu: &Gpu, name: &str, frames: &Frames) {
    println!("\n{name}: the sun's disc as N suns, against truth:soft:{SOFT_RAYS}");
    println!("| suns | frame | of it silhouettes | mean error | pixels off by more than 1/16 |");
    println!("|---|---|---|---|---|");
    let truth = |(moment, shots): &(Moment, Vec<Seen>)| -> Vec<Raster<f32>> {
        shots.iter().map(|(shot, _)| mask(&mut Truth::Soft { rays: SOFT_RAYS }, shot, moment, LightKind::Sun)).collect()
    };
    let truths: Vec<Vec<Raster<f32>>> = frames.all.iter().map(truth).collect();
    for count in [1, 4, 16, 64] {
        let settings = VolumeSettings { sun_samples: count, is_timed: true, ..VolumeSettings::default() };
        let mut volumes = Volumes::new(gpu, frames.stage, settings).unwrap_or_else(|error| panic!("{error}"));
        let (mut seconds, mut find, mut error, mut off) = (0.0, 0.0, 0.0, 0.0);
        let share = 1.0 / frames.count() as f64;
        for ((moment, shots), truths) in frames.all.iter().zip(&truths) {
            for ((shot, _), truth) in shots.iter().zip(truths) {
                volumes.renderer().forget();
                let seen = mask(&mut volumes, shot, moment, LightKind::Sun);
                let report = volumes.report();
                let times = report.times.unwrap_or_default();
                let found: f64 = report.lights.iter().map(|light| light.find_seconds).sum();
                let planned: f64 = report.lights.iter().map(|light| light.plan_seconds).sum();
                seconds += (times.depth + times.volumes + times.light + found + planned) * share;
                find += found * share;
                let difference = visibility_difference(&seen, truth);
                error += mean(&difference) * share;
                let is_off = |d: &&f32| **d > 1.0 / 16.0;
                off += difference.pixels.iter().filter(is_off).count() as f64 / difference.pixels.len() as f64 * share;
            }
        }
        println!("| {count} | {:.0} ms | {:.0} ms | {error:.5} | {:.2} % |", seconds * 1e3, find * 1e3, off * 100.0);
    }
}
