//! The pictures of a report, small enough to be part of its page.
//!
//! A page with a colour picture for each technique, camera and time would have hundreds of megabytes. All techniques
//! shade alike, and light is linear in the visibility of the sun. So a frame needs two colour pictures, with the sun
//! hidden and with the sun seen everywhere, and a grey one for each technique. The browser puts them together.

use super::super::comparison::{LitFrame, Outcome, visibility_codes};
use crate::image::Raster;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::Vec3;
use image::codecs::jpeg::JpegEncoder;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder, ImageError};
use rayon::prelude::*;
use serde::Serialize;

/// Quality of colour pictures, 1 to 100.
const QUALITY: u8 = 88;
/// Light beyond this is white on any display.
const BRIGHTEST: f32 = 16.0;

/// All pictures of a report.
#[derive(Debug, Clone, Serialize)]
pub struct Pictures {
    /// Width and height of each, in pixels.
    pub size: [u32; 2],
    /// All cameras at the first time, then at the next.
    pub frames: Vec<FramePictures>,
}

/// The pictures of a frame, as `data:` addresses.
#[derive(Debug, Clone, Serialize)]
pub struct FramePictures {
    /// Index of the camera.
    pub camera: usize,
    /// Index of the time.
    pub time: usize,
    /// Linear light of a code q of `dark` and `open` is `scale (q / 255)^2`.
    pub scale: f32,
    /// The scene with the sun hidden: JPEG.
    pub dark: String,
    /// The scene with the sun seen everywhere: JPEG.
    pub open: String,
    /// Visibility of the sun by the reference: grey PNG.
    pub reference: String,
    /// Visibility of the sun by each technique: grey PNG.
    pub seen: Vec<String>,
}

impl Pictures {
    /// Encodes the pictures of a comparison.
    pub fn new(outcome: &Outcome) -> Result<Self, ImageError> {
        let size = outcome.frames.first().map_or([0, 0], |frame| frame.without_sun.size);
        let frame = |(i, frame): (usize, &LitFrame)| {
            let brightest =
                frame.full_sun.pixels.iter().chain(&frame.without_sun.pixels).map(|light| light.max_element());
            let scale = brightest.filter(|light| light.is_finite()).fold(1e-3, f32::max).min(BRIGHTEST);
            Ok(FramePictures {
                camera: frame.camera,
                time: frame.time,
                scale,
                dark: color(&frame.without_sun, scale)?,
                open: color(&frame.full_sun, scale)?,
                reference: grey(&visibility_codes(&frame.reference))?,
                seen: outcome.visibility.iter().map(|seen| grey(&seen[i])).collect::<Result<_, ImageError>>()?,
            })
        };
        let frames = outcome.frames.par_iter().enumerate().map(frame).collect::<Result<_, ImageError>>()?;
        Ok(Self { size, frames })
    }
}

/// Linear light as codes of its square root: finer steps in the dark, where the eye sees them.
fn color(light: &Raster<Vec3>, scale: f32) -> Result<String, ImageError> {
    let code = |light: f32| ((light / scale).clamp(0.0, 1.0).sqrt() * 255.0).round() as u8;
    let bytes: Vec<u8> = light.pixels.iter().flat_map(|light| light.to_array().map(code)).collect();
    let mut file = Vec::new();
    JpegEncoder::new_with_quality(&mut file, QUALITY).write_image(
        &bytes,
        light.size[0],
        light.size[1],
        ExtendedColorType::Rgb8,
    )?;
    Ok(address("image/jpeg", &file))
}

fn grey(codes: &Raster<u8>) -> Result<String, ImageError> {
    let mut file = Vec::new();
    let encoder = PngEncoder::new_with_quality(&mut file, CompressionType::Best, FilterType::Adaptive);
    encoder.write_image(&codes.pixels, codes.size[0], codes.size[1], ExtendedColorType::L8)?;
    Ok(address("image/png", &file))
}

fn address(kind: &str, file: &[u8]) -> String {
    format!("data:{kind};base64,{}", STANDARD.encode(file))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decoded(address: &str) -> image::DynamicImage {
        let bytes = STANDARD.decode(address.split_once(',').unwrap().1).unwrap();
        image::load_from_memory(&bytes).unwrap()
    }

    #[test]
    fn grey_pictures_come_back_code_for_code() {
        let codes = Raster { size: [16, 16], pixels: (0..=255).collect::<Vec<u8>>() };
        assert_eq!(decoded(&grey(&codes).unwrap()).to_luma8().into_raw(), codes.pixels);
    }

    #[test]
    fn light_comes_back_as_nearly_as_a_display_could_tell() {
        let light = Raster::filled([16, 16], Vec3::new(0.2, 0.6, 1.7));
        let picture = decoded(&color(&light, 2.0).unwrap()).to_rgb8();
        let back = picture.get_pixel(7, 9).0.map(|code| 2.0 * (f32::from(code) / 255.0).powi(2));
        assert!(Vec3::from(back).abs_diff_eq(light.pixels[0], 0.03), "{back:?}");
    }
}
