//! A page's lost minutes as files: a picture for the eye, an OpenEXR of two channels for programs.

use super::manifest::LossMapEntry;
use super::write::{SetWriter, WriteError};
use crate::loss_map::LossMap;
use exr::prelude::{AnyChannel, AnyChannels, FlatSamples, Image, WritableImage};
use std::io::{Error, Result, Seek, Write};

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
    let channel = |name: &str, minutes| AnyChannel::new(name, FlatSamples::F32(minutes));
    let channels = [channel("layers", map.by_layers_min()), channel("bits", map.by_bits_min())];
    let size = (map.width as usize, map.height as usize);
    let image = Image::from_channels(size, AnyChannels::sort(channels.into_iter().collect()));
    // On this thread: a bake takes no more threads than it was given.
    image.write().non_parallel().to_buffered(file).map_err(Error::other)
}
