//! The four texels that a bilinear filter reads at a point of a page, as GPUs do it and as every CPU twin does.

use super::PageSize;
use glam::DVec2;
use std::array;
use std::ops::{Add, Mul};

/// Four texels around a point of a page, and where the point lies between their centres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Footprint {
    /// `y * width + x` of each: upper left, upper right, lower left, lower right. Beyond the page's border the border's
    /// own texel is repeated.
    pub texels: [usize; 4],
    /// From the upper left texel's centre to the others', 0 to 1 along x and along y.
    pub fraction: DVec2,
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
        Self { texels: array::from_fn(texel), fraction: point - low }
    }

    /// Weights of the texels, in their order.
    pub fn weights(&self) -> [f64; 4] {
        let DVec2 { x, y } = self.fraction;
        products([1.0 - x, x], [1.0 - y, y])
    }

    /// The same, computed in `f32`.
    pub fn weights_f32(&self) -> [f32; 4] {
        let [x, y] = self.fraction.as_vec2().to_array();
        products([1.0 - x, x], [1.0 - y, y])
    }

    /// Values of the texels blended along x and then along y, in `f32`, as the shaders do it.
    pub fn blend<T: Mul<f32, Output = T> + Add<Output = T>>(&self, value: impl Fn(usize) -> T) -> T {
        let [x, y] = self.fraction.as_vec2().to_array();
        let mix = |a: T, b: T, weight: f32| a * (1.0 - weight) + b * weight;
        let [top_left, top_right, bottom_left, bottom_right] = self.texels;
        let top = mix(value(top_left), value(top_right), x);
        let bottom = mix(value(bottom_left), value(bottom_right), x);
        mix(top, bottom, y)
    }
}

fn products<T: Copy + Mul<Output = T>>([left, right]: [T; 2], [top, bottom]: [T; 2]) -> [T; 4] {
    [left * top, right * top, left * bottom, right * bottom]
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
        assert_eq!(between.weights_f32(), [0.125, 0.125, 0.375, 0.375]);
        assert_eq!(between.blend(|texel| texel as f32), 4.5);
    }

    #[test]
    fn the_border_repeats_its_own_texels() {
        assert_eq!(Footprint::new(DVec2::splat(-0.5), SIZE).texels, [0; 4]);
        assert_eq!(Footprint::new(DVec2::splat(3.5), SIZE).texels, [15; 4]);
        assert_eq!(Footprint::new(DVec2::NAN, SIZE).texels, [0; 4]);
    }
}
