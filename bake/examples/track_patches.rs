//! What the filters of stored times err by, on patches of ground of our station under things with narrow shadows:
//!
//! ```text
//! cargo run --release --example track_patches --features testing -- [TEXELS_PER_METRE ...]
//! ```

use glam::{DVec2, DVec3, Vec3};
use std::error::Error;
use std::path::Path;
use std::time::Instant;
use sunbake::atlas::{Footprint, PageSize, SurfacePoint};
use sunbake::maps::{Bits, PageEncoder, edge_sample, sharpened, soft_visibility};
use sunbake::progress::Silent;
use sunbake::scene::{Components, Geometry, LoadLimits, Scene, load};
use sunbake::sun::{DayOutcome, DayRequest};
use sunbake::trace::{Direction, Tracer};
use sunbake::tracks::{Linked, PageTracks, SpanSearch, find_spans, number_tracks, tracked_visibility};
use sunbake::visibility::{ExactEngine, Intervals, OccluderFinder, lit_at};

const EDGE_M: f64 = 6.0;
const POINTS: usize = 4000;
const TIMES: usize = 6;
/// Objects, and where the middle of the patch lies from the middle of the object, metres along x and z.
const PATCHES: [(&str, &str, [f64; 2]); 6] = [
    ("picket fence", "fence west 1", [0.0, 0.0]),
    ("lattice mast", "wind pump tower", [0.0, 0.0]),
    ("pergola", "pergola", [0.0, 0.0]),
    ("tank", "water tank", [0.0, 0.0]),
    ("table", "table", [0.0, 0.0]),
    ("sign", "roadside sign", [0.0, 0.0]),
];

struct Station<'a> {
    scene: &'a Scene,
    geometry: &'a Geometry,
    tracer: &'a Tracer,
    ground: u32,
}

impl Station<'_> {
    fn point(&self, x: f64, z: f64) -> Option<SurfacePoint> {
        let from = DVec3::new(x, 100.0, z) - self.scene.centre_m;
        let is_ground = |triangle: u32| self.geometry.instance[triangle as usize] == self.ground;
        let hit = self.tracer.closest_hit_where(from, &Direction::new(-DVec3::Y), is_ground)?;
        let triangle = hit.triangle as usize;
        Some(SurfacePoint {
            position_m: self.geometry.point(triangle, hit.barycentric),
            normal: self.geometry.normal(triangle),
            is_double_sided: false,
            triangle: hit.triangle,
            smooth: self.geometry.smooth_point(triangle, hit.barycentric),
        })
    }
}

#[derive(Default)]
struct Errors {
    sum: f64,
    squares: f64,
    count: usize,
}

impl Errors {
    fn add(&mut self, seen: f32, truth: f64) {
        let error = f64::from(seen) - truth;
        self.sum += error.abs();
        self.squares += error * error;
        self.count += 1;
    }
}

impl std::fmt::Display for Errors {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let n = self.count.max(1) as f64;
        write!(f, "{:5.2} ({:4.1})", 100.0 * self.sum / n, 100.0 * (self.squares / n).sqrt())
    }
}

fn soft(lit: &Intervals, t: f64, width_t: f64) -> f64 {
    let window = Intervals::from_unsorted(vec![[t - 0.5 * width_t, t + 0.5 * width_t]]);
    lit.intersection(&window).lit_length() / width_t
}

