//! What it takes to end light on smooth surfaces where shading normals say: `cargo bench -p sunbake-runtime --bench
//! smooth_terminator`.
//!
//! Each scene is baked with and without, and each set's pictures are drawn by every technique. All numbers but counts
//! are ratios: with, of without. *Bake* is the time of finding when texels see the sun, the least of several; pictures
//! are visibility at 256 by 256 pixels, the least of several frames; *upload* is the time that shadow maps take to be
//! ready, in which they find how far facets may rise.
//!
//! Options after `--`: `edge=512 times=5 scene=NAME`.

#[path = "../../bake/benches/common/mod.rs"]
#[expect(dead_code, reason = "scenes are named here")]
mod common;

use std::path::Path;
use std::time::Instant;
use sunbake::progress::Silent;
use sunbake::scene::{LoadLimits, Scene, load};
use sunbake::settings::{BakeSettings, SunRequest};
use sunbake::sun::DayRequest;
use sunbake_runtime::camera::{Camera, View};
use sunbake_runtime::gpu::{Gpu, VolumeSettings};
use sunbake_runtime::shadow_maps::{MapSettings, Variant};
use sunbake_runtime::technique::{BakedGpu, ShadowMaps, Technique, Truth, Volumes};
use sunbake_runtime::{Filter, Shot, Stage};

const SCENES: [&str; 5] = [
    "tests/cases/05_terminator/scene.glb",
    "assets/gas_station.glb",
    "../shared/scenes/littlest_tokyo/littlest_tokyo.glb",
    "../shared/scenes/truck_town/truck_town.glb",
    "../shared/scenes/pc_house/house.glb",
];

fn main() {
    let given = common::given();
    let number = |key: &str, otherwise: usize| given.get(key).and_then(|v| v.parse().ok()).unwrap_or(otherwise);
    let gpu = Gpu::open().expect("an adapter");
    println!("| scene | smooth triangles | bake | truth | baked | map:pcf16 | upload | volumes |");
    println!("|---|---|---|---|---|---|---|---|");
    for name in SCENES {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(name);
        if path.exists() && given.get("scene").is_none_or(|wanted| name.contains(wanted)) {
            measure(&gpu, &path, number("edge", 512) as u32, number("times", 5));
        }
    }
}

fn measure<'g>(gpu: &'g Gpu, path: &Path, edge: u32, times: usize) {
    let scene = load(path, &LoadLimits::default()).expect("it loads");
    let mut bake_s = [f64::INFINITY; 2];
    let mut stages = Vec::new();
    for _ in 0..times.clamp(1, 3) {
        stages.clear();
        for (smooth, least) in [false, true].into_iter().zip(&mut bake_s) {
            let (stage, seconds) = baked(&scene, edge, smooth);
            *least = least.min(seconds);
            stages.push(stage);
        }
    }
    let pictures = |make: &dyn Fn(&Stage) -> Box<dyn Technique + 'g>| {
        let mut least = [[f64::INFINITY; 2]; 2];
        for (stage, least) in stages.iter().zip(&mut least) {
            stage.tracer();
            let started = Instant::now();
            let mut technique = make(stage);
            least[0] = started.elapsed().as_secs_f64();
            let shot = Shot::new(stage, View::new(&Camera::default_of(stage, 1.0), [256; 2], &stage.scene));
            for frame in 0..=times {
                let started = Instant::now();
                technique.visibility(&shot, &stage.moment(0.3 + 0.01 * frame as f64)).expect("a picture");
                // The first frame builds pipelines, and finds what rays hit.
                least[1] = if frame > 0 { least[1].min(started.elapsed().as_secs_f64()) } else { least[1] };
            }
        }
        [0, 1].map(|k| least[1][k] / least[0][k])
    };
    let truth = pictures(&|_| Box::new(Truth::Hard));
    let played = pictures(&|stage| Box::new(BakedGpu::new(gpu, stage, Filter::Bilinear).expect("a renderer")));
    let map = MapSettings::new(Variant::Pcf16);
    let mapped = pictures(&|stage| Box::new(ShadowMaps::new(gpu, stage, map).expect("a renderer")));
    let settings = VolumeSettings::default();
    let volumes = pictures(&|stage| Box::new(Volumes::new(gpu, stage, settings).expect("a renderer")));
    println!(
        "| {} | {} of {} | {:.2} | {:.2} | {:.2} | {:.2} | {:.2} | {:.2} |",
        path.file_name().map(|name| name.to_string_lossy()).unwrap_or_default(),
        stages[1].geometry.smooth_count(),
        stages[1].geometry.triangles.len(),
        bake_s[1] / bake_s[0],
        truth[1],
        played[1],
        mapped[1],
        mapped[0],
        volumes[1],
    );
}

/// A stage of a bake, and the seconds that it took to find times.
fn baked(scene: &Scene, edge: u32, smooth_terminator: bool) -> (Stage, f64) {
    let day = DayRequest::new(Some([40.0, 0.0]), "2026-06-21".parse().ok()).expect("a day");
    let settings = BakeSettings {
        page_size_texels: edge,
        smooth_terminator,
        ambient: None,
        ..BakeSettings::standard(SunRequest::Day(day))
    };
    let bake = sunbake::bake_scene(scene, &settings, &Silent).expect("it bakes");
    let seconds = bake.manifest.stats.seconds.visibility;
    (Stage::of_bake(bake).expect("a stage"), seconds)
}
