//! Shadows that are narrower than texels, close by: as texels show them, as tracks do, and as rays do.
//!
//!     cargo run --release --bin sunbake -- bake assets/gas_station.glb -o SET --only intervals --tracks OPTIONS
//!     cargo run --release --example track_sheet -- SET SHEET.png [OBJECT]
//!
//! SET is our own scene. The picket fence is seen at five times of its day, other narrow things at one each; given an
//! OBJECT of these, it alone is drawn.

mod common;
#[path = "common/looks.rs"]
mod looks;

use common::{Anything, write};
use looks::{LOOKS, Look};
use std::path::Path;
use sunbake::sun::clock_text;
use sunbake_runtime::compare::{mean, visibility_difference};
use sunbake_runtime::light::displayed;
use sunbake_runtime::sheet::{PictureTable, heat, heat_map};
use sunbake_runtime::technique::{BakedCpu, Technique, Truth};
use sunbake_runtime::texture::srgb_from_linear;
use sunbake_runtime::{Filter, Stage};

/// Size of each picture.
const SIZE: [u32; 2] = [300, 200];
/// Columns that stand side by side.
const BAND: u32 = 5;
/// Path times of each: five for the picket fence.
const TIMES: [&[f64]; LOOKS.len()] = [&[0.1, 0.3, 0.5, 0.7, 0.9], &[0.25], &[0.5], &[0.4], &[0.4], &[0.25]];
/// Rays over the sun's disc for truth.
const TRUTH_RAYS: u32 = 64;

fn main() -> Result<(), Anything> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [set, sheet, object @ ..] = args.as_slice() else { return Err("give a set and a file to write".into()) };
    let stage = Stage::read(Path::new(set))?;
    let filters = [("filtered", Filter::Bilinear), ("tracks", Filter::Tracks)];
    let mut table = PictureTable {
        title: vec![
            "shadows narrower than texels, as texels, shadow tracks and rays show them".into(),
            "under each the mean error of visibility: filtered, then tracks".into(),
        ],
        rows: ["filtered", "tracks", "truth", "error", "of tracks"].map(|name| (name.to_owned(), Vec::new())).into(),
        heads: Vec::new(),
        feet: Vec::new(),
        band: BAND,
        legend: (["0".into(), "1".into()], "error of visibility: filtered above, tracks below".into()),
        legend_color: |share| heat(srgb_from_linear(share)),
    };
    let is_asked = |look: &Look| object.first().is_none_or(|object| object == look.object);
    for (look, times) in LOOKS.iter().zip(TIMES).filter(|(look, _)| is_asked(look)) {
        let shot = look.shot(&stage, SIZE)?;
        for &t in times {
            let moment = stage.moment(t);
            let mut truth = Truth::Soft { rays: TRUTH_RAYS };
            let seen = truth.visibility(&shot, &moment)?;
            let mut pictures = Vec::new();
            let mut differences = Vec::new();
            for (_, filter) in filters {
                let mut baked = BakedCpu::new(&stage, filter);
                pictures.push(displayed(&baked.color(&shot, &moment)?, 1));
                differences.push(visibility_difference(&baked.visibility(&shot, &moment)?, &seen));
            }
            pictures.push(displayed(&truth.color(&shot, &moment)?, 1));
            pictures.extend(differences.iter().map(heat_map));
            table.rows.iter_mut().zip(pictures).for_each(|((_, row), picture)| row.push(picture));
            let clock = stage.path.as_ref().and_then(|path| path.clock_min(t)).map(clock_text).unwrap_or_default();
            let errors = differences.iter().map(|difference| format!("{:.3}", mean(difference)));
            table.feet.push(errors.collect::<Vec<_>>().join("  "));
            table.heads.push(format!("{}, {clock}", look.object));
            println!("{} {clock}: {}", look.object, table.feet.last().map_or("", String::as_str));
        }
    }
    write(Path::new(sheet), &table.draw())
}