fn main() -> Result<(), Box<dyn Error>> {
    let densities: Vec<f64> = std::env::args().skip(1).map(|a| a.parse()).collect::<Result<_, _>>()?;
    let densities = if densities.is_empty() { vec![10.0] } else { densities };
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../assets/gas_station.glb");
    let scene = load(&file, &LoadLimits::default())?;
    let geometry = Geometry::new(&scene);
    let tracer = Tracer::new(&scene, &geometry);
    let day = DayRequest::new(Some([35.0, -116.0]), Some("2026-06-21".parse()?))?;
    let DayOutcome::Path(path) = sunbake::sun::day(&day)? else { return Err("the sun does not rise".into()) };
    let engine = ExactEngine::new(&tracer, std::slice::from_ref(&path));
    let parts = Components::new(&scene, &geometry);
    let finder = OccluderFinder::new(&engine, &parts);
    println!("{} parts", parts.count);
    let named = |name: &str| scene.instances.iter().position(|i| scene.nodes[i.node].name.as_deref() == Some(name));
    let ground = named("ground").ok_or("there is no ground")? as u32;
    let station = Station { scene: &scene, geometry: &geometry, tracer: &tracer, ground };
    println!("patch, texels/m: bilinear, sharp, tracks: mean (rms) in percent; intervals and spans a texel; seconds");
    for (title, name, offset) in PATCHES {
        let Some(instance) = named(name) else { continue };
        let range = geometry.first_triangle[instance] as usize..geometry.first_triangle[instance + 1] as usize;
        let corners = || geometry.triangles[range.clone()].iter().flatten();
        let low = corners().fold(Vec3::INFINITY, |a, b| a.min(*b));
        let high = corners().fold(Vec3::NEG_INFINITY, |a, b| a.max(*b));
        let middle = (low + high).as_dvec3() * 0.5 + scene.centre_m;
        let origin = DVec2::new(middle.x + offset[0], middle.z + offset[1]) - 0.5 * EDGE_M;
        for density in &densities {
            let edge = (EDGE_M * density).round() as u32 + 1;
            let size = PageSize { width: edge, height: edge };
            let at = |x: f64, y: f64| station.point(origin.x + x / density, origin.y + y / density);
            let points: Vec<Option<SurfacePoint>> =
                (0..edge * edge).map(|i| at(f64::from(i % edge), f64::from(i / edge))).collect();
            let started = Instant::now();
            let mut encoder = PageEncoder::new(points.len(), Bits::Sixteen, 64);
            let mut interval_count = 0;
            for (texel, point) in points.iter().enumerate() {
                if let Some(point) = point {
                    let lit = &lit_at(&engine, point)[0];
                    interval_count += lit.as_slice().len();
                    encoder.set(texel, lit);
                }
            }
            let layers = encoder.finish();
            let plain_seconds = started.elapsed().as_secs_f64();
            let started = Instant::now();
            let least_t = path.width_t(0.5) / 8.0;
            let texels: Vec<u32> = (0..points.len() as u32).filter(|&texel| points[texel as usize].is_some()).collect();
            let point = |texel: u32| points[texel as usize].unwrap_or_else(|| unreachable!("it has a point"));
            let search = SpanSearch {
                finder: &finder,
                point: &point,
                hiders: &|session, _, point| session.find(point),
                size,
                walls: None,
                least_t,
            };
            let found = find_spans(&search, &texels, &Silent);
            let found_seconds = started.elapsed().as_secs_f64();
            let tracks: PageTracks = number_tracks(&found, &Linked { size, source: &texels, is_open: &|_, _| true });
            let seconds = started.elapsed().as_secs_f64();
            let mut errors: [Errors; 3] = Default::default();
            for k in 0..POINTS {
                let share = |base: f64| (k as f64 * base).fract();
                let place = DVec2::new(share(0.754_877_666_2), share(0.569_840_290_9)) * f64::from(edge - 1);
                let Some(point) = at(place.x, place.y) else { continue };
                let lit = &lit_at(&engine, &point)[0];
                let footprint = Footprint::new(place, size);
                for i in 0..TIMES {
                    let t = (i as f64 + 0.5) / TIMES as f64;
                    let width_t = path.width_t(t);
                    let truth = soft(lit, t, width_t);
                    let (t, width) = (t as f32, width_t as f32);
                    let plain = footprint.blend(|texel| soft_visibility(&layers, texel, Bits::Sixteen, t, width));
                    let sharp = footprint.blend(|texel| edge_sample(&layers, texel, Bits::Sixteen, t, width));
                    let tracked = tracked_visibility(&tracks, &footprint, t, width);
                    errors[0].add(plain, truth);
                    errors[1].add(sharpened(sharp), truth);
                    errors[2].add(tracked, truth);
                }
            }
            let mut counts: Vec<u32> = tracks.ranges.iter().map(|range| range[1]).collect();
            counts.sort_unstable();
            let n = points.len() as f64;
            println!(
                "{title:<14}{density:>4}  {}  {}  {}   {:5.1} {:5.1} (95 %: {}, most {})   {plain_seconds:.2} \
                 {found_seconds:.2} {seconds:.2}",
                errors[0],
                errors[1],
                errors[2],
                interval_count as f64 / n,
                tracks.spans.len() as f64 / n,
                counts[counts.len() * 95 / 100],
                counts[counts.len() - 1],
            );
        }
    }
    Ok(())
}
