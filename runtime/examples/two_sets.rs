//! Two sets of one scene beside each other, with how they differ and how far each is from truth.
//!
//!     cargo run --release --example two_sets -- SET OTHER SHEET.png [T...]
//!
//! Draws both sets through the scene's default camera at path times T (eight over the day unless given) on the CPU,
//! as lit pictures, and their difference of visibility. Prints, for each time, the mean error of each against soft
//! truth, how far apart the two are, and which share of each one's pixels is visibly wrong away from every edge: of a
//! triangle, or of a shadow in the picture or in truth.

mod common;

use common::{Anything, write};
use std::path::Path;
use sunbake::disk::read::read;
use sunbake::sun::clock_text;
use sunbake_runtime::compare::{Agreement, edges, mean, visibility_difference};
use sunbake_runtime::light::displayed;
use sunbake_runtime::shade::lit_picture;
use sunbake_runtime::sheet::{PictureTable, heat, heat_map};
use sunbake_runtime::technique::{BakedCpu, Technique, Truth};
use sunbake_runtime::texture::srgb_from_linear;
use sunbake_runtime::{Camera, Filter, Moment, Raster, Shot, Stage, View};

/// Size of each picture, and samples along each of a pixel's edges.
const SIZE: [u32; 2] = [340, 191];
const SUPERSAMPLE: u32 = 2;
/// Columns that stand side by side.
const BAND: u32 = 4;
/// Rays over the sun's disc for truth.
const TRUTH_RAYS: u32 = 64;
/// What the eye may see.
const VISIBLE: f32 = 4.0 / 255.0;

struct Set {
    engine: String,
    stage: Stage,
}

impl Set {
    fn read(folder: &str) -> Result<Self, Anything> {
        let engine = read(Path::new(folder))?.manifest.stats.engine;
        Ok(Self { engine, stage: Stage::read(Path::new(folder))? })
    }
}

struct Column {
    clock: String,
    pictures: [Raster<[u8; 3]>; 3],
    errors: [f64; 2],
}

fn main() -> Result<(), Anything> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [first, other, sheet, times @ ..] = args.as_slice() else {
        return Err("give two sets, a file to write, and perhaps path times".into());
    };
    let sets = [Set::read(first)?, Set::read(other)?];
    let camera = Camera::default_of(&sets[0].stage, f64::from(SIZE[0]) / f64::from(SIZE[1]));
    let view = View::new(&camera, SIZE.map(|edge| edge * SUPERSAMPLE), &sets[0].stage.scene);
    let times: Vec<f64> = match times {
        [] => (0..8).map(|i| (f64::from(i) + 0.5) / 8.0).collect(),
        given => given.iter().map(|t| t.parse()).collect::<Result<_, _>>()?,
    };
    let [a, b] = [&sets[0].engine, &sets[1].engine];
    println!("t       clock {a:>10}{b:>10}     apart   beyond edges: {a}, {b}");
    let columns = times.iter().map(|&t| draw(&sets, &view, t)).collect::<Result<Vec<_>, _>>()?;
    write(Path::new(sheet), &table(&sets, &columns).draw())
}

/// Draws, compares and prints one moment.
fn draw(sets: &[Set; 2], view: &View, t: f64) -> Result<Column, Anything> {
    let shots = sets.each_ref().map(|set| Shot::new(&set.stage, *view));
    let moment = Moment::new(sets[0].stage.path.as_ref(), t);
    let truth = Truth::Soft { rays: TRUTH_RAYS }.visibility(&shots[0], &moment)?;
    let seen = |shot: &Shot| BakedCpu::new(shot.stage, Filter::Bilinear).visibility(shot, &moment);
    let seen = [seen(&shots[0])?, seen(&shots[1])?];
    let found = seen.each_ref().map(|seen| against(&shots[0], seen, &truth));
    let difference = visibility_difference(&seen[0], &seen[1]);
    let minutes = sets[0].stage.path.as_ref().and_then(|path| path.clock_min(t));
    let clock = minutes.map_or_else(|| format!("t {t:.3}"), clock_text);
    let errors = found.map(|found| found.mean);
    let beyond = found.map(|found| 100.0 * found.unexplained as f64 / found.pixels as f64);
    println!(
        "{t:.4}  {clock:<6}{:>10.4}{:>10.4}{:>10.4}{:>14.3} %{:>8.3} %",
        errors[0],
        errors[1],
        mean(&difference),
        beyond[0],
        beyond[1]
    );
    let lit = [0, 1].map(|i| displayed(&lit_picture(&shots[i], &moment, &seen[i], None), SUPERSAMPLE));
    let [first, other] = lit;
    Ok(Column { clock, pictures: [first, other, heat_map(&difference.reduced(SUPERSAMPLE))], errors })
}

/// How far a picture of visibility is from truth.
fn against(shot: &Shot, seen: &Raster<f32>, truth: &Raster<f32>) -> Agreement {
    let beside = edges(shot, seen).iter().zip(edges(shot, truth)).map(|(a, b)| *a || b).collect::<Vec<_>>();
    Agreement::new(&visibility_difference(seen, truth), &beside, VISIBLE)
}

fn table(sets: &[Set; 2], columns: &[Column]) -> PictureTable {
    let row = |k: usize| columns.iter().map(|column| column.pictures[k].clone()).collect();
    let [first, other] = [&sets[0].engine, &sets[1].engine];
    PictureTable {
        title: vec![format!("{first} and {other}"), "below each column, mean errors against soft truth".into()],
        rows: vec![(first.clone(), row(0)), (other.clone(), row(1)), ("difference".into(), row(2))],
        heads: columns.iter().map(|column| column.clock.clone()).collect(),
        feet: columns.iter().map(|column| format!("{:.4} and {:.4}", column.errors[0], column.errors[1])).collect(),
        band: BAND,
        legend: (["0".into(), "1".into()], "difference of visibility; 0 is none, 1 is sun for shade".into()),
        legend_color: |share| heat(srgb_from_linear(share)),
    }
}
