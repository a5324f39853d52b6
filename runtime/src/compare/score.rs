//! The errors of a technique against the reference, in a few numbers.
//!
//! Only pixels that show a surface count; otherwise the mean would depend on how much sky a camera sees. The *penumbra*
//! is where the reference is neither lit nor dark; an error outside of it is a shadow in the wrong place, or a missing
//! one. *False light* is what shines through walls, where the reference is all dark; *false shade* darkens what it
//! shows in full light. Structural similarity (Wang et al., "Image quality assessment: from error visibility to
//! structural similarity", *IEEE Transactions on Image Processing* 13, 2004) is taken of the lit pictures' luma as a
//! display shows them, over windows of eight by eight pixels. NaN counts as an error of 1, and such pixels are counted.

use crate::image::Raster;
use crate::light::{LUMINANCE, codes_from_display, display_from_light};
use glam::Vec3;
use image_compare::{Algorithm, gray_similarity_structure};
use serde::{Deserialize, Serialize};
use sunbake::statistics::percentile;

/// A pixel with a larger error is wrong: lit where it is dark, or dark where it is lit.
pub const WRONG: f32 = 0.5;
/// Visibility of the sun by the reference in its penumbras, from the least to the most.
pub const PENUMBRA: [f32; 2] = [0.02, 0.98];

/// Errors of visibility, 0 to 1, over pixels that show a surface.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Score {
    /// Pixels compared.
    pub pixels: u64,
    /// Mean error.
    pub mean: f64,
    /// Root of the mean of its squares: large where few pixels are far off.
    pub rms: f64,
    /// The error that 99 in 100 pixels do not exceed.
    pub p99: f64,
    /// The largest error.
    pub worst: f64,
    /// Share of pixels with an error above a half.
    pub wrong_share: f64,
    /// Light where the reference has none: the mean visibility of pixels that are dark in it; null where none is.
    pub false_light: Option<f64>,
    /// Shade where the reference has none: the mean of 1 less the visibility of pixels that are lit in it; null where
    /// none is.
    pub false_shade: Option<f64>,
    /// Mean error where the reference sees from 2 to 98 hundredths of the sun; null where it has no such pixel.
    pub penumbra: Option<f64>,
    /// Mean error everywhere else.
    pub outside: f64,
    /// Share of pixels in the reference's penumbras.
    pub penumbra_share: f64,
    /// Mean structural similarity of the lit pictures, 1 for equal ones.
    pub ssim: f64,
    /// Pixels whose visibility is NaN; each counts as an error of 1.
    pub not_numbers: u64,
}

/// Errors of one or more pictures, gathered.
#[derive(Debug, Clone, Default)]
pub struct Tally {
    errors: Vec<f32>,
    in_penumbra: (f64, u64),
    outside: (f64, u64),
    in_shade: (f64, u64),
    in_light: (f64, u64),
    not_numbers: u64,
    ssim: (f64, u64),
}

impl Tally {
    /// Adds the errors of a picture of visibility, where `shows_surface`.
    pub fn add(&mut self, visibility: &Raster<f32>, reference: &Raster<f32>, shows_surface: impl Fn(usize) -> bool) {
        for (i, (&visibility, &reference)) in visibility.pixels.iter().zip(&reference.pixels).enumerate() {
            if !shows_surface(i) {
                continue;
            }
            let is_number = !(visibility - reference).is_nan();
            self.not_numbers += u64::from(!is_number);
            let error = if is_number { (visibility - reference).abs() } else { 1.0 };
            self.errors.push(error);
            let is_penumbra = (PENUMBRA[0]..=PENUMBRA[1]).contains(&reference);
            let part = if is_penumbra { &mut self.in_penumbra } else { &mut self.outside };
            *part = (part.0 + f64::from(error), part.1 + 1);
            for (part, whole) in [(&mut self.in_shade, 0.0), (&mut self.in_light, 1.0)] {
                if reference == whole {
                    *part = (part.0 + f64::from(error), part.1 + 1);
                }
            }
        }
    }

