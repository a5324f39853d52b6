//! The ground: dunes, two roads that cross, and the station's flat lot. One height field on an uneven grid whose lines
//! run along every border of a material, so materials meet without a gap and without overlap.

use glam::{DVec2, DVec3, dvec2, dvec3};

use crate::material::Material;
use crate::noise::{fbm, mix, smoothstep, value_noise};
use crate::soup::{Corner, Crease, Soup, corner};

/// Where the middle of the road from west to east runs, in metres of z.
pub(crate) const MAIN_ROAD_Z_M: f64 = 17.0;
/// Where the middle of the road from north to south runs, in metres of x.
pub(crate) const SIDE_ROAD_X_M: f64 = -20.0;
/// Half the width of a road with its shoulders; one texture tile is twice that.
const ROAD_HALF_M: f64 = 5.0;
/// The concrete in front of the station: x and z ranges in metres.
const APRON_X_M: [f64; 2] = [-9.0, 15.0];
const APRON_Z_M: [f64; 2] = [-3.6, 10.2];

/// Grid lines: position and the spacing of the lines up to the next position, in metres.
const LINES_X_M: [(f64, f64); 10] = [
    (-70.0, 4.5),
    (-48.0, 2.0),
    (-34.0, 1.1),
    (-25.0, 1.0),
    (-15.0, 0.75),
    (-9.0, 0.8),
    (15.0, 0.9),
    (30.0, 1.6),
    (48.0, 4.5),
    (70.0, 1.0),
];
const LINES_Z_M: [(f64, f64); 8] =
    [(-70.0, 2.0), (-30.0, 1.1), (-3.6, 0.8625), (10.2, 0.6), (12.0, 1.0), (22.0, 1.0), (34.0, 3.6), (70.0, 1.0)];

/// Height of the ground at a place, in metres.
pub(crate) fn height_m(x_m: f64, z_m: f64) -> f64 {
    let dunes = dunes_m(x_m, z_m);
    let main_road =
        0.35 * bump(x_m, -48.0, 14.0) + 2.2 * smoothstep(34.0, 72.0, x_m) - 0.5 * smoothstep(-38.0, -70.0, x_m);
    let side_road =
        0.45 * bump(z_m, -28.0, 13.0) + 2.4 * smoothstep(-34.0, -72.0, z_m) - 0.4 * smoothstep(32.0, 70.0, z_m);
    let near_main = smoothstep(11.0, 5.4, (z_m - MAIN_ROAD_Z_M).abs());
    let near_side = smoothstep(11.0, 5.4, (x_m - SIDE_ROAD_X_M).abs());
    let near_lot = smoothstep(7.0, 0.8, beyond_m(x_m, -12.5, 15.4).max(beyond_m(z_m, -13.5, 12.5)));
    let open = mix(mix(dunes, side_road, near_side), main_road, near_main);
    mix(open, 0.0, near_lot)
}

/// How far `v` lies outside of a range; 0 inside.
fn beyond_m(v: f64, low: f64, high: f64) -> f64 {
    (low - v).max(v - high).max(0.0)
}

/// A smooth bump of height 1.
fn bump(v: f64, middle: f64, half: f64) -> f64 {
    smoothstep(half, 0.0, (v - middle).abs())
}

/// Height of the open desert: dunes that grow with distance, a mesa in the north, small humps.
fn dunes_m(x_m: f64, z_m: f64) -> f64 {
    let far = smoothstep(18.0, 60.0, dvec2(x_m, z_m).length());
    let broad = fbm(x_m / 19.0 + 40.3, z_m / 15.0 + 17.7, 3, 0, 201) - 0.42;
    let crest = 1.0 - 2.0 * (fbm(x_m / 26.0 + z_m / 60.0 + 9.1, z_m / 21.0 + 3.3, 2, 0, 202) - 0.5).abs();
    let humps = value_noise(x_m / 2.6 + 70.0, z_m / 2.6 + 70.0, 0, 203) - 0.5;
    let fine = value_noise(x_m / 1.3 + 90.0, z_m / 1.3 + 90.0, 0, 204) - 0.5;
    let rise = 2.4 * smoothstep(40.0, 68.0, x_m.abs().max(-z_m));
    0.10 + mix(1.0, 3.4, far) * broad + 0.9 * far * crest * crest + 0.16 * humps + 0.05 * fine + rise + mesa_m(x_m, z_m)
}

