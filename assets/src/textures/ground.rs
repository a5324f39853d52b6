//! Sand, the two roads and concrete. A road tile is 10 m wide: asphalt in the middle, sand drifting over its edges.

use super::pixmap::{Rgb, blend, shade};
use crate::noise::{fbm, lattice, smoothstep, value_noise};

/// Width of a road tile and length of its repeat, in metres.
const ROAD_TILE_M: f64 = 10.0;
/// Half the width of the asphalt, in metres.
const ASPHALT_HALF_M: f64 = 3.55;
/// Radius of the crossing's corners, in metres.
const CORNER_M: f64 = 1.45;

/// Desert sand: wind ripples, mottling and grains.
pub(crate) fn sand(u: f64, v: f64) -> Rgb {
    let mottle = fbm(u * 6.0, v * 6.0, 4, 6, 11);
    let bend = fbm(u * 4.0, v * 4.0, 3, 4, 12) * 6.0;
    let phase = (v * 36.0 + bend).rem_euclid(1.0);
    let ripple = smoothstep(0.0, 0.75, phase) * smoothstep(1.0, 0.75, phase);
    let strength = smoothstep(0.4, 0.65, fbm(u * 3.0, v * 3.0, 2, 3, 13));
    let grain = lattice((u * 512.0) as i32, (v * 512.0) as i32, 14);
    let pebble = smoothstep(0.87, 0.95, value_noise(u * 90.0, v * 90.0, 90, 15));
    let base = blend([0.78, 0.62, 0.44], [0.87, 0.73, 0.54], mottle);
    let lit = 0.93 + 0.07 * grain + 0.07 * (ripple - 0.5) * strength;
    blend(shade(base, lit), [0.58, 0.46, 0.36], pebble * 0.5)
}

/// Layered sandstone, its strata along u.
pub(crate) fn cliff(u: f64, v: f64) -> Rgb {
    let warp = 0.05 * fbm(u * 4.0, v * 4.0, 3, 4, 17);
    let strata = fbm(u * 2.0, (v + warp) * 14.0, 3, 0, 18);
    let block = fbm(u * 9.0, v * 9.0, 4, 9, 19);
    let base = blend([0.66, 0.46, 0.32], [0.84, 0.66, 0.47], smoothstep(0.25, 0.75, strata));
    shade(base, 0.78 + 0.36 * block)
}

/// A straight piece of road; u runs across it, v along it.
pub(crate) fn road(u: f64, v: f64) -> Rgb {
    let (across_m, along_m) = ((u - 0.5) * ROAD_TILE_M, v * ROAD_TILE_M);
    let wheel_track = smoothstep(0.75, 0.2, (across_m.abs() - 1.75).abs() - 0.35);
    let tar = shade(asphalt(u, v), 1.0 - 0.05 * wheel_track);
    let middle = band(across_m, 0.0, 0.065) * band(along_m, 5.0, 1.6);
    let edges = band(across_m.abs(), 3.15, 0.055);
    let worn = paint_wear(u, v);
    let painted = blend(tar, [0.88, 0.68, 0.16], middle * worn);
    let painted = blend(painted, [0.86, 0.85, 0.80], edges * worn);
    drifted(painted, u, v, across_m.abs() - ASPHALT_HALF_M)
}

/// The crossing of both roads, with round corners; seamless with [`road`] on its four sides.
pub(crate) fn crossing(u: f64, v: f64) -> Rgb {
    let (x, z) = (((u - 0.5) * ROAD_TILE_M).abs(), ((v - 0.5) * ROAD_TILE_M).abs());
    let inner = ASPHALT_HALF_M + CORNER_M;
    let (dx, dz) = ((inner - x).max(0.0), (inner - z).max(0.0));
    let beyond_m = CORNER_M - (dx * dx + dz * dz).sqrt();
    let oil = smoothstep(0.5, 0.75, fbm(u * 5.0, v * 5.0, 3, 5, 31)) * smoothstep(3.6, 1.5, x.max(z));
    let tar = shade(asphalt(u, v), 1.0 - 0.07 * oil);
    drifted(tar, u, v, beyond_m)
}

fn asphalt(u: f64, v: f64) -> Rgb {
    let patchy = fbm(u * 5.0, v * 5.0, 4, 5, 21);
    let grain = lattice((u * 512.0) as i32, (v * 512.0) as i32, 22);
    let crack_field = fbm(u * 4.0, v * 4.0, 4, 4, 23) - 0.5;
    let crack = smoothstep(0.005, 0.001, crack_field.abs()) * smoothstep(0.5, 0.62, patchy);
    let base = blend([0.325, 0.315, 0.31], [0.385, 0.37, 0.36], patchy);
    shade(blend(base, [0.20, 0.19, 0.19], crack * 0.5), 0.88 + 0.2 * grain)
}

fn paint_wear(u: f64, v: f64) -> f64 {
    0.35 + 0.6 * smoothstep(0.30, 0.52, fbm(u * 40.0, v * 40.0, 2, 40, 24))
}

/// 1 within `half_m` of `middle_m`, with an edge of 2 cm.
fn band(at_m: f64, middle_m: f64, half_m: f64) -> f64 {
    smoothstep(half_m + 0.01, half_m - 0.01, (at_m - middle_m).abs())
}

/// Lets sand lie over whatever is more than about 0 m beyond the asphalt's edge.
fn drifted(tar: Rgb, u: f64, v: f64, beyond_m: f64) -> Rgb {
    // Straight at the tile's rim, where tiles meet that are turned against each other.
    let inner = smoothstep(0.0, 0.14, u.min(1.0 - u).min(v).min(1.0 - v));
    let ragged_m = (fbm(u * 6.0, v * 6.0, 5, 6, 25) - 0.5) * 0.9 * inner;
    let cover = smoothstep(-0.30, 0.20, beyond_m + ragged_m);
    let dust = 0.25 * smoothstep(-1.2, 0.0, beyond_m) * fbm(u * 20.0, v * 20.0, 2, 20, 26);
    blend(blend(tar, [0.80, 0.66, 0.48], dust), sand(u, v), cover)
}

/// Concrete slabs of 3 m with a dark joint, stains and drifted dust.
pub(crate) fn concrete(u: f64, v: f64) -> Rgb {
    let mottle = fbm(u * 5.0, v * 5.0, 4, 5, 41);
    let grain = lattice((u * 256.0) as i32, (v * 256.0) as i32, 42);
    let stain = smoothstep(0.58, 0.72, fbm(u * 3.0, v * 3.0, 4, 3, 43));
    let to_joint_m = 3.0 * u.min(1.0 - u).min(v.min(1.0 - v));
    let joint = smoothstep(0.022, 0.010, to_joint_m);
    let base = blend([0.66, 0.62, 0.56], [0.75, 0.71, 0.64], mottle);
    let stained = blend(base, [0.50, 0.46, 0.42], stain * 0.45);
    shade(blend(stained, [0.36, 0.32, 0.28], joint), 0.95 + 0.07 * grain)
}
