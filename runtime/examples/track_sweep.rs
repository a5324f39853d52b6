//! A day along narrow shadows, step by step: whether anything pops.
//!
//!     cargo run --release --example track_sweep -- SET SHEET.png [OBJECT]
//!
//! SET is our own scene, baked with `--tracks`; OBJECT is one of `track_sheet`, the fence unless given. The day is
//! played back in steps of a twentieth of the sun's width. Printed are the largest change of any pixel in a step, and
//! how many are over 0.1. The sheet shows the largest steps of tracks: before, after, what changed, and truth.

mod common;
#[path = "common/looks.rs"]
mod looks;

use common::{Anything, write};
use looks::LOOKS;
use std::path::Path;
use sunbake::sun::clock_text;
use sunbake_runtime::light::displayed;
use sunbake_runtime::sheet::{PictureTable, heat, heat_map};
use sunbake_runtime::technique::{BakedCpu, Technique, Truth};
use sunbake_runtime::texture::srgb_from_linear;
use sunbake_runtime::{Filter, Moment, Raster, Shot, Stage};

/// Size of the pictures that are played back, and of those of the sheet.
const SIZE: [u32; 2] = [150, 100];
const SHEET_SIZE: [u32; 2] = [300, 200];
/// Steps in a width of the sun.
const STEPS_A_WIDTH: f64 = 20.0;
/// A step that is seen.
const POP: f32 = 0.1;
/// Steps on the sheet, and widths of the sun between them.
const COLUMNS: usize = 5;
const APART_WIDTHS: f64 = 4.0;
/// Rays over the sun's disc for truth.
const TRUTH_RAYS: u32 = 64;

/// What one step of the day does.
struct Step {
    /// Path times before and after.
    t: [f64; 2],
    /// The largest change of any pixel.
    largest: f32,
    /// Pixels that change by more than [`POP`].
    pops: usize,
}

fn main() -> Result<(), Anything> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [set, sheet, object @ ..] = args.as_slice() else { return Err("give a set and a file to write".into()) };
    let stage = Stage::read(Path::new(set))?;
    let object = object.first().map_or("fence west 1", String::as_str);
    let look = LOOKS.iter().find(|look| look.object == object).ok_or("no such object: see track_sheet")?;
    let shot = look.shot(&stage, SIZE)?;
    let width_t = f64::from(stage.moment(0.5).width_t);
    let count = (STEPS_A_WIDTH / width_t).ceil() as usize;
    println!("{object}: {count} steps of {} x {} pixels", SIZE[0], SIZE[1]);
    let mut of_tracks = Vec::new();
    for (name, filter) in [("tracks", Filter::Tracks), ("sharp", Filter::Sharp), ("bilinear", Filter::Bilinear)] {
        let steps = sweep(&stage, &shot, filter, count)?;
        let largest = steps.iter().map(|step| step.largest).fold(0.0, f32::max);
        let pops: usize = steps.iter().map(|step| step.pops).sum();
        let pixels = count * (SIZE[0] * SIZE[1]) as usize;
        println!("{name:<8}  largest step {largest:.3}, {pops} of {pixels} pixels by more than {POP}");
        if filter == Filter::Tracks {
            of_tracks = steps;
        }
    }
    of_tracks.sort_by(|a, b| b.largest.total_cmp(&a.largest));
    let mut shown: Vec<Step> = Vec::new();
    for step in of_tracks {
        if shown.iter().all(|other| (other.t[0] - step.t[0]).abs() > APART_WIDTHS * width_t) && shown.len() < COLUMNS {
            shown.push(step);
        }
    }
    write(Path::new(sheet), &table(&stage, &look.shot(&stage, SHEET_SIZE)?, &shown)?.draw())
}

/// The day in so many steps.
fn sweep(stage: &Stage, shot: &Shot, filter: Filter, count: usize) -> Result<Vec<Step>, Anything> {
    let mut baked = BakedCpu::new(stage, filter);
    let mut before: Option<(f64, Raster<f32>)> = None;
    let mut steps = Vec::with_capacity(count);
    for i in 0..=count {
        let t = i as f64 / count as f64;
        let seen = baked.visibility(shot, &stage.moment(t))?;
        if let Some((t_before, before)) = before {
            let changes = || before.pixels.iter().zip(&seen.pixels).map(|(a, b)| (a - b).abs());
            let pops = changes().filter(|change| *change > POP).count();
            steps.push(Step { t: [t_before, t], largest: changes().fold(0.0, f32::max), pops });
        }
        before = Some((t, seen));
    }
    Ok(steps)
}

/// Pictures of steps.
fn table(stage: &Stage, shot: &Shot, steps: &[Step]) -> Result<PictureTable, Anything> {
    let names = ["before", "after", "change", "truth"];
    let mut rows: Vec<(String, Vec<Raster<[u8; 3]>>)> = names.map(|name| (name.to_owned(), Vec::new())).into();
    let (mut heads, mut feet) = (Vec::new(), Vec::new());
    let mut baked = BakedCpu::new(stage, Filter::Tracks);
    for step in steps {
        let moments: [Moment; 2] = step.t.map(|t| stage.moment(t));
        let [before, after] = [baked.visibility(shot, &moments[0])?, baked.visibility(shot, &moments[1])?];
        let change = before.pixels.iter().zip(&after.pixels).map(|(a, b)| (a - b).abs()).collect();
        let mut truth = Truth::Soft { rays: TRUTH_RAYS };
        let pictures = [
            displayed(&baked.color(shot, &moments[0])?, 1),
            displayed(&baked.color(shot, &moments[1])?, 1),
            heat_map(&Raster { size: before.size, pixels: change }),
            displayed(&truth.color(shot, &moments[0])?, 1),
        ];
        rows.iter_mut().zip(pictures).for_each(|((_, row), picture)| row.push(picture));
        let clock = stage.path.as_ref().and_then(|path| path.clock_min(step.t[0])).map(clock_text).unwrap_or_default();
        heads.push(clock);
        feet.push(format!("{:.3}", step.largest));
    }
    Ok(PictureTable {
        title: vec![
            "the largest steps of a day, a twentieth of the width of the sun each".into(),
            "under each the largest change of a pixel".into(),
        ],
        rows,
        heads,
        feet,
        band: COLUMNS as u32,
        legend: (["0".into(), "1".into()], "change of visibility".into()),
        legend_color: |share| heat(srgb_from_linear(share)),
    })
}