/// Distance from the mesa's middle, bent by its ragged outline, in metres.
fn mesa_radius_m(x_m: f64, z_m: f64) -> f64 {
    let ragged_m = 7.0 * (fbm(x_m / 9.0 + 30.0, z_m / 9.0 + 30.0, 3, 0, 205) - 0.5);
    dvec2((x_m - 14.0) / 1.9, z_m + 64.0).length() + ragged_m
}

/// A flat-topped hill north of the lot, far enough off the sun's summer path not to shade it.
fn mesa_m(x_m: f64, z_m: f64) -> f64 {
    let from_m = mesa_radius_m(x_m, z_m);
    1.8 * smoothstep(25.0, 17.0, from_m) + 4.2 * smoothstep(18.0, 13.6, from_m) + 3.2 * smoothstep(11.5, 8.0, from_m)
}

fn ticks(lines: &[(f64, f64)]) -> Vec<f64> {
    let mut all = vec![lines[0].0];
    for pair in lines.windows(2) {
        let long = pair[1].0 - pair[0].0;
        let parts = (long / pair[0].1).round().max(1.0);
        all.extend((1..=parts as usize).map(|k| pair[0].0 + long * k as f64 / parts));
    }
    all
}

/// Metres from the north edge of the main road.
fn across_main_m(p: DVec3) -> f64 {
    p.z - MAIN_ROAD_Z_M + ROAD_HALF_M
}

/// Metres from the west edge of the side road.
fn across_side_m(p: DVec3) -> f64 {
    p.x - SIDE_ROAD_X_M + ROAD_HALF_M
}

/// The material at a place, and the texture coordinate of any point of its cell.
fn surface(at_m: DVec2) -> (Material, fn(DVec3) -> DVec2) {
    let on_main = (at_m.y - MAIN_ROAD_Z_M).abs() < ROAD_HALF_M;
    let on_side = (at_m.x - SIDE_ROAD_X_M).abs() < ROAD_HALF_M;
    let on_apron = beyond_m(at_m.x, APRON_X_M[0], APRON_X_M[1]) + beyond_m(at_m.y, APRON_Z_M[0], APRON_Z_M[1]) <= 0.0;
    match (on_main, on_side) {
        (true, true) => (Material::Crossing, |p| dvec2(across_side_m(p), across_main_m(p))),
        (true, false) => (Material::Road, |p| dvec2(across_main_m(p), across_side_m(p))),
        (false, true) => (Material::Road, |p| dvec2(across_side_m(p), across_main_m(p))),
        (false, false) if on_apron => (Material::Concrete, |p| dvec2(p.x, p.z - 0.6)),
        (false, false) if mesa_radius_m(at_m.x, at_m.y) < 18.6 => {
            (Material::Cliff, |p| dvec2(p.x + 0.5 * p.z, 0.35 * p.z - p.y))
        }
        (false, false) => (Material::Sand, |p| dvec2(p.x, p.z)),
    }
}

/// The whole ground, an open sheet.
pub(crate) fn ground() -> Soup {
    let (xs, zs) = (ticks(&LINES_X_M), ticks(&LINES_Z_M));
    let mut sheets: Vec<(Material, Vec<[Corner; 4]>)> = Vec::new();
    for x in xs.windows(2) {
        for z in zs.windows(2) {
            let (material, uv) = surface(dvec2(x[0] + x[1], z[0] + z[1]) * 0.5);
            let at = |x: f64, z: f64| {
                let p = dvec3(x, height_m(x, z), z);
                corner(p, uv(p))
            };
            let quad = [at(x[0], z[0]), at(x[0], z[1]), at(x[1], z[1]), at(x[1], z[0])];
            match sheets.iter_mut().find(|s| s.0 == material) {
                Some(sheet) => sheet.1.push(quad),
                None => sheets.push((material, vec![quad])),
            }
        }
    }
    poured(&sheets)
}

fn poured(sheets: &[(Material, Vec<[Corner; 4]>)]) -> Soup {
    let mut soup = Soup::default();
    for (material, quads) in sheets {
        soup.patch(*material, Crease::Smooth).in_group(0);
        for &quad in quads {
            soup.quad(quad);
        }
    }
    soup
}
