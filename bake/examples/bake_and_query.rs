//! Bakes a scene in memory and asks it when the sun shines on one spot:
//!
//! ```text
//! cargo run --release --example bake_and_query -- SCENE.glb X Z
//! ```
//!
//! X and Z are world coordinates in metres; the spot is the highest surface there. Without arguments it asks about our
//! gas station. Two answers are printed: the exact times at the spot itself, and the times that its texel stores.

use glam::{DVec2, DVec3, Vec2};
use std::error::Error;
use std::path::PathBuf;
use sunbake::atlas::SurfacePoint;
use sunbake::maps::stored_intervals;
use sunbake::progress::Silent;
use sunbake::scene::{Geometry, LoadLimits, Scene, load};
use sunbake::settings::{BakeSettings, SunRequest};
use sunbake::sun::{DayRequest, SunPath};
use sunbake::trace::{Direction, Hit, Tracer};
use sunbake::visibility::{ExactEngine, lit_at};
use sunbake::{Bake, bake_scene};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let station = || concat!(env!("CARGO_MANIFEST_DIR"), "/../assets/gas_station.glb").to_owned();
    let file = PathBuf::from(arguments.next().unwrap_or_else(station));
    let spot = match (arguments.next(), arguments.next()) {
        (Some(x), Some(z)) => DVec2::new(x.parse()?, z.parse()?),
        _ => DVec2::new(6.0, 6.0),
    };

    // The source's own scene is baked; what the bake makes of it holds the atlas coordinates as well.
    let day = DayRequest::new(Some([35.0, -116.0]), Some("2026-06-21".parse()?))?;
    let settings = BakeSettings { ambient: None, ..BakeSettings::draft(SunRequest::Day(day)) };
    let limits = LoadLimits::default();
    let bake = bake_scene(&load(&file, &limits)?, &settings, &Silent)?;
    let path = bake.path.clone().ok_or("the sun does not rise")?;
    let scene = bake.scene(&limits)?;

    let geometry = Geometry::new(&scene);
    let tracer = Tracer::new(&scene, &geometry);
    let top_m = scene.centre_m.y + 2.0 * scene.half_extent_m.y;
    let above_m = DVec3::new(spot.x, top_m + 1.0, spot.y) - scene.centre_m;
    let hit = tracer.closest_hit(above_m, &Direction::new(DVec3::NEG_Y)).ok_or("there is no surface")?;

    let point = SurfacePoint::of_triangle(&scene, &geometry, hit.triangle as usize, hit.barycentric);
    let engine = ExactEngine::new(&tracer, std::slice::from_ref(&path));
    println!("exact at the point: {}", clock_times(&path, lit_at(&engine, &point)[0].as_slice()));
    match texel_of(&bake, &scene, &geometry, &hit) {
        Some((page, texel)) => {
            let lit = stored_intervals(&bake.pages[page].maps.lanes[0].layers, texel, bake.bits.times);
            println!("stored in its texel: {}", clock_times(&path, &lit));
        }
        None => println!("nothing is stored for this surface"),
    }
    Ok(())
}

/// The page that a hit lies on, and the index of the texel there, in row order.
fn texel_of(bake: &Bake, scene: &Scene, geometry: &Geometry, hit: &Hit) -> Option<(usize, usize)> {
    let surface = geometry.surface(hit.triangle as usize);
    let instance = &scene.instances[surface.instance];
    let mesh = &scene.meshes[instance.mesh];
    let place = (scene.nodes[instance.node].gltf, mesh.gltf.1);
    let entry = bake.manifest.instances.iter().find(|entry| (entry.node, entry.primitive) == place)?;
    let page = entry.atlas? as usize;
    let uvs = mesh.texcoord_set(entry.uv_set as usize)?;
    let [a, b, c] = [0, 1, 2].map(|k| uvs[mesh.indices[3 * surface.mesh_triangle + k] as usize]);
    let [v, w] = hit.barycentric.map(|weight| weight as f32);
    let page_uv = (a + (b - a) * v + (c - a) * w) * Vec2::from(entry.uv_scale) + Vec2::from(entry.uv_offset);
    let maps = &bake.pages[page].maps;
    let cell = |share: f32, count: u32| ((share * count as f32) as u32).min(count - 1) as usize;
    Some((page, cell(page_uv.y, maps.height) * maps.width as usize + cell(page_uv.x, maps.width)))
}

/// Lit intervals in local clock time.
fn clock_times(path: &SunPath, lit: &[[f64; 2]]) -> String {
    let clock = |t: f64| path.clock_text(t).unwrap_or_else(|| format!("t {t:.3}"));
    let spans: Vec<String> = lit.iter().map(|&[rise, fall]| format!("{} to {}", clock(rise), clock(fall))).collect();
    if spans.is_empty() { "never".into() } else { spans.join(", ") }
}