    /// Adds the structural similarity of two lit pictures.
    pub fn add_similarity(&mut self, ssim: f64) {
        self.ssim = (self.ssim.0 + ssim, self.ssim.1 + 1);
    }

    /// Adds what another tally has gathered.
    pub fn append(&mut self, other: &Self) {
        let sum = |a: (f64, u64), b: (f64, u64)| (a.0 + b.0, a.1 + b.1);
        self.errors.extend_from_slice(&other.errors);
        self.in_penumbra = sum(self.in_penumbra, other.in_penumbra);
        self.outside = sum(self.outside, other.outside);
        self.in_shade = sum(self.in_shade, other.in_shade);
        self.in_light = sum(self.in_light, other.in_light);
        self.ssim = sum(self.ssim, other.ssim);
        self.not_numbers += other.not_numbers;
    }

    /// Means and extremes of all pixels that were added.
    pub fn score(&self) -> Score {
        let count = self.errors.len();
        let mean = |(sum, count): (f64, u64)| if count == 0 { 0.0 } else { sum / count as f64 };
        let all = (self.in_penumbra.0 + self.outside.0, self.in_penumbra.1 + self.outside.1);
        let share = |part: u64| part as f64 / count.max(1) as f64;
        let squares = self.errors.iter().map(|&error| f64::from(error).powi(2)).sum::<f64>();
        let wrong = self.errors.iter().filter(|&&error| error > WRONG).count() as u64;
        Score {
            pixels: count as u64,
            mean: mean(all),
            rms: (squares / count.max(1) as f64).sqrt(),
            p99: percentile(&mut self.errors.clone(), 99, f32::total_cmp).map_or(0.0, f64::from),
            worst: f64::from(self.errors.iter().copied().fold(0.0, f32::max)),
            wrong_share: share(wrong),
            false_light: (self.in_shade.1 > 0).then(|| mean(self.in_shade)),
            false_shade: (self.in_light.1 > 0).then(|| mean(self.in_light)),
            penumbra: (self.in_penumbra.1 > 0).then(|| mean(self.in_penumbra)),
            outside: mean(self.outside),
            penumbra_share: share(self.in_penumbra.1),
            ssim: if self.ssim.1 == 0 { 1.0 } else { mean(self.ssim) },
            not_numbers: self.not_numbers,
        }
    }
}

/// The luma of a lit picture, as a display shows it.
pub fn luma(light: &Raster<Vec3>) -> Raster<u8> {
    let grey = |light: &Vec3| {
        let codes = codes_from_display(display_from_light(*light)).map(f32::from);
        Vec3::from(codes).dot(LUMINANCE).round() as u8
    };
    Raster { size: light.size, pixels: light.pixels.iter().map(grey).collect() }
}

