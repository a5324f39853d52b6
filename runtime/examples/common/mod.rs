//! What the examples share: writing pictures to files.

use std::path::Path;
use sunbake_runtime::Raster;

/// Any error.
pub type Anything = Box<dyn std::error::Error>;

/// Writes a picture of sRGB codes as a PNG, as small as it gets.
pub fn write(file: &Path, picture: &Raster<[u8; 3]>) -> Result<(), Anything> {
    let mut encoder =
        png::Encoder::new(std::io::BufWriter::new(std::fs::File::create(file)?), picture.size[0], picture.size[1]);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::High);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(picture.pixels.as_flattened())?;
    Ok(writer.finish()?)
}
