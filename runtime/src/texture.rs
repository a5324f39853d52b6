//! Textures with mip levels, and their sampling on the CPU: the twin of a GPU's sampler with a texture, sRGB or linear,
//! and `textureSampleLevel`.

use glam::{Vec2, Vec4};
use std::sync::LazyLock;
use sunbake::scene::alpha::wrap_texel;
use sunbake::scene::{Image, Wrap};

/// An image and its mip levels, down to one texel.
#[derive(Debug, Clone)]
pub struct MipChain {
    /// From the image itself to a single texel.
    pub levels: Vec<Level>,
    /// What its codes mean.
    pub encoding: Encoding,
}

/// What the codes of an image's red, green and blue mean. Alpha is always linear.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Encoding {
    /// Colours.
    Srgb,
    /// Numbers from 0 to 1: normals, metal, roughness.
    Linear,
}

/// A mip level, with half the texels of the one before along each axis.
#[derive(Debug, Clone)]
pub struct Level {
    /// In texels.
    pub width: u32,
    /// In texels.
    pub height: u32,
    /// Codes of colour and alpha, row order.
    pub rgba: Vec<[u8; 4]>,
}

/// Linear light of each sRGB code (IEC 61966-2-1).
static LINEAR_FROM_SRGB: LazyLock<[f32; 256]> = LazyLock::new(|| {
    std::array::from_fn(|code| {
        let x = code as f64 / 255.0;
        (if x <= 0.040_45 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }) as f32
    })
});

/// The sRGB curve, for values in [0, 1].
pub fn srgb_from_linear(x: f32) -> f32 {
    if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
}

/// Linear light of an sRGB code.
pub fn linear_from_srgb(code: u8) -> f32 {
    LINEAR_FROM_SRGB[code as usize]
}

impl Encoding {
    fn decoded(self, texel: [u8; 4]) -> Vec4 {
        let [r, g, b, a] = texel;
        let unit = |code: u8| f32::from(code) / 255.0;
        match self {
            Self::Srgb => Vec4::new(linear_from_srgb(r), linear_from_srgb(g), linear_from_srgb(b), unit(a)),
            Self::Linear => Vec4::new(unit(r), unit(g), unit(b), unit(a)),
        }
    }

    fn encoded(self, color: Vec4) -> [u8; 4] {
        let code = |x: f32| (x.clamp(0.0, 1.0) * 255.0).round() as u8;
        let [r, g, b] = [color.x, color.y, color.z].map(|x| match self {
            Self::Srgb => code(srgb_from_linear(x)),
            Self::Linear => code(x),
        });
        [r, g, b, code(color.w)]
    }
}

impl MipChain {
    /// Halves an image until one texel is left.
    pub fn new(image: &Image, encoding: Encoding) -> Self {
        let mut levels = vec![Level { width: image.width, height: image.height, rgba: image.rgba.clone() }];
        while let Some(next) = levels.last().and_then(|level| level.halved(encoding)) {
            levels.push(next);
        }
        Self { levels, encoding }
    }

    /// Samples with trilinear filtering. `lod` 0 is the image itself.
    pub fn sample(&self, uv: Vec2, lod: f32, wrap: [Wrap; 2]) -> Vec4 {
        let lod = lod.clamp(0.0, (self.levels.len() - 1) as f32);
        let fine = lod.floor() as usize;
        let weight = lod - lod.floor();
        let sample = |level: usize| self.levels[level].sample(uv, wrap, self.encoding);
        let near = sample(fine);
        if weight == 0.0 { near } else { near.lerp(sample(fine + 1), weight) }
    }
}

impl Level {
    /// Half as wide and high, rounded down. None for a single texel. Colours are weighted by alpha, so that transparent
    /// texels do not tint opaque ones.
    fn halved(&self, encoding: Encoding) -> Option<Self> {
        if self.width == 1 && self.height == 1 {
            return None;
        }
        let (width, height) = ((self.width / 2).max(1), (self.height / 2).max(1));
        let mut rgba = Vec::with_capacity(width as usize * height as usize);
        for y in 0..height {
            for x in 0..width {
                let four = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| {
                    encoding.decoded(self.texel((2 * x + i).min(self.width - 1), (2 * y + j).min(self.height - 1)))
                });
                rgba.push(encoding.encoded(mean(four)));
            }
        }
        Some(Self { width, height, rgba })
    }

    fn texel(&self, x: u32, y: u32) -> [u8; 4] {
        self.rgba[y as usize * self.width as usize + x as usize]
    }

    fn sample(&self, uv: Vec2, wrap: [Wrap; 2], encoding: Encoding) -> Vec4 {
        let place = uv * Vec2::new(self.width as f32, self.height as f32) - 0.5;
        let base = place.floor();
        let weight = place - base;
        let (x, y) = (base.x as i64, base.y as i64);
        let at = |dx: i64, dy: i64| {
            let (x, y) = (wrap_texel(x + dx, self.width, wrap[0]), wrap_texel(y + dy, self.height, wrap[1]));
            encoding.decoded(self.texel(x, y))
        };
        let top = at(0, 0).lerp(at(1, 0), weight.x);
        let bottom = at(0, 1).lerp(at(1, 1), weight.x);
        top.lerp(bottom, weight.y)
    }
}

fn mean(four: [Vec4; 4]) -> Vec4 {
    let alpha: f32 = four.iter().map(|c| c.w).sum();
    let weigh = |c: Vec4| if alpha > 0.0 { c.w / alpha } else { 0.25 };
    let color: Vec4 = four.iter().map(|&c| c * weigh(c)).sum();
    color.truncate().extend(alpha / 4.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(width: u32, height: u32, rgba: Vec<[u8; 4]>) -> Image {
        Image { name: String::new(), width, height, rgba }
    }

    #[test]
    fn a_flat_image_is_flat_at_every_level() {
        let mips = MipChain::new(&image(5, 3, vec![[200, 100, 50, 255]; 15]), Encoding::Srgb);
        assert_eq!(mips.levels.iter().map(|l| (l.width, l.height)).collect::<Vec<_>>(), [(5, 3), (2, 1), (1, 1)]);
        assert!(mips.levels.iter().all(|l| l.rgba.iter().all(|&t| t == [200, 100, 50, 255])));
    }

    #[test]
    fn codes_survive_decoding_and_encoding() {
        for encoding in [Encoding::Srgb, Encoding::Linear] {
            assert!((0..=255).all(|code| encoding.encoded(encoding.decoded([code; 4])) == [code; 4]));
        }
    }

    #[test]
    fn numbers_are_averaged_as_they_are_and_colours_as_light() {
        let halves = image(2, 1, vec![[0, 0, 0, 255], [255, 255, 255, 255]]);
        let last = |encoding| MipChain::new(&halves, encoding).levels[1].rgba[0][0];
        assert_eq!((last(Encoding::Linear), last(Encoding::Srgb)), (128, 188));
    }

    #[test]
    fn sampling_at_texel_centres_returns_texels_and_between_them_their_mean() {
        let mips = MipChain::new(&image(2, 1, vec![[0, 0, 0, 255], [255, 255, 255, 255]]), Encoding::Srgb);
        let at = |u: f32| mips.sample(Vec2::new(u, 0.5), 0.0, [Wrap::Repeat; 2]).x;
        assert!((at(0.25), at(0.75)) == (0.0, 1.0) && (at(0.5) - 0.5).abs() < 1e-6 && (at(1.0) - 0.5).abs() < 1e-6);
    }
}
