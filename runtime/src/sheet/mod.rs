//! Sheets of pictures: small pictures side by side, with words under them.

mod canvas;
mod font;
mod heat;

pub use canvas::{Canvas, INK, PAPER, QUIET_INK, thumbnail};
pub use font::{CELL, text_width};
pub use heat::{heat, heat_map};

use crate::image::Raster;

/// Space around and between pictures, in pixels.
const GAP: u32 = 10;
/// How much larger than the font's own pixels labels are drawn.
const SCALE: u32 = 2;

/// Pictures of one size in reading order, each with a label under it.
pub fn contact_sheet(pictures: &[(Raster<[u8; 3]>, String)], columns: u32) -> Raster<[u8; 3]> {
    let Some(([width, height], _)) = pictures.first().map(|(picture, label)| (picture.size, label)) else {
        return Raster::filled([1, 1], PAPER);
    };
    let rows = (pictures.len() as u32).div_ceil(columns);
    let label_height = CELL[1] * SCALE + GAP;
    let step = [width + GAP, height + label_height + GAP];
    let mut canvas = Canvas::new([GAP + columns * step[0], GAP + rows * step[1]]);
    for (i, (picture, label)) in pictures.iter().enumerate() {
        let (column, row) = (i as u32 % columns, i as u32 / columns);
        let corner = [GAP + column * step[0], GAP + row * step[1]];
        canvas.picture(corner, picture);
        canvas.text_centred([corner[0] + width / 2, corner[1] + height + GAP / 2], label, SCALE, INK);
    }
    canvas.finish()
}

/// A table of pictures: a name before each row, a line of words over and one under each column, and a bar of colours that
/// says what those of the last row mean.
pub struct Table {
    /// Lines above everything; the first is larger.
    pub title: Vec<String>,
    /// Name and pictures of each row; all pictures have one size.
    pub rows: Vec<(String, Vec<Raster<[u8; 3]>>)>,
    /// Over each column.
    pub heads: Vec<String>,
    /// Under each column.
    pub feet: Vec<String>,
    /// What the last row's colours mean: a value for each end of the bar, and words beside it.
    pub legend: ([String; 2], String),
    /// How a share of the bar is coloured.
    pub legend_color: fn(f32) -> [u8; 3],
}

impl Table {
    /// Draws the table.
    pub fn draw(&self) -> Raster<[u8; 3]> {
        let [width, height] = self.rows.iter().flat_map(|(_, row)| row).map(|p| p.size).next().unwrap_or([1, 1]);
        let columns = self.heads.len() as u32;
        let line = CELL[1] * SCALE + GAP;
        let left = GAP + self.rows.iter().map(|(name, _)| text_width(name, SCALE)).max().unwrap_or(0) + 2 * GAP;
        let top = GAP + line * (self.title.len() as u32 + 1) + line;
        let bottom = top + self.rows.len() as u32 * (height + GAP);
        let mut canvas = Canvas::new([left + columns * (width + GAP), bottom + 3 * line + GAP]);
        for (i, text) in self.title.iter().enumerate() {
            let (scale, ink) = if i == 0 { (SCALE + 1, INK) } else { (SCALE, QUIET_INK) };
            canvas.text([GAP, GAP + i as u32 * line + if i == 0 { 0 } else { GAP }], text, scale, ink);
        }
        for (i, (name, pictures)) in self.rows.iter().enumerate() {
            let y = top + i as u32 * (height + GAP);
            canvas.text([GAP, y + height / 2 - CELL[1]], name, SCALE, INK);
            for (k, picture) in pictures.iter().enumerate() {
                canvas.picture([left + k as u32 * (width + GAP), y], picture);
            }
        }
        for k in 0..columns {
            let middle = left + k * (width + GAP) + width / 2;
            canvas.text_centred([middle, top - line], &self.heads[k as usize], SCALE, INK);
            canvas.text_centred([middle, bottom], &self.feet[k as usize], SCALE, INK);
        }
        self.draw_legend(&mut canvas, [left, bottom + line + GAP], width);
        canvas.finish()
    }

    fn draw_legend(&self, canvas: &mut Canvas, [x, y]: [u32; 2], width: u32) {
        let (ends, words) = &self.legend;
        canvas.text([x, y], &ends[0], SCALE, QUIET_INK);
        let start = x + text_width(&ends[0], SCALE) + GAP;
        for i in 0..width {
            let color = (self.legend_color)(i as f32 / (width - 1).max(1) as f32);
            canvas.rectangle([start + i, y], [1, CELL[1] * SCALE], color);
        }
        let after = start + width + GAP;
        canvas.text([after, y], &ends[1], SCALE, QUIET_INK);
        canvas.text([after + text_width(&ends[1], SCALE) + 2 * GAP, y], words, SCALE, QUIET_INK);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sheet_holds_every_picture_and_its_words() {
        let picture = Raster::filled([60, 30], [10, 200, 30]);
        let pictures: Vec<_> = (0..5).map(|i| (picture.clone(), format!("0{i}:00"))).collect();
        let sheet = contact_sheet(&pictures, 3);
        let count = |color: [u8; 3]| sheet.pixels.iter().filter(|p| **p == color).count();
        assert_eq!(count([10, 200, 30]), 5 * 60 * 30);
        assert!(count(INK) > 100);
        assert_eq!(contact_sheet(&[], 3).size, [1, 1]);
    }
}
