//! From linear light to a display's codes.
//!
//! The curve is a rational fit of a film's response, after Krzysztof Narkowicz ("ACES filmic tone mapping curve",
//! 2016), scaled so that middle grey is kept. Very bright colours turn towards white, as on film, instead of clipping
//! channel by channel.

use super::LUMINANCE;
use crate::image::Raster;
use crate::texture::srgb_from_linear;
use glam::Vec3;

/// Scale of light before the curve.
const EXPOSURE: f32 = 0.62;

/// Display-linear RGB in [0, 1] for linear light.
pub fn display_from_light(light: Vec3) -> Vec3 {
    let light = light.max(Vec3::ZERO) * EXPOSURE;
    let bright = light.dot(LUMINANCE);
    let whiter = light.lerp(Vec3::splat(bright), bright / (bright + 6.0));
    let x = whiter;
    ((x * (x * 2.51 + 0.03)) / (x * (x * 2.43 + 0.59) + 0.14)).clamp(Vec3::ZERO, Vec3::ONE)
}

/// sRGB codes for display-linear RGB.
pub fn codes_from_display(display: Vec3) -> [u8; 3] {
    display.to_array().map(|x| (srgb_from_linear(x.clamp(0.0, 1.0)) * 255.0).round() as u8)
}

/// sRGB codes of a picture in linear light: the mean of `supersample` squared samples a pixel, taken after the tone
/// curve, so that one bright sample does not outshine a pixel.
pub fn displayed(light: &Raster<Vec3>, supersample: u32) -> Raster<[u8; 3]> {
    let display = Raster { size: light.size, pixels: light.pixels.iter().map(|&l| display_from_light(l)).collect() };
    let reduced = display.reduced(supersample);
    Raster { size: reduced.size, pixels: reduced.pixels.iter().map(|&d| codes_from_display(d)).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_climbs_from_black_to_white_and_keeps_grey_grey() {
        let curve: Vec<Vec3> = (0..200).map(|i| display_from_light(Vec3::splat(i as f32 * 0.05))).collect();
        assert!(curve.windows(2).all(|w| w[1].x >= w[0].x));
        assert!(curve[0] == Vec3::ZERO && curve[199].x > 0.95);
        assert!(curve.iter().all(|c| (c.x - c.z).abs() < 1e-6));
        assert_eq!(codes_from_display(Vec3::ONE), [255; 3]);
    }
}
