//! Codes as a PNG file.

use crate::maps::Bits;
use std::io::{Result, Write};

/// Writes a PNG with fast compression. `size` is width and height in texels; `bytes` has one byte for each channel of a
/// texel, or two with the higher first.
pub(super) fn write_png(
    bytes: &[u8],
    color: png::ColorType,
    size: (u32, u32),
    bits: Bits,
    file: impl Write,
) -> Result<()> {
    let mut encoder = png::Encoder::new(file, size.0, size.1);
    encoder.set_color(color);
    encoder.set_depth(match bits {
        Bits::Eight => png::BitDepth::Eight,
        Bits::Sixteen => png::BitDepth::Sixteen,
    });
    encoder.set_compression(png::Compression::Fast);
    encoder.set_filter(png::Filter::Up);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(bytes)?;
    Ok(writer.finish()?)
}
