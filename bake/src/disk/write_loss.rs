//! A page's lost minutes as files: a picture for the eye, an OpenEXR of two channels for programs.

use super::exr_file::write_exr;
use super::manifest::LossMapEntry;
use super::write::{SetWriter, WriteError};
use crate::loss_map::LossMap;
use std::io::{Result, Seek, Write};

impl SetWriter {
    /// Writes where page `index` lost minutes and says what the manifest should say of it.
    pub fn write_loss_map(&mut self, index: usize, map: &LossMap) -> std::result::Result<LossMapEntry, WriteError> {
        let [picture, numbers] = ["png", "exr"].map(|kind| format!("lost_minutes.{index}.{kind}"));
        self.write_file(&picture, |file| write_picture(map, file))?;
        self.write_file(&numbers, |file| write_numbers(map, file))?;
        Ok(LossMapEntry { picture, numbers, scale: "sqrt".into(), scale_max_min: map.scale_max_min() })
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
