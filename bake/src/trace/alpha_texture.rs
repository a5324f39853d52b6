//! The alpha channel of a texture, with the largest uniform squares around each texel.
//!
//! Closed-form engines walk along a line over the texture. Uniform squares let them skip texels that cannot change the
//! result.

use crate::scene::alpha::{nearest_texel, wrap_texel};
use crate::scene::{Image, Wrap};
use glam::Vec2;

/// The alpha channel of a material's texture.
pub(super) struct AlphaTexture {
    pub size: [u32; 2],
    pub wrap: [Wrap; 2],
    pub alpha: Vec<u8>,
    /// For each texel, the sides in texels of the largest uniform squares that start at it towards each corner of the
    /// image (by [`quadrant`]), and whether they are solid ([`SOLID`]). Valid for triangles with the material's own
    /// alpha.
    pub squares: Vec<[u8; 4]>,
}

/// Whether alpha reaches the cutoff. Always in `f32`: a cutoff such as 0.2 equals the alpha 51/255 in `f32` but not in
/// `f64`.
#[inline]
pub(super) fn is_solid(own: f32, texel: f32, cutoff: f32) -> bool {
    own * texel >= cutoff
}

/// Bit of [`AlphaTexture::squares`] that marks solid texels.
pub(super) const SOLID: u8 = 0x80;

/// Index of the square that extends to where each coordinate grows (or falls).
#[inline]
pub(super) fn quadrant(grows: [bool; 2]) -> usize {
    usize::from(grows[0]) + 2 * usize::from(grows[1])
}

/// For each texel, whether it is solid, and the sides of the largest uniform squares within the image that start at it
/// and extend towards each of the four corners. A square's side is one more than the smallest of those that start at
/// the three neighbours in its direction, if these are like the texel: one sweep over the image for each corner.
fn squares(solid: &[bool], [width, height]: [usize; 2]) -> Vec<[u8; 4]> {
    let mut squares: Vec<[u8; 4]> = solid.iter().map(|&solid| [if solid { SOLID } else { 0 }; 4]).collect();
    for grows in [[false, false], [true, false], [false, true], [true, true]] {
        let q = quadrant(grows);
        for row in 0..height {
            for column in 0..width {
                // The sweep starts at the corner that the squares extend to.
                let x = if grows[0] { width - 1 - column } else { column };
                let y = if grows[1] { height - 1 - row } else { row };
                let here = y * width + x;
                let beside = |dx: bool, dy: bool| {
                    let x = if !dx {
                        x
                    } else if grows[0] {
                        x + 1
                    } else {
                        x - 1
                    };
                    let y = if !dy {
                        y
                    } else if grows[1] {
                        y + 1
                    } else {
                        y - 1
                    };
                    let there = y * width + x;
                    if solid[there] == solid[here] { squares[there][q] & !SOLID } else { 0 }
                };
                let is_last = column == 0 || row == 0;
                let around = || beside(true, false).min(beside(false, true)).min(beside(true, true));
                let side = if is_last { 1 } else { (around() + 1).min(!SOLID) };
                squares[here][q] |= side;
            }
        }
    }
    squares
}

impl AlphaTexture {
    /// For a material with this alpha factor and cutoff.
    pub fn new(image: &Image, wrap: [Wrap; 2], factor: f32, cutoff: f32) -> Self {
        let alpha: Vec<u8> = image.rgba.iter().map(|texel| texel[3]).collect();
        let size = [image.width, image.height];
        let solid: Vec<bool> = alpha.iter().map(|&a| is_solid(factor, f32::from(a) / 255.0, cutoff)).collect();
        let squares = squares(&solid, size.map(|n| n as usize));
        Self { size, wrap, alpha, squares }
    }

    /// Index of a texel in `alpha` and `squares`; any column and row are wrapped into the image.
    #[inline]
    pub fn index(&self, [column, row]: [i64; 2]) -> usize {
        let x = wrap_texel(column, self.size[0], self.wrap[0]);
        let y = wrap_texel(row, self.size[1], self.wrap[1]);
        y as usize * self.size[0] as usize + x as usize
    }

    /// Whether the texels around this one have the image's own order (not mirrored or clamped), so that squares are
    /// valid.
    pub fn has_image_order(&self, texel: [i64; 2]) -> bool {
        [0, 1].iter().all(|&k| {
            let size = i64::from(self.size[k]);
            match self.wrap[k] {
                Wrap::Repeat => true,
                Wrap::Clamp => (0..size).contains(&texel[k]),
                Wrap::Mirror => texel[k].rem_euclid(2 * size) < size,
            }
        })
    }

    pub fn alpha_at(&self, uv: Vec2) -> f32 {
        let [x, y] = nearest_texel(uv, self.size, self.wrap);
        f32::from(self.alpha[y as usize * self.size[0] as usize + x as usize]) / 255.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::pseudo_random;

    /// Brute force: grow each square until a texel differs or the image ends.
    #[test]
    fn squares_are_the_largest_that_hold_equal_texels() {
        let (width, height) = (19, 13);
        let mut state = 3;
        let solid: Vec<bool> = (0..width * height).map(|_| pseudo_random(&mut state) < 0.9).collect();
        let found = squares(&solid, [width, height]);
        for (here, sides) in found.iter().enumerate() {
            for grows in [[false, false], [true, false], [false, true], [true, true]] {
                let at = |i: usize, start: usize, grows: bool| if grows { start + i } else { start.wrapping_sub(i) };
                let is_equal = |&side: &usize| {
                    (0..side * side).all(|i| {
                        let (x, y) = (at(i % side, here % width, grows[0]), at(i / side, here / width, grows[1]));
                        x < width && y < height && solid[y * width + x] == solid[here]
                    })
                };
                let largest = (1..=width).take_while(is_equal).count();
                assert_eq!(usize::from(sides[quadrant(grows)] & !SOLID), largest, "{here} {grows:?}");
                assert_eq!(sides[quadrant(grows)] & SOLID != 0, solid[here]);
            }
        }
    }
}
