//! Reads a baked set and prints how much of its surface sees the sun through the day:
//!
//! ```text
//! cargo run --release --example read_set -- baked
//! ```
//!
//! This is all that an engine has to do: read the manifest, load the rise and fall textures, evaluate texels at a time.

use std::error::Error;
use std::path::PathBuf;
use sunbake::atlas;
use sunbake::disk::read::{BakedSet, read};
use sunbake::maps::{LaneMaps, PageMaps, soft_visibility};
use sunbake::scene::{Geometry, LoadLimits};
use sunbake::sun::SunPath;

/// Moments of the day that are printed.
const MOMENTS: usize = 12;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).map(PathBuf::from).ok_or("name the folder of a baked set")?;
    let set = read(&folder)?;
    let path = set.path.as_ref().ok_or("this set holds no sun")?;
    println!("{}: {} pages, {} bits a time", folder.display(), set.pages.len(), set.bits.count());
    let covered = covered_texels(&set)?;
    for moment in 0..MOMENTS {
        let t = (moment as f64 + 0.5) / MOMENTS as f64;
        let clock = path.clock_text(t).unwrap_or_else(|| format!("t {t:.3}"));
        println!("{clock}  {:>5.1} % of texels see the sun", 100.0 * lit_share(&set, path, &covered, t));
    }
    Ok(())
}

/// For each page, the texels that lie on a surface. The others hold gutters.
fn covered_texels(set: &BakedSet) -> Result<Vec<Vec<usize>>, Box<dyn Error>> {
    let scene = set.scene(&LoadLimits::default())?;
    let (atlas, geometry) = (set.manifest.atlas(&scene), Geometry::new(&scene));
    let texels = |page: usize| {
        let samples = atlas::sample_page(&scene, &geometry, &atlas, page as u32).samples;
        samples.iter().map(|sample| sample.texel as usize).collect()
    };
    Ok((0..set.pages.len()).map(texels).collect())
}

/// Mean visibility of the sun over all covered texels at path time `t`, 0 to 1.
fn lit_share(set: &BakedSet, path: &SunPath, covered: &[Vec<usize>], t: f64) -> f64 {
    let page_sum = |(page, texels): (&PageMaps, &Vec<usize>)| -> f64 {
        texels.iter().map(|&texel| texel_visibility(set, path, page, texel, t)).sum()
    };
    let sum: f64 = set.pages.iter().zip(covered).map(page_sum).sum();
    sum / covered.iter().map(Vec::len).sum::<usize>().max(1) as f64
}

/// Of each lane across the sun's disc, what the texel sees of it, weighted by its share of the disc.
fn texel_visibility(set: &BakedSet, path: &SunPath, page: &PageMaps, texel: usize, t: f64) -> f64 {
    let lane = |lane: &LaneMaps| {
        let width_t = path.width_t(t) * lane.lane.chord(path.angular_radius_rad);
        lane.lane.weight * f64::from(soft_visibility(&lane.layers, texel, set.bits, t as f32, width_t as f32))
    };
    page.lanes.iter().map(lane).sum()
}
