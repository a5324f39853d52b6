//! Sine and cosine that give the same bits on every machine.
//!
//! The standard library's come from the platform. The committed file must not depend on one, so these use only
//! `+`, `*` and `floor`, which IEEE 754 rounds in one way.

use std::f64::consts::{FRAC_PI_2, TAU};

/// Sine of an angle in radians. Good to about 1e-14.
pub(crate) fn sin(angle_rad: f64) -> f64 {
    let x = angle_rad - TAU * (angle_rad / TAU + 0.5).floor();
    let mut term = x;
    let mut sum = x;
    for k in 1..14 {
        let n = 2.0 * f64::from(k);
        term *= -x * x / (n * (n + 1.0));
        sum += term;
    }
    sum
}

/// Cosine of an angle in radians. Good to about 1e-14.
pub(crate) fn cos(angle_rad: f64) -> f64 {
    sin(angle_rad + FRAC_PI_2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_the_standard_library() {
        for k in -400..400 {
            let x = f64::from(k) * 0.037;
            assert!((sin(x) - x.sin()).abs() < 1e-12, "sin {x}");
            assert!((cos(x) - x.cos()).abs() < 1e-12, "cos {x}");
        }
    }
}
