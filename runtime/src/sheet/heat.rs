//! Differences as colours.

pub use sunbake::heat::heat;

use crate::image::Raster;
use crate::texture::srgb_from_linear;

/// A picture of differences from 0 to 1. The sRGB curve brightens small ones, so that they can be seen.
pub fn heat_map(difference: &Raster<f32>) -> Raster<[u8; 3]> {
    let color = |&d: &f32| heat(if d.is_nan() { 1.0 } else { srgb_from_linear(d.clamp(0.0, 1.0)) });
    Raster { size: difference.size, pixels: difference.pixels.iter().map(color).collect() }
}
