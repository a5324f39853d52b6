//! What shadow tracks cost and give on whole scenes: the bake's seconds with and without them, their bytes beside those
//! of plain intervals, and the errors of the filters at points spread evenly over all surfaces:
//!
//! ```text
//! cargo run --release --example track_scene -- [PAGE_SIZE_TEXELS] [SCENE ...]
//! ```

use glam::DVec2;
use std::error::Error;
use std::path::{Path, PathBuf};
use sunbake::atlas::{Atlas, Footprint, SurfacePoint};
use sunbake::maps::{edge_sample, sharpened, soft_visibility};
use sunbake::progress::Silent;
use sunbake::scene::{Geometry, LoadLimits, Scene, load};
use sunbake::settings::{BakeSettings, SunRequest, TrackChoice};
use sunbake::sun::DayRequest;
use sunbake::trace::Tracer;
use sunbake::tracks::tracked_visibility;
use sunbake::visibility::{ExactEngine, Intervals, lit_at};
use sunbake::{Bake, bake_scene};

const POINTS: usize = 20_000;
const TIMES: usize = 5;

#[derive(Default)]
struct Errors {
    sum: f64,
    squares: f64,
    count: f64,
}

impl Errors {
    fn add(&mut self, seen: f32, truth: f64) {
        let error = f64::from(seen) - truth;
        self.sum += error.abs();
        self.squares += error * error;
        self.count += 1.0;
    }

    fn percent(&self) -> [f64; 2] {
        [self.sum / self.count, (self.squares / self.count).sqrt()].map(|error| 100.0 * error)
    }
}

/// The share of a window that lies in intervals.
fn soft(lit: &Intervals, t: f64, width_t: f64) -> f64 {
    let window = Intervals::from_unsorted(vec![[t - 0.5 * width_t, t + 0.5 * width_t]]);
    lit.intersection(&window).lit_length() / width_t
}

/// Points at equal distances along the area of all triangles: each with the weights of its second and third corner.
fn spread(geometry: &Geometry) -> Vec<(usize, [f64; 2])> {
    let area = |corners: &[glam::Vec3; 3]| {
        let [a, b, c] = corners.map(|corner| corner.as_dvec3());
        (b - a).cross(c - a).length() * 0.5
    };
    let areas: Vec<f64> = geometry.triangles.iter().map(area).collect();
    let step = areas.iter().sum::<f64>() / POINTS as f64;
    let mut points = Vec::with_capacity(POINTS);
    let (mut sum, mut next) = (0.0, 0.5 * step);
    for (triangle, area) in areas.iter().enumerate() {
        sum += area;
        while next < sum {
            let share = |base: f64| (points.len() as f64 * base).fract();
            let [v, w] = [share(0.754_877_666_2), share(0.569_840_290_9)];
            points.push((triangle, if v + w > 1.0 { [1.0 - v, 1.0 - w] } else { [v, w] }));
            next += step;
        }
    }
    points
}

/// Where a point lies on its page, in texels from the middle of the first; none where it has no texels.
fn place(
    scene: &Scene,
    geometry: &Geometry,
    atlas: &Atlas,
    triangle: usize,
    weights: [f64; 2],
) -> Option<(usize, DVec2)> {
    let instance = geometry.instance[triangle] as usize;
    let placement = &atlas.placements[instance];
    if placement.is_empty() {
        return None;
    }
    let page = placement.page as usize;
    let layout = &atlas.layouts[scene.instances[instance].mesh];
    let own = triangle - geometry.first_triangle[instance] as usize;
    let corner = |k: usize| atlas.texel(instance, layout.uvs[layout.indices[3 * own + k] as usize], atlas.pages[page]);
    let [v, w] = weights;
    Some((page, corner(0) * (1.0 - v - w) + corner(1) * v + corner(2) * w - 0.5))
}

