//! Pictures into files.

use glam::Vec3;
use std::path::Path;
use sunbake::console::Failure;
use sunbake_runtime::Raster;
use sunbake_runtime::light::displayed;

/// Kinds of file, by their ending.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// `.png`.
    Png,
    /// `.exr`.
    Exr,
}

/// The kind that a file's ending asks for.
pub fn kind(path: &Path) -> Result<Kind, Failure> {
    let ending = path.extension().map(|e| e.to_ascii_lowercase());
    match ending.as_deref().and_then(|e| e.to_str()) {
        Some("png") => Ok(Kind::Png),
        Some("exr") => Ok(Kind::Exr),
        _ => Err(Failure::usage(format!("cannot tell the kind of {}: name it .png or .exr", path.display()))),
    }
}

/// What seconds of drawing were spent on: so many samples along each edge of a pixel.
pub fn in_words(samples: u32) -> String {
    match samples {
        1 => "1 sample a pixel".into(),
        n => format!("{} samples a pixel", n * n),
    }
}

/// Writes a picture in colour.
pub fn write_color(path: &Path, light: &Raster<Vec3>, supersample: u32) -> Result<(), Failure> {
    match kind(path)? {
        Kind::Png => write_rgb(path, &displayed(light, supersample)),
        Kind::Exr => {
            let light = light.reduced(supersample);
            let channel = |axis: usize| light.pixels.iter().map(|l| l[axis]).collect();
            write_exr(path, light.size, [("R", channel(0)), ("G", channel(1)), ("B", channel(2))])
        }
    }
}

/// Writes visibility as grey, averaged over blocks of `supersample` pixels.
pub fn write_visibility(path: &Path, visibility: &Raster<f32>, supersample: u32) -> Result<(), Failure> {
    let visibility = visibility.reduced(supersample);
    match kind(path)? {
        Kind::Png => {
            let codes = visibility.pixels.iter().map(|v| (v.clamp(0.0, 1.0) * 65_535.0).round() as u16);
            let bytes: Vec<u8> = codes.flat_map(u16::to_be_bytes).collect();
            write_png(path, visibility.size, png::ColorType::Grayscale, png::BitDepth::Sixteen, &bytes)
        }
        Kind::Exr => write_exr(path, visibility.size, [("Y", visibility.pixels)]),
    }
}

/// Writes a picture of sRGB codes.
pub fn write_rgb(path: &Path, picture: &Raster<[u8; 3]>) -> Result<(), Failure> {
    write_png(path, picture.size, png::ColorType::Rgb, png::BitDepth::Eight, picture.pixels.as_flattened())
}

/// Grey sRGB codes of visibility, as sheets and animations show it: full sun is white.
pub fn displayed_visibility(visibility: &Raster<f32>, supersample: u32) -> Raster<[u8; 3]> {
    let reduced = visibility.reduced(supersample);
    let grey = |&v: &f32| [(v.clamp(0.0, 1.0) * 255.0).round() as u8; 3];
    Raster { size: reduced.size, pixels: reduced.pixels.iter().map(grey).collect() }
}

/// Makes a folder, and those above it.
pub fn make_folder(folder: &Path) -> Result<(), Failure> {
    std::fs::create_dir_all(folder).map_err(|e| cannot_write(folder, &e))
}

fn write_exr<const N: usize>(path: &Path, size: [u32; 2], channels: [(&str, Vec<f32>); N]) -> Result<(), Failure> {
    let channels = channels.into_iter().map(|(name, samples)| (name.to_owned(), samples)).collect();
    let write = || sunbake::disk::write_exr(size, channels, std::io::BufWriter::new(std::fs::File::create(path)?));
    write().map_err(|e| cannot_write(path, &e))
}

fn write_png(
    path: &Path,
    size: [u32; 2],
    color: png::ColorType,
    depth: png::BitDepth,
    bytes: &[u8],
) -> Result<(), Failure> {
    let write = || encode_png(std::io::BufWriter::new(std::fs::File::create(path)?), size, color, depth, bytes);
    write().map_err(|e| cannot_write(path, &e))
}

/// The file of a picture of sRGB codes.
pub fn png_bytes(picture: &Raster<[u8; 3]>) -> Result<Vec<u8>, png::EncodingError> {
    let mut file = Vec::new();
    let codes = picture.pixels.as_flattened();
    encode_png(&mut file, picture.size, png::ColorType::Rgb, png::BitDepth::Eight, codes)?;
    Ok(file)
}

fn encode_png(
    file: impl std::io::Write,
    size: [u32; 2],
    color: png::ColorType,
    depth: png::BitDepth,
    bytes: &[u8],
) -> Result<(), png::EncodingError> {
    let mut encoder = png::Encoder::new(file, size[0], size[1]);
    encoder.set_color(color);
    encoder.set_depth(depth);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(bytes)?;
    writer.finish()
}

/// A file that cannot be written.
pub fn cannot_write(path: &Path, reason: &dyn std::fmt::Display) -> Failure {
    Failure::io(format!("cannot write {}: {reason}; choose another place with -o", path.display()))
}

/// Writes pictures as an animated PNG that plays for ever, `delay_ms` each.
pub fn write_animation(path: &Path, pictures: &[Raster<[u8; 3]>], delay_ms: u16) -> Result<(), Failure> {
    let Some(size) = pictures.first().map(|picture| picture.size) else { return Ok(()) };
    let write = || -> Result<(), png::EncodingError> {
        let file = std::io::BufWriter::new(std::fs::File::create(path)?);
        let mut encoder = png::Encoder::new(file, size[0], size[1]);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_animated(pictures.len() as u32, 0)?;
        encoder.set_frame_delay(delay_ms, 1000)?;
        let mut writer = encoder.write_header()?;
        for picture in pictures {
            writer.write_image_data(picture.pixels.as_flattened())?;
        }
        writer.finish()
    };
    write().map_err(|e| cannot_write(path, &e))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn visibility_survives_both_kinds_of_file() {
        let folder = std::env::temp_dir().join(format!("sunplay-files-{}", std::process::id()));
        make_folder(&folder).unwrap();
        let seen = Raster { size: [3, 2], pixels: vec![0.0, 0.25, 1.0, 0.5, 0.125, 0.75] };
        let [exr, png] = ["v.exr", "v.png"].map(|name| folder.join(name));
        write_visibility(&exr, &seen, 1).unwrap();
        write_visibility(&png, &seen, 1).unwrap();
        let image = exr::prelude::read_first_flat_layer_from_file(&exr).unwrap();
        let channel = &image.layer_data.channel_data.list[0];
        assert_eq!(channel.name.to_string(), "Y");
        assert_eq!(channel.sample_data.values_as_f32().collect::<Vec<_>>(), seen.pixels);
        let mut reader =
            png::Decoder::new(std::io::BufReader::new(std::fs::File::open(&png).unwrap())).read_info().unwrap();
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut bytes).unwrap();
        let codes: Vec<u16> = bytes.chunks_exact(2).map(|b| u16::from_be_bytes([b[0], b[1]])).collect();
        assert_eq!(codes, [0, 16_384, 65_535, 32_768, 8192, 49_151]);
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn other_endings_are_refused() {
        assert_eq!((kind(Path::new("a.PNG")).unwrap(), kind(Path::new("a.exr")).unwrap()), (Kind::Png, Kind::Exr));
        assert!(["a.jpg", "a", ".png/"].iter().all(|name| kind(Path::new(name)).is_err_and(|e| e.code == 1)));
    }
}
