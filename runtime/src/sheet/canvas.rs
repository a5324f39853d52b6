//! A picture on which pictures and text are drawn.

use super::font::{CELL, glyph, text_width};
use crate::image::Raster;
use crate::light::codes_from_display;
use crate::texture::linear_from_srgb;
use glam::Vec3;

/// Colour of the background, sRGB.
pub const PAPER: [u8; 3] = [24, 24, 26];
/// Colour of text, sRGB.
pub const INK: [u8; 3] = [236, 232, 224];
/// Colour of less important text, sRGB.
pub const QUIET_INK: [u8; 3] = [156, 152, 146];

/// A sheet while it is drawn.
pub struct Canvas {
    picture: Raster<[u8; 3]>,
}

impl Canvas {
    /// A sheet that is all background, in pixels.
    pub fn new(size: [u32; 2]) -> Self {
        Self { picture: Raster::filled(size, PAPER) }
    }

    /// The sheet as it has been drawn.
    pub fn finish(self) -> Raster<[u8; 3]> {
        self.picture
    }

    /// Fills a rectangle, clipped to the sheet.
    pub fn rectangle(&mut self, [x, y]: [u32; 2], [width, height]: [u32; 2], color: [u8; 3]) {
        let [sheet_width, sheet_height] = self.picture.size;
        for row in y..(y + height).min(sheet_height) {
            for column in x..(x + width).min(sheet_width) {
                self.picture.pixels[row as usize * sheet_width as usize + column as usize] = color;
            }
        }
    }

    /// Draws a picture with its upper left corner at a point.
    pub fn picture(&mut self, [x, y]: [u32; 2], picture: &Raster<[u8; 3]>) {
        for row in 0..picture.size[1] {
            for column in 0..picture.size[0] {
                self.rectangle([x + column, y + row], [1, 1], *picture.at(column, row));
            }
        }
    }

    /// Writes a line of text; each pixel of the font becomes `scale` pixels.
    pub fn text(&mut self, [x, y]: [u32; 2], text: &str, scale: u32, ink: [u8; 3]) {
        for (i, character) in text.chars().enumerate() {
            let left = x + i as u32 * (CELL[0] + 1) * scale;
            for (column, bits) in glyph(character).into_iter().enumerate() {
                for row in (0..CELL[1]).filter(|row| bits >> row & 1 == 1) {
                    self.rectangle([left + column as u32 * scale, y + row * scale], [scale, scale], ink);
                }
            }
        }
    }

    /// Writes a line of text, centred on a point.
    pub fn text_centred(&mut self, [middle, y]: [u32; 2], text: &str, scale: u32, ink: [u8; 3]) {
        self.text([middle.saturating_sub(text_width(text, scale) / 2), y], text, scale, ink);
    }
}

/// A picture made smaller by a whole number, so that it is no wider than `width` pixels. Linear light is averaged, not
/// sRGB codes.
pub fn thumbnail(picture: &Raster<[u8; 3]>, width: u32) -> Raster<[u8; 3]> {
    let shrink = picture.size[0].div_ceil(width.max(1)).min(picture.size[1]).max(1);
    let light = |code: &[u8; 3]| Vec3::from_array(code.map(linear_from_srgb));
    let display = Raster { size: picture.size, pixels: picture.pixels.iter().map(light).collect() }.reduced(shrink);
    Raster { size: display.size, pixels: display.pixels.iter().map(|&d| codes_from_display(d)).collect() }
}
