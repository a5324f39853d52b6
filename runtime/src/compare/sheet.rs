//! A comparison as one picture: the best baked and the best live technique, and the error of each.

use super::comparison::{Outcome, lit_picture_of};
use super::report::TechniqueEntry;
use super::visibility_difference;
use crate::image::Raster;
use crate::light::displayed;
use crate::sheet::{PictureTable, heat, heat_map};
use crate::texture::srgb_from_linear;

/// Most columns of the sheet.
const COLUMNS: usize = 4;
const PICTURE_WIDTH_PX: u32 = 420;

/// The two techniques that are shown side by side, as indices in [`Outcome::techniques`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BestPair {
    /// The best baked technique.
    pub baked: usize,
    /// The best live technique, or truth where nothing live was drawn.
    pub live: usize,
}

impl BestPair {
    /// Best is whose lit pictures are most like the reference's by structural similarity, then whose mean error is
    /// least. None where nothing baked was drawn, or nothing beside it.
    pub fn of(techniques: &[TechniqueEntry]) -> Option<Self> {
        let best = |families: &[&str]| {
            let all = techniques.iter().enumerate().filter(|(_, one)| families.contains(&one.family.as_str()));
            // Similarity counts to four digits; beyond that the mean error decides.
            let rank = |one: &TechniqueEntry| (-(one.error.ssim * 1e4).round(), one.error.mean);
            let order = |a: (f64, f64), b: (f64, f64)| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1));
            all.min_by(|a, b| order(rank(a.1), rank(b.1))).map(|(i, _)| i)
        };
        let live = best(&["map", "volumes"]).or_else(|| best(&["truth"]))?;
        Some(Self { baked: best(&["baked"])?, live })
    }
}

/// Draws both techniques and their errors at times spread over the day, through the cameras in turn. `clocks` are the
/// times' labels.
pub fn sheet(title: &[String], outcome: &Outcome, pair: BestPair, clocks: &[String]) -> Raster<[u8; 3]> {
    let columns = columns(outcome, outcome.frames.len() / clocks.len().max(1));
    let small = |picture: Raster<[u8; 3]>| crate::sheet::thumbnail(&picture, PICTURE_WIDTH_PX);
    let lit = |technique: usize, frame: usize| {
        small(displayed(&lit_picture_of(&outcome.frames[frame], &visibility(outcome, technique, frame)), 1))
    };
    let error = |technique: usize, frame: usize| {
        let seen = visibility(outcome, technique, frame);
        small(heat_map(&visibility_difference(&seen, &outcome.frames[frame].reference)))
    };
    let row = |picture: &dyn Fn(usize, usize) -> Raster<[u8; 3]>, technique: usize| {
        columns.iter().map(|&frame| picture(technique, frame)).collect::<Vec<_>>()
    };
    let name = |technique: usize| outcome.techniques[technique].family.clone();
    let [baked, live] = [name(pair.baked), name(pair.live)];
    let mean = |technique: usize, frame: usize| outcome.techniques[technique].frames[frame].error.mean;
    let table = PictureTable {
        title: title.to_vec(),
        rows: vec![
            (baked.clone(), row(&lit, pair.baked)),
            (live.clone(), row(&lit, pair.live)),
            (format!("{baked}, error"), row(&error, pair.baked)),
            (format!("{live}, error"), row(&error, pair.live)),
        ],
        heads: columns.iter().map(|&frame| clocks[outcome.frames[frame].time].clone()).collect(),
        feet: columns
            .iter()
            .map(|&frame| format!("{:.4} and {:.4}", mean(pair.baked, frame), mean(pair.live, frame)))
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
    let codes = &outcome.visibility[technique][frame];
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
