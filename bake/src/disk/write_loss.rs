//! Writes a page's loss map: a picture to look at, and an OpenEXR file with two channels for programs.

use super::exr_file::write_exr;
use super::manifest::LossMapEntry;
use super::write::{SetWriter, WriteError};
use crate::loss_map::LossMap;
use std::io::{Result, Seek, Write};

impl SetWriter {
    /// Writes where a page lost minutes.
    pub(super) fn write_loss_map(
        &mut self,
        names: &LossMapEntry,
        map: &LossMap,
    ) -> std::result::Result<(), WriteError> {
        self.write_file(&names.picture, |file| write_picture(map, file))?;
        self.write_file(&names.numbers, |file| write_numbers(map, file))
    }
}

fn write_picture(map: &LossMap, file: impl Write) -> Result<()> {
    let mut encoder = png::Encoder::new(file, map.width, map.height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(map.picture().as_flattened())?;
    Ok(writer.finish()?)
}

fn write_numbers(map: &LossMap, file: impl Write + Seek) -> Result<()> {
    let channels = vec![("layers".into(), map.by_layers_min()), ("bits".into(), map.by_bits_min())];
    write_exr([map.width, map.height], channels, file)
}
