//! Planes of numbers as an OpenEXR file of 32-bit floats.

use std::io::{Error, Result, Seek, Write};

/// Writes one channel for each name and plane, all of `size` (width and height in pixels), rows from the top.
#[cfg(feature = "exr")]
pub fn write_exr(size: [u32; 2], channels: Vec<(String, Vec<f32>)>, file: impl Write + Seek) -> Result<()> {
    use exr::prelude::{AnyChannel, AnyChannels, FlatSamples, Image, WritableImage};
    let channel = |(name, plane): (String, Vec<f32>)| AnyChannel::new(name.as_str(), FlatSamples::F32(plane));
    let channels = AnyChannels::sort(channels.into_iter().map(channel).collect());
    let image = Image::from_channels((size[0] as usize, size[1] as usize), channels);
    // On this thread: a bake takes no more threads than it was given.
    image.write().non_parallel().to_buffered(file).map_err(Error::other)
}

/// Refuses: OpenEXR is not compiled in.
#[cfg(not(feature = "exr"))]
pub fn write_exr(_size: [u32; 2], _channels: Vec<(String, Vec<f32>)>, _file: impl Write + Seek) -> Result<()> {
    Err(Error::from(std::io::ErrorKind::Unsupported))
}
