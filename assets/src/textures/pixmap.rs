//! Pictures and their PNG files.

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};

/// An sRGB colour, each channel from 0 to 1.
pub(crate) type Rgb = [f64; 3];

/// An 8-bit picture, rows from the top, with or without alpha.
pub(crate) struct Pixmap {
    width: u32,
    height: u32,
    bytes: Vec<u8>,
    color: ExtendedColorType,
}

fn byte(channel: f64) -> u8 {
    (channel.clamp(0.0, 1.0) * 255.0).round() as u8
}

impl Pixmap {
    /// Paints an opaque picture. `color` gets u to the right and v downwards, both in (0, 1).
    pub(crate) fn paint(width: u32, height: u32, color: impl Fn(f64, f64) -> Rgb) -> Self {
        let bytes = pixels(width, height).flat_map(|(u, v)| color(u, v).map(byte)).collect();
        Self { width, height, bytes, color: ExtendedColorType::Rgb8 }
    }

    /// Paints a picture with alpha.
    pub(crate) fn paint_alpha(width: u32, height: u32, color: impl Fn(f64, f64) -> [f64; 4]) -> Self {
        let bytes = pixels(width, height).flat_map(|(u, v)| color(u, v).map(byte)).collect();
        Self { width, height, bytes, color: ExtendedColorType::Rgba8 }
    }

    /// The picture as a PNG file.
    pub(crate) fn png(&self) -> Vec<u8> {
        let mut file = Vec::new();
        PngEncoder::new_with_quality(&mut file, CompressionType::Best, FilterType::Adaptive)
            .write_image(&self.bytes, self.width, self.height, self.color)
            .expect("a picture in memory has the size it says");
        file
    }
}

fn pixels(width: u32, height: u32) -> impl Iterator<Item = (f64, f64)> {
    let at = |k: u32, n: u32| (f64::from(k) + 0.5) / f64::from(n);
    (0..height).flat_map(move |y| (0..width).map(move |x| (at(x, width), at(y, height))))
}

/// Blends two colours; `t` = 0 is `a`.
pub(crate) fn blend(a: Rgb, b: Rgb, t: f64) -> Rgb {
    std::array::from_fn(|k| a[k] + (b[k] - a[k]) * t.clamp(0.0, 1.0))
}

/// Scales a colour's brightness.
pub(crate) fn shade(color: Rgb, factor: f64) -> Rgb {
    color.map(|c| c * factor)
}
