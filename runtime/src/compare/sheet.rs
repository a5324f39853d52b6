//! A comparison on one sheet: a baked set beside a live technique, and how far each is from the reference.

use super::comparison::{Outcome, lit_by};
use super::report::TechniqueEntry;
use super::visibility_difference;
use crate::image::Raster;
use crate::light::{codes_from_display, display_from_light};
use crate::sheet::{Table, heat, heat_map};
use crate::texture::srgb_from_linear;

/// Columns of the sheet, and those that stand side by side.
const COLUMNS: usize = 4;
/// Width of a picture.
const WIDTH_PX: u32 = 420;

/// Which two techniques to set side by side, by their places in the outcome.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pair {
    /// To be shown first.
    pub ours: usize,
    /// To be shown second.
    pub theirs: usize,
}

impl Pair {
    /// The best baked technique and the best live one, by how like the reference's their lit pictures are; rays stand in where
    /// nothing live was drawn.
    pub fn best(techniques: &[TechniqueEntry]) -> Option<Self> {
        let best = |families: &[&str]| {
            let all = techniques.iter().enumerate().filter(|(_, one)| families.contains(&one.family.as_str()));
            // Likeness to four digits: beyond that it is the mean error that tells.
            let rank = |one: &TechniqueEntry| (-(one.error.ssim * 1e4).round(), one.error.mean);
            let order = |a: (f64, f64), b: (f64, f64)| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1));
            all.min_by(|a, b| order(rank(a.1), rank(b.1))).map(|(i, _)| i)
        };
        let theirs = best(&["map", "volumes"]).or_else(|| best(&["truth"]))?;
        Some(Self { ours: best(&["baked"])?, theirs })
    }
}

/// The sheet: at moments spread over the day, through each camera in turn, both techniques, and their errors. `clocks` is what times
/// are called.
pub fn sheet(title: &[String], outcome: &Outcome, pair: Pair, clocks: &[String]) -> Raster<[u8; 3]> {
    let columns = columns(outcome, outcome.frames.len() / clocks.len().max(1));
    let small = |picture: Raster<[u8; 3]>| crate::sheet::thumbnail(&picture, WIDTH_PX);
    let lit = |technique: usize, frame: usize| {
        let light = lit_by(&outcome.frames[frame], &visibility(outcome, technique, frame));
        let shown = light.pixels.iter().map(|&light| codes_from_display(display_from_light(light)));
        small(Raster { size: light.size, pixels: shown.collect() })
    };
    let error = |technique: usize, frame: usize| {
        let seen = visibility(outcome, technique, frame);
        small(heat_map(&visibility_difference(&seen, &outcome.frames[frame].reference)))
    };
    let row = |picture: &dyn Fn(usize, usize) -> Raster<[u8; 3]>, technique: usize| {
        columns.iter().map(|&frame| picture(technique, frame)).collect::<Vec<_>>()
    };
    let name = |technique: usize| outcome.techniques[technique].family.clone();
    let [ours, theirs] = [name(pair.ours), name(pair.theirs)];
    let mean = |technique: usize, frame: usize| outcome.techniques[technique].frames[frame].error.mean;
    let table = Table {
        title: title.to_vec(),
        rows: vec![
            (ours.clone(), row(&lit, pair.ours)),
            (theirs.clone(), row(&lit, pair.theirs)),
            (format!("{ours}, error"), row(&error, pair.ours)),
            (format!("{theirs}, error"), row(&error, pair.theirs)),
        ],
        heads: columns.iter().map(|&frame| clocks[outcome.frames[frame].time].clone()).collect(),
        feet: columns
            .iter()
            .map(|&frame| format!("{:.4} and {:.4}", mean(pair.ours, frame), mean(pair.theirs, frame)))
            .collect(),
        band: columns.len().max(1) as u32,
        legend: (
            ["0".into(), "1".into()],
            "error of visibility; 1 is sun for shade; means are below the pictures".into(),
        ),
        legend_color: |share| heat(srgb_from_linear(share)),
    };
    table.draw()
}

fn visibility(outcome: &Outcome, technique: usize, frame: usize) -> Raster<f32> {
    let codes = &outcome.seen[technique][frame];
    Raster { size: codes.size, pixels: codes.pixels.iter().map(|&code| f32::from(code) / 255.0).collect() }
}

/// Frames spread over the day, and over the cameras in turn.
fn columns(outcome: &Outcome, cameras: usize) -> Vec<usize> {
    let times = outcome.frames.len() / cameras.max(1);
    let count = COLUMNS.min(outcome.frames.len());
    let mut columns: Vec<usize> = (0..count)
        .map(|i| {
            let time = if count > 1 { i * (times - 1) / (count - 1) } else { times / 2 };
            time * cameras + i % cameras
        })
        .collect();
    columns.dedup();
    columns
}