/// Structural similarity of two pictures: 1 for equal ones; 0 also for pictures of different sizes, or without a pixel.
pub fn structural_similarity(a: &Raster<u8>, b: &Raster<u8>) -> f64 {
    let grey = |picture: &Raster<u8>| {
        let [width, height] = picture.size;
        image::GrayImage::from_raw(width, height, picture.pixels.clone())
    };
    let found = grey(a).zip(grey(b)).map(|(a, b)| gray_similarity_structure(&Algorithm::MSSIMSimple, &a, &b));
    found.and_then(Result::ok).map_or(0.0, |found| found.score)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scored(visibility: &[f32], reference: &[f32]) -> Score {
        let raster = |pixels: &[f32]| Raster { size: [pixels.len() as u32, 1], pixels: pixels.to_vec() };
        let mut tally = Tally::default();
        tally.add(&raster(visibility), &raster(reference), |_| true);
        tally.score()
    }

    #[test]
    fn the_numbers_are_those_of_a_list_that_one_can_add_up() {
        let found = scored(&[1.0, 0.25, 0.0, 0.75], &[1.0, 0.5, 1.0, 1.0]);
        assert_eq!((found.pixels, found.mean, found.worst, found.wrong_share), (4, 0.375, 1.0, 0.25));
        assert!((found.rms - (1.125f64 / 4.0).sqrt()).abs() < 1e-9);
        assert_eq!((found.penumbra, found.penumbra_share), (Some(0.25), 0.25));
        assert!((found.outside - 1.25 / 3.0).abs() < 1e-9);
        let ramp: Vec<f32> = (1..=1000).map(|i| i as f32 / 1000.0).collect();
        assert!((scored(&ramp, &[0.0; 1000]).p99 - 0.99).abs() < 1e-6);
    }

    #[test]
    fn what_is_compared_with_itself_is_all_zeros() {
        let same = [0.0, 0.3, 1.0];
        let [false_light, false_shade, penumbra] = [Some(0.0); 3];
        let expected = Score {
            pixels: 3,
            false_light,
            false_shade,
            penumbra,
            penumbra_share: 1.0 / 3.0,
            ssim: 1.0,
            ..Score::default()
        };
        assert_eq!(scored(&same, &same), expected);
        assert_eq!(Tally::default().score(), Score { ssim: 1.0, ..Score::default() });
    }

    #[test]
    fn one_corrupted_pixel_moves_every_number_that_it_should() {
        let mut visibility = [1.0; 50];
        visibility[7] = 0.4;
        let found = scored(&visibility, &[1.0; 50]);
        assert!((found.mean - 0.012).abs() < 1e-6 && (found.worst - 0.6).abs() < 1e-6);
        assert_eq!((found.wrong_share, found.penumbra), (0.02, None));
        visibility[7] = f32::NAN;
        let found = scored(&visibility, &[1.0; 50]);
        assert_eq!((found.not_numbers, found.worst, found.wrong_share), (1, 1.0, 0.02));
    }

    /// B6: a leak of less than a half is no wrong pixel, and is told all the same.
    #[test]
    fn light_in_the_shade_and_shade_in_the_light_are_told_apart() {
        let leak = scored(&[0.4, 0.2, 0.9, 1.0], &[0.0, 0.0, 1.0, 0.5]);
        assert!((leak.false_light.unwrap() - 0.3).abs() < 1e-6 && (leak.false_shade.unwrap() - 0.1).abs() < 1e-6);
        assert_eq!(leak.wrong_share, 0.0);
        let dark = scored(&[0.0; 2], &[0.0; 2]);
        assert_eq!((dark.false_light, dark.false_shade), (Some(0.0), None));
    }

    #[test]
    fn pixels_that_show_no_surface_do_not_count() {
        let raster = |pixels: [f32; 2]| Raster { size: [2, 1], pixels: pixels.to_vec() };
        let mut tally = Tally::default();
        tally.add(&raster([0.0, 0.5]), &raster([1.0, 0.5]), |i| i == 1);
        assert_eq!((tally.score().pixels, tally.score().mean), (1, 0.0));
    }

    #[test]
    fn what_is_added_in_parts_is_what_is_added_at_once() {
        let [a, b] = [[0.2, 0.9, f32::NAN], [1.0, 0.1, 0.0]].map(|p| Raster { size: [3, 1], pixels: p.to_vec() });
        let lit = Raster::filled([3, 1], 0.6);
        let (mut whole, mut parts) = (Tally::default(), Tally::default());
        for picture in [&a, &b] {
            whole.add(picture, &lit, |_| true);
            let mut part = Tally::default();
            part.add(picture, &lit, |_| true);
            part.add_similarity(0.5);
            whole.add_similarity(0.5);
            parts.append(&part);
        }
        assert_eq!(whole.score(), parts.score());
    }

    #[test]
    fn similarity_falls_with_what_is_changed() {
        let ramp = Raster { size: [32, 32], pixels: (0..1024u32).map(|i| (i % 32 * 8) as u8).collect::<Vec<u8>>() };
        let mut patched = ramp.clone();
        patched.pixels[..96].fill(255);
        let (same, changed) = (structural_similarity(&ramp, &ramp), structural_similarity(&ramp, &patched));
        assert!((same - 1.0).abs() < 1e-9 && changed < 0.97 && changed > 0.3, "{same} {changed}");
        assert_eq!(structural_similarity(&ramp, &Raster::filled([4, 4], 0)), 0.0);
    }
}