fn measure(file: &Path, page_size_texels: u32) -> Result<(), Box<dyn Error>> {
    let scene = load(file, &LoadLimits::default())?;
    let day = DayRequest::new(Some([35.0, -116.0]), Some("2026-06-21".parse()?))?;
    let settings = BakeSettings { page_size_texels, ambient: None, ..BakeSettings::standard(SunRequest::Day(day)) };
    let plain = bake_scene(&scene, &settings, &Silent)?;
    let Bake { manifest, pages, path, bits, scene_glb, .. } =
        bake_scene(&scene, &BakeSettings { tracks: TrackChoice::Auto, ..settings }, &Silent)?;
    let path = path.ok_or("the sun does not rise")?;
    let scene = sunbake::scene::parse(file, &scene_glb, &LoadLimits::default())?;
    let (atlas, geometry) = (manifest.atlas(&scene), manifest.geometry(&scene));
    let tracer = Tracer::new(&scene, &geometry);
    let engine = ExactEngine::new(&tracer, std::slice::from_ref(&path));
    let mut errors: [Errors; 3] = Default::default();
    for (triangle, weights) in spread(&geometry) {
        let Some((page, at)) = place(&scene, &geometry, &atlas, triangle, weights) else { continue };
        let maps = &pages[page].maps;
        let (Some(tracks), Some(lane)) = (&maps.tracks, maps.lanes.first()) else { continue };
        let point = SurfacePoint::of_triangle(&scene, &geometry, triangle, weights);
        let lit = &lit_at(&engine, &point)[0];
        let footprint = Footprint::new(at, atlas.pages[page]);
        let footprint = match &maps.walls {
            Some(walls) => footprint.beside_walls(walls),
            None => footprint,
        };
        for t in (0..TIMES).map(|i| (i as f64 + 0.5) / TIMES as f64) {
            let width_t = path.width_t(t);
            let truth = soft(lit, t, width_t);
            let (t, width_t) = (t as f32, width_t as f32);
            let blurred = footprint.blend(|texel| soft_visibility(&lane.layers, texel, bits.times, t, width_t));
            let sharp = footprint.blend(|texel| edge_sample(&lane.layers, texel, bits.times, t, width_t));
            let tracked = tracked_visibility(tracks, &footprint, t, width_t);
            errors.iter_mut().zip([blurred, sharpened(sharp), tracked]).for_each(|(e, seen)| e.add(seen, truth));
        }
    }
    let mib = |bytes: u64| bytes as f64 / f64::from(1 << 20);
    let of_layers: u64 = pages.iter().map(|page| page.maps.gpu_bytes(bits.times)).sum();
    let found = manifest.stats.tracks.unwrap_or_default();
    let texels = manifest.stats.texels;
    let seconds = |stats: &sunbake::disk::manifest::Stats| stats.seconds.visibility;
    let [blurred, sharp, tracks_error] = errors.map(|errors| errors.percent());
    println!(
        "{:<24} {page_size_texels:>5}  {:5.2} ({:4.1})  {:5.2} ({:4.1})  {:5.2} ({:4.1})   {:3.0} % {:4.1} %  {:5.2}   \
         {:6.1} {:6.1}   {:6.1} {:6.1}",
        file.file_stem().unwrap_or_default().to_string_lossy(),
        blurred[0],
        blurred[1],
        sharp[0],
        sharp[1],
        tracks_error[0],
        tracks_error[1],
        100.0 * found.texels as f64 / texels as f64,
        100.0 * found.crowded_texels as f64 / texels as f64,
        found.spans as f64 / texels as f64,
        mib(of_layers),
        mib(found.gpu_bytes),
        seconds(&plain.manifest.stats),
        seconds(&manifest.stats),
    );
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let size = arguments.next().map_or(Ok(1024), |size| size.parse())?;
    let files: Vec<PathBuf> = arguments.map(PathBuf::from).collect();
    let station = Path::new(env!("CARGO_MANIFEST_DIR")).join("../assets/gas_station.glb");
    let files = if files.is_empty() { vec![station] } else { files };
    println!(
        "scene, page: bilinear, sharp, tracks: mean (rms) in percent; texels with tracks, crowded; spans a texel; MiB \
         of maps, of tracks; seconds of times, with tracks"
    );
    files.iter().try_for_each(|file| measure(file, size))
}
