//! Real spherical harmonics up to degree two: nine functions of a direction.
//!
//! After Ramamoorthi and Hanrahan, "An efficient representation for irradiance environment maps", *SIGGRAPH* 2001, with
//! the scene's own axes: x east, y up, z south.

use glam::DVec3;

/// How many there are.
pub const COUNT: usize = 9;

/// A number for each function, in the order (0, 0), (1, -1), (1, 0), (1, 1), (2, -2), (2, -1), (2, 0), (2, 1), (2, 2).
pub type Coefficients = [f32; COUNT];

/// The functions at a unit direction: orthonormal over the sphere.
#[inline]
pub fn basis(direction: DVec3) -> [f64; COUNT] {
    let DVec3 { x, y, z } = direction;
    [
        0.282_094_791_773_878_14,
        0.488_602_511_902_919_9 * y,
        0.488_602_511_902_919_9 * z,
        0.488_602_511_902_919_9 * x,
        1.092_548_430_592_079_2 * (x * y),
        1.092_548_430_592_079_2 * (y * z),
        0.315_391_565_252_520_05 * (3.0 * z * z - 1.0),
        1.092_548_430_592_079_2 * (x * z),
        0.546_274_215_296_039_6 * (x * x - y * y),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_functions_are_orthonormal() {
        // A product rule that is exact for polynomials of degree four: three Gauss nodes in height, eight angles.
        let nodes = [(-(0.6f64.sqrt()), 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.6f64.sqrt(), 5.0 / 9.0)];
        let mut product = [[0.0; COUNT]; COUNT];
        for (height, weight) in nodes {
            for step in 0..8 {
                let angle = f64::from(step) * std::f64::consts::TAU / 8.0;
                let across = (1.0 - height * height).sqrt();
                let values = basis(DVec3::new(across * angle.cos(), across * angle.sin(), height));
                for i in 0..COUNT {
                    for j in 0..COUNT {
                        product[i][j] += values[i] * values[j] * weight * std::f64::consts::TAU / 8.0;
                    }
                }
            }
        }
        for (i, row) in product.iter().enumerate() {
            for (j, &value) in row.iter().enumerate() {
                assert!((value - if i == j { 1.0 } else { 0.0 }).abs() < 1e-12, "{i}, {j}: {value}");
            }
        }
    }
}
