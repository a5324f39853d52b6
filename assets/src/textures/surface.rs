//! Stucco, paint, tiles, rust, sheet metal, wood and cloth.

use super::pixmap::{Rgb, blend, shade};
use crate::noise::{fbm, lattice, smoothstep, value_noise};

fn grain(u: f64, v: f64, seed: u32) -> f64 {
    lattice((u * 256.0) as i32, (v * 256.0) as i32, seed)
}

/// Trowelled stucco, near white; materials tint it.
pub(crate) fn stucco(u: f64, v: f64) -> Rgb {
    let coarse = fbm(u * 8.0, v * 8.0, 4, 8, 51);
    let bumps = value_noise(u * 64.0, v * 64.0, 64, 52);
    let streak = smoothstep(0.55, 0.8, fbm(u * 24.0, v * 2.0, 3, 0, 53));
    let level = 0.87 + 0.10 * coarse + 0.05 * (bumps - 0.5) - 0.03 * streak * (1.0 - v) + 0.02 * grain(u, v, 54);
    shade([1.0, 0.99, 0.97], level)
}

/// Sun-bleached paint, near white, with a few chips that show brown.
pub(crate) fn paint(u: f64, v: f64) -> Rgb {
    let fade = fbm(u * 4.0, v * 4.0, 4, 4, 61);
    let chip = smoothstep(0.74, 0.80, fbm(u * 14.0, v * 14.0, 4, 14, 62));
    let level = 0.86 + 0.15 * fade + 0.03 * (grain(u, v, 63) - 0.5);
    blend(shade([1.0, 1.0, 1.0], level), [0.50, 0.36, 0.26], chip * 0.75)
}

/// A floor of 60 cm tiles in two tones, two by two.
pub(crate) fn checker(u: f64, v: f64) -> Rgb {
    let dark = (u < 0.5) != (v < 0.5);
    let base = if dark { [0.52, 0.23, 0.17] } else { [0.86, 0.80, 0.68] };
    let (fu, fv) = ((u * 2.0).fract(), (v * 2.0).fract());
    let joint = smoothstep(0.018, 0.008, fu.min(1.0 - fu).min(fv.min(1.0 - fv)));
    let worn = 0.92 + 0.12 * fbm(u * 6.0, v * 6.0, 4, 6, 71);
    shade(blend(base, [0.35, 0.30, 0.26], joint), worn)
}

/// Rusty plate: orange, brown and left-over dark scale.
pub(crate) fn rust(u: f64, v: f64) -> Rgb {
    let field = fbm(u * 5.0, v * 5.0, 5, 5, 81);
    let fine = fbm(u * 22.0, v * 22.0, 3, 22, 82);
    let base = blend([0.33, 0.19, 0.14], [0.62, 0.34, 0.18], smoothstep(0.35, 0.65, field));
    let bright = smoothstep(0.55, 0.75, fine);
    shade(blend(base, [0.74, 0.46, 0.25], bright * 0.5), 0.92 + 0.14 * grain(u, v, 83))
}

/// Corrugated iron, eight waves a tile, running along v, with rust that creeps from the edges of sheets.
pub(crate) fn corrugated(u: f64, v: f64) -> Rgb {
    let phase = (u * 8.0).fract();
    let wave = 4.0 * phase * (1.0 - phase);
    let weather = fbm(u * 3.0, v * 3.0, 4, 3, 91);
    let rusty = smoothstep(0.52, 0.66, weather) * (0.6 + 0.4 * (1.0 - wave));
    let sheet = shade([0.74, 0.75, 0.74], 0.74 + 0.26 * wave);
    let rusted = shade([0.56, 0.33, 0.20], 0.75 + 0.25 * wave);
    shade(blend(sheet, rusted, rusty), 0.96 + 0.05 * grain(u, v, 92))
}

/// Boards with grain along v; bright, so that materials tint it.
pub(crate) fn wood(u: f64, v: f64) -> Rgb {
    let lines = fbm(u * 32.0, v * 3.0, 3, 0, 101);
    let wavy = fbm(u * 8.0 + v * 0.7, v * 2.0, 3, 0, 102);
    let crack = smoothstep(0.70, 0.76, fbm(u * 40.0, v * 2.0, 2, 0, 103));
    let level = 0.72 + 0.22 * lines + 0.12 * wavy - 0.25 * crack;
    shade([1.0, 0.97, 0.92], level)
}

/// Woven cloth, near white, eight threads a tile each way.
pub(crate) fn tarp(u: f64, v: f64) -> Rgb {
    let thread = |t: f64| 4.0 * t.fract() * (1.0 - t.fract());
    let (a, b) = (thread(u * 32.0), thread(v * 32.0));
    let over = ((u * 32.0) as i32 + (v * 32.0) as i32) % 2 == 0;
    let weave = if over { a } else { b };
    shade([1.0, 0.99, 0.96], 0.84 + 0.12 * weave + 0.06 * fbm(u * 4.0, v * 4.0, 3, 4, 111))
}
