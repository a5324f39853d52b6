//! The four texels that a bilinear filter reads at a point of a page, as GPUs do it and as every CPU twin does.

use super::PageSize;
use super::reach::{OPEN, Reach};
use glam::{DVec2, Vec3};
use std::array;
use std::ops::{Add, Mul};

/// A value of texels that a filter can blend.
pub trait Filtered: Copy + Mul<f32, Output = Self> + Add<Output = Self> {
    /// The darker of two.
    fn darker(self, other: Self) -> Self;
}

impl Filtered for f32 {
    fn darker(self, other: Self) -> Self {
        self.min(other)
    }
}

impl Filtered for Vec3 {
    fn darker(self, other: Self) -> Self {
        self.min(other)
    }
}

/// Four texels around a point of a page, and where the point lies between their centres.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Footprint {
    /// `y * width + x` of each: upper left, upper right, lower left, lower right. Beyond the page's border the border's
    /// own texel is repeated.
    pub texels: [usize; 4],
    /// From the upper left texel's centre to the others', 0 to 1 along x and along y.
    pub fraction: DVec2,
    /// How the texels count beside walls; none without.
    pub reach: Option<Reach>,
}

impl Footprint {
    /// `point` is in texels from the *centre* of the page's first texel: page coordinates times the page's size, less a
    /// half.
    pub fn new(point: DVec2, size: PageSize) -> Self {
        let low = point.floor();
        let last = size.as_dvec2() - 1.0;
        let texel = |k: usize| {
            let x = (low.x + (k % 2) as f64).clamp(0.0, last.x) as usize;
            let y = (low.y + (k / 2) as f64).clamp(0.0, last.y) as usize;
            y * size.width as usize + x
        };
        Self { texels: array::from_fn(texel), fraction: point - low, reach: None }
    }

    /// The texel that the point lies on.
    pub fn nearest(&self) -> usize {
        let is_far = self.fraction.cmpge(DVec2::splat(0.5));
        self.texels[usize::from(is_far.x) + 2 * usize::from(is_far.y)]
    }

    /// Weights of the texels, in their order.
    pub fn weights(&self) -> [f64; 4] {
        let DVec2 { x, y } = self.fraction;
        [(1.0 - x) * (1.0 - y), x * (1.0 - y), (1.0 - x) * y, x * y]
    }

    /// How much each texel counts in [`Self::blend`], in `f32` and with what stands between them; none where the
    /// darkest of them counts.
    pub fn blend_weights(&self) -> Option<[f32; 4]> {
        match self.reach {
            None => {
                let [x, y] = self.fraction.as_vec2().to_array();
                Some([(1.0 - x) * (1.0 - y), x * (1.0 - y), (1.0 - x) * y, x * y])
            }
            Some(Reach { takes_darkest: true, .. }) => None,
            Some(Reach { weights, .. }) => Some(weights),
        }
    }

    /// The same among walls: `codes` are a page's, in row order ([`super::find_walls`]).
    pub fn beside_walls(self, codes: &[[u8; 2]]) -> Self {
        let [upper_left, upper_right, lower_left, _] = self.texels;
        let code = |texel: usize, way: usize| codes[texel][way];
        self.among([code(upper_left, 0), code(lower_left, 0), code(upper_left, 1), code(upper_right, 1)])
    }

    /// The same with the codes of the upper, lower, left and right edge.
    pub fn among(self, codes: [u8; 4]) -> Self {
        let reach = (codes != [OPEN; 4]).then(|| Reach::new(self.fraction.as_vec2().to_array(), codes));
        Self { reach, ..self }
    }

    /// Values of the texels blended, in `f32`, as the shaders do it: without walls along x and then along y.
    pub fn blend<T: Filtered>(&self, value: impl Fn(usize) -> T) -> T {
        let [top_left, top_right, bottom_left, bottom_right] = self.texels.map(value);
        match self.reach {
            None => {
                let [x, y] = self.fraction.as_vec2().to_array();
                let mix = |a: T, b: T, weight: f32| a * (1.0 - weight) + b * weight;
                mix(mix(top_left, top_right, x), mix(bottom_left, bottom_right, x), y)
            }
            Some(Reach { takes_darkest: true, .. }) => {
                top_left.darker(top_right).darker(bottom_left.darker(bottom_right))
            }
            Some(Reach { weights: [a, b, c, d], .. }) => {
                (top_left * a + top_right * b) + (bottom_left * c + bottom_right * d)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: PageSize = PageSize { width: 4, height: 4 };

    #[test]
    fn a_point_between_centres_weighs_its_four_texels_by_distance() {
        let at_centre = Footprint::new(DVec2::new(1.0, 0.0), SIZE);
        assert_eq!((at_centre.texels[0], at_centre.weights()), (1, [1.0, 0.0, 0.0, 0.0]));
        let between = Footprint::new(DVec2::new(1.5, 0.75), SIZE);
        assert_eq!(between.texels, [1, 2, 5, 6]);
        assert_eq!(between.weights(), [0.125, 0.125, 0.375, 0.375]);
        assert_eq!(between.blend(|texel| texel as f32), 4.5);
        assert_eq!((at_centre.nearest(), between.nearest()), (1, 6));
    }

    #[test]
    fn the_border_repeats_its_own_texels() {
        assert_eq!(Footprint::new(DVec2::splat(-0.5), SIZE).texels, [0; 4]);
        assert_eq!(Footprint::new(DVec2::splat(3.5), SIZE).texels, [15; 4]);
        assert_eq!(Footprint::new(DVec2::NAN, SIZE).texels, [0; 4]);
    }
}
