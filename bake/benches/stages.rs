//! Seconds of every stage of a bake of times (ambient light has a bench of its own), with texels and rays a second:
//! `cargo bench -p sunbake --bench stages`.
//!
//! Our own scene, and three shared ones where they are on this machine (`SUNBAKE_SHARED`, or `shared` beside the
//! repository). Arguments after `--` set the page size, and for another engine than the exact one the number of suns:
//! `cargo bench -p sunbake --bench stages -- 1024 256`, or `-- 1024 64 bisect`.

mod common;

use std::path::Path;
use sunbake::progress::Silent;
use sunbake::settings::{BakeSettings, EngineChoice, SunRequest};

const SHARED: [&str; 3] =
    ["truck_town/truck_town.glb", "littlest_tokyo/littlest_tokyo.glb", "two_cylinder_engine/2CylinderEngine.glb"];

fn main() {
    let numbers: Vec<usize> = std::env::args().filter_map(|a| a.parse().ok()).collect();
    let page_size = numbers.first().copied().unwrap_or(1024);
    let engine = match (numbers.get(1), std::env::args().any(|a| a == "bisect")) {
        (None, _) => EngineChoice::Exact,
        (Some(&count), false) => EngineChoice::Rays(count),
        (Some(&count), true) => EngineChoice::Bisect(count),
    };
    println!("pages of {page_size}, {engine}, {} thread(s)", rayon::current_num_threads());
    println!(
        "{:<20}{:>10}{:>10} |{:>8}{:>8}{:>8}{:>11}{:>8}{:>8} s |{:>11}{:>10}",
        "scene",
        "triangles",
        "texels",
        "load",
        "unwrap",
        "bvh",
        "visibility",
        "encode",
        "write",
        "ktexels/s",
        "Mrays/s"
    );
    for file in common::scenes(&SHARED) {
        row(&file, page_size as u32, engine);
    }
}

fn row(file: &Path, page_size_texels: u32, engine: EngineChoice) {
    let name = file.file_stem().unwrap_or_default().to_string_lossy();
    let target = std::env::temp_dir().join(format!("sunbake-bench-{}-{name}", std::process::id()));
    let settings = BakeSettings {
        page_size_texels,
        engine,
        ambient: None,
        ..BakeSettings::standard(SunRequest::Day(common::summer_day()))
    };
    match sunbake::bake(file, &target, true, &settings, &Silent) {
        Err(error) => println!("{name:<20} {error}"),
        Ok(report) => {
            let stats = &report.manifest.stats;
            let s = &stats.seconds;
            println!(
                "{name:<20}{:>10}{:>10} |{:>8.2}{:>8.2}{:>8.2}{:>11.2}{:>8.2}{:>8.2} s |{:>11.1}{:>10.2}",
                stats.triangles,
                stats.texels,
                s.load,
                s.unwrap,
                s.bvh,
                s.visibility,
                s.encode,
                s.write,
                stats.texels as f64 / s.visibility / 1e3,
                stats.rays as f64 / s.visibility / 1e6
            );
        }
    }
    // The next run replaces what cannot be removed now.
    let _ = std::fs::remove_dir_all(&target);
}
