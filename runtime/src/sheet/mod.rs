//! Sheets of small pictures with labels.

mod canvas;
mod font;
mod heat;

pub use canvas::{Canvas, INK, PAPER, QUIET_INK, thumbnail};
pub use font::{CELL, text_width};
pub use heat::{heat, heat_map};

use crate::image::Raster;

/// Space around and between pictures, in pixels.
const GAP: u32 = 10;
/// Pixels per pixel of the font, for labels.
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

/// A table of pictures: a name before each row, text over and under each column, and a legend for the colours of the
/// last row. Tables with many columns are broken into bands of [`PictureTable::band`] columns, one under the other.
pub struct PictureTable {
    /// Lines above everything; the first is larger.
    pub title: Vec<String>,
    /// Name and pictures of each row; all pictures have one size.
    pub rows: Vec<(String, Vec<Raster<[u8; 3]>>)>,
    /// Text over each column.
    pub heads: Vec<String>,
    /// Text under each column.
    pub feet: Vec<String>,
    /// Most columns side by side.
    pub band: u32,
    /// The legend of the last row's colours: the values at both ends of the bar, and the text beside it.
    pub legend: ([String; 2], String),
    /// The colour at a share of the bar, 0 to 1.
    pub legend_color: fn(f32) -> [u8; 3],
}

/// Height of a line of text and of the space below it.
const LINE: u32 = CELL[1] * SCALE + GAP;

impl PictureTable {
    /// Draws names, pictures and legend.
    pub fn draw(&self) -> Raster<[u8; 3]> {
        let [width, height] = self.rows.iter().flat_map(|(_, row)| row).map(|p| p.size).next().unwrap_or([1, 1]);
        let columns = self.heads.len() as u32;
        let band = self.band.clamp(1, columns.max(1));
        let left = 3 * GAP + self.rows.iter().map(|(name, _)| text_width(name, SCALE)).max().unwrap_or(0);
        let top = GAP + LINE * (self.title.len() as u32 + 1);
        let band_height = 2 * LINE + GAP + self.rows.len() as u32 * (height + GAP);
        let bottom = top + columns.div_ceil(band) * band_height;
        let mut canvas = Canvas::new([left + band * (width + GAP), bottom + LINE]);
        for (i, text) in self.title.iter().enumerate() {
            let (scale, ink, below) = if i == 0 { (SCALE + 1, INK, 0) } else { (SCALE, QUIET_INK, GAP) };
            canvas.text([GAP, GAP + i as u32 * LINE + below], text, scale, ink);
        }
        for column in 0..columns {
            let corner = [left + column % band * (width + GAP), top + column / band * band_height];
            self.draw_column(&mut canvas, corner, column as usize);
            if column % band == 0 {
                self.draw_names(&mut canvas, corner[1] + LINE, height);
            }
        }
        self.draw_legend(&mut canvas, [left, bottom], width);
        canvas.finish()
    }

    fn draw_column(&self, canvas: &mut Canvas, [x, y]: [u32; 2], column: usize) {
        let pictures = || self.rows.iter().filter_map(|(_, pictures)| pictures.get(column));
        let middle = x + pictures().next().map_or(0, |picture| picture.size[0] / 2);
        canvas.text_centred([middle, y + GAP / 2], &self.heads[column], SCALE, INK);
        let mut y = y + LINE;
        for picture in pictures() {
            canvas.picture([x, y], picture);
            y += picture.size[1] + GAP;
        }
        canvas.text_centred([middle, y], &self.feet[column], SCALE, INK);
    }

    fn draw_names(&self, canvas: &mut Canvas, top: u32, height: u32) {
        for (i, (name, _)) in self.rows.iter().enumerate() {
            let y = top + i as u32 * (height + GAP) + height / 2;
            canvas.text([GAP, y.saturating_sub(CELL[1])], name, SCALE, INK);
        }
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
    fn a_table_holds_every_picture_in_bands() {
        let row = |shade: u8| (0..5).map(|_| Raster::filled([50, 20], [shade, 0, 200])).collect::<Vec<_>>();
        let table = PictureTable {
            title: vec!["title".into()],
            rows: vec![("first".into(), row(1)), ("second".into(), row(2))],
            heads: vec!["head".into(); 5],
            feet: vec!["foot".into(); 5],
            band: 3,
            legend: (["0".into(), "1".into()], "words".into()),
            legend_color: heat,
        };
        let sheet = table.draw();
        let count = |color: [u8; 3]| sheet.pixels.iter().filter(|p| **p == color).count();
        assert_eq!((count([1, 0, 200]), count([2, 0, 200])), (5000, 5000));
    }

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
