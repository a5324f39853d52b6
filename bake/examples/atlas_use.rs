//! How much of its pages an atlas uses, and what its charts cost: surface, texels that are baked, gutters and what is
//! left free, at several sizes of a page:
//!
//! ```text
//! cargo run --release --example atlas_use -- PAGE_SIZE_TEXELS[,...] SCENE ...
//! ```
//!
//! *Surface* is the area of all triangles in texels, *baked* the texels that some triangle touches. A chart's classes
//! are by its surface: under one texel, one to four, and more.

use glam::{DVec2, Vec2};
use std::collections::HashMap;
use std::error::Error;
use std::path::Path;
use std::time::Instant;
use sunbake::atlas::{self, Atlas, AtlasSettings, gutter, sample_page};
use sunbake::scene::{Geometry, LoadLimits, Scene, load_without_pictures};

/// Of all charts of a class: how many, and their surface in texels.
#[derive(Debug, Clone, Copy, Default)]
struct Class {
    charts: u64,
    surface: f64,
}

/// Surface of each chart of an instance, in texels: triangles that share a place on the page belong together.
fn chart_surfaces(scene: &Scene, atlas: &Atlas, instance: usize) -> Vec<f64> {
    let layout = &atlas.layouts[scene.instances[instance].mesh];
    let placement = atlas.placements[instance];
    let scale = placement.scale.as_dvec2() * page_size(atlas, placement.page);
    let mut first_at = HashMap::new();
    let place = |uv: &Vec2| (*uv + 0.0).to_array().map(f32::to_bits);
    let mut parent: Vec<u32> =
        layout.uvs.iter().zip(0..).map(|(uv, v)| *first_at.entry(place(uv)).or_insert(v)).collect();
    fn root(parent: &mut [u32], mut v: u32) -> u32 {
        while parent[v as usize] != v {
            parent[v as usize] = parent[parent[v as usize] as usize];
            v = parent[v as usize];
        }
        v
    }
    let triangles = layout.indices.as_chunks::<3>().0;
    for corners in triangles {
        let [a, b, c] = corners.map(|v| root(&mut parent, v));
        let least = a.min(b).min(c);
        [a, b, c].into_iter().for_each(|v| parent[v as usize] = least);
    }
    let mut surfaces: HashMap<u32, f64> = HashMap::new();
    for corners in triangles {
        let [a, b, c] = corners.map(|v| layout.uvs[v as usize].as_dvec2() * scale);
        *surfaces.entry(root(&mut parent, corners[0])).or_default() += (b - a).perp_dot(c - a).abs() * 0.5;
    }
    surfaces.into_values().collect()
}

fn page_size(atlas: &Atlas, page: u32) -> DVec2 {
    let size = atlas.pages[page as usize];
    DVec2::new(size.width.into(), size.height.into())
}

fn row(scene: &Scene, geometry: &Geometry, name: &str, edge: u32) -> Result<(), Box<dyn Error>> {
    let settings = AtlasSettings { page_size_texels: edge, ..AtlasSettings::default() };
    let started = Instant::now();
    let atlas = atlas::build(scene, &settings, &|_| true)?;
    let seconds = started.elapsed().as_secs_f64();
    let mut classes = [Class::default(); 3];
    let instances = (0..scene.instances.len()).filter(|&i| !atlas.placements[i].is_empty());
    for surface in instances.flat_map(|instance| chart_surfaces(scene, &atlas, instance)) {
        let class = &mut classes[if surface < 1.0 { 0 } else { usize::from(surface >= 4.0) + 1 }];
        class.charts += 1;
        class.surface += surface;
    }
    let asked = f64::from(edge).powi(2) * atlas.pages.len() as f64;
    let [mut baked, mut copied] = [0, 0];
    for page in 0..atlas.pages.len() {
        let samples = sample_page(scene, geometry, &atlas, page as u32);
        let copies = gutter(scene, geometry, &atlas, page as u32, &samples, settings.padding_texels);
        baked += samples.samples.len();
        copied += copies.len();
    }
    let surface: f64 = classes.iter().map(|class| class.surface).sum();
    let percent = |texels: f64| format!("{:.1} %", 100.0 * texels / asked);
    println!(
        "| {name} | {} x {edge} | {:.2} | {} | {} | {} | {} | {} | {} | {} | {seconds:.1} s |",
        atlas.pages.len(),
        atlas.texels_per_metre,
        classes[0].charts,
        classes[1].charts,
        classes[2].charts,
        percent(surface),
        percent(baked as f64),
        percent(copied as f64),
        percent(asked - (baked + copied) as f64),
    );
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let sizes: Vec<u32> =
        arguments.next().unwrap_or("2048".into()).split(',').map(str::parse).collect::<Result<_, _>>()?;
    println!("| scene | pages | texels a metre | under 1 | 1 to 4 | larger | surface | baked | gutter | free | time |");
    println!("|---|---|---|---|---|---|---|---|---|---|---|");
    for file in arguments {
        let scene = load_without_pictures(Path::new(&file), &LoadLimits::default())?;
        let geometry = Geometry::new(&scene);
        let name = Path::new(&file).file_stem().unwrap_or_default().to_string_lossy().into_owned();
        for &edge in &sizes {
            row(&scene, &geometry, &name, edge)?;
        }
    }
    Ok(())
}
