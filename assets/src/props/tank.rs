//! The water tank on its legs and the wind pump.

use std::f64::consts::TAU;

use glam::{DVec3, dvec2, dvec3};

use super::lattice::Lattice;
use crate::material::Material;
use crate::shapes::{moved, turn_about};
use crate::soup::{Crease, Soup};
use crate::trig::{cos, sin};

/// A corrugated tank with a conical roof, 8.6 m high in all.
pub(crate) fn water_tank() -> Soup {
    let legs = Lattice {
        material: Material::Rust,
        y_m: [-0.3, 5.0],
        half_m: [1.55, 1.15],
        bays: 3,
        leg_radius_m: 0.075,
        brace_radius_m: 0.022,
    };
    let mut soup = legs.soup();
    for k in 0..9 {
        let x_m = -1.76 + 0.44 * f64::from(k);
        soup.block(Material::Wood, [x_m - 0.19, x_m + 0.19], [5.08, 5.14], [-1.9, 1.9]);
    }
    for z_m in [-1.1, 1.1] {
        soup.block(Material::Rust, [-1.85, 1.85], [4.92, 5.10], [z_m - 0.07, z_m + 0.07]);
    }
    let shell = [
        (0.0, 5.12),
        (1.62, 5.12),
        (1.62, 5.9),
        (1.655, 5.92),
        (1.62, 5.94),
        (1.62, 6.7),
        (1.655, 6.72),
        (1.62, 6.74),
        (1.62, 7.5),
        (0.0, 7.5),
    ];
    soup.lathe(Material::Corrugated, Crease::Soft, &shell, 32);
    let hat = [(0.0, 7.44), (1.78, 7.44), (1.80, 7.48), (0.16, 8.30), (0.16, 8.42), (0.0, 8.48)];
    soup.lathe(Material::Rust, Crease::Soft, &hat, 32);
    soup.tube(Material::Galvanised, &[dvec3(0.2, 5.2, 0.0), dvec3(0.2, -0.2, 0.0)], 0.07, 8);
    soup.put(&tank_ladder(), moved(0.0, 0.0, 1.96));
    soup
}

fn tank_ladder() -> Soup {
    let mut soup = Soup::default();
    for x_m in [-0.22, 0.22] {
        soup.tube(Material::Iron, &[dvec3(x_m, -0.1, 0.0), dvec3(x_m, 7.3, -0.05)], 0.02, 5);
    }
    for k in 0..22 {
        let y_m = 0.35 + 0.32 * f64::from(k);
        soup.tube(Material::Iron, &[dvec3(-0.23, y_m, -0.007 * y_m), dvec3(0.23, y_m, -0.007 * y_m)], 0.013, 5);
    }
    soup
}

/// The wind pump's tower, 9.5 m high, with its platform and pump rod.
pub(crate) fn wind_tower() -> Soup {
    let tower = Lattice {
        material: Material::Galvanised,
        y_m: [-0.3, 9.4],
        half_m: [1.25, 0.14],
        bays: 6,
        leg_radius_m: 0.04,
        brace_radius_m: 0.016,
    };
    let mut soup = tower.soup();
    soup.block(Material::Wood, [-0.6, 0.6], [8.45, 8.50], [-0.6, 0.6]);
    soup.tube(Material::Iron, &[dvec3(0.0, -0.2, 0.0), dvec3(0.0, 9.9, 0.0)], 0.025, 6);
    soup.bevelled(Material::Concrete, dvec3(-0.5, -0.3, -0.5), dvec3(0.5, 0.25, 0.5), 0.04);
    soup
}

/// The wheel (facing +Z), hub and tail; the origin is the top of the tower.
pub(crate) fn wind_wheel() -> Soup {
    let mut soup = Soup::default();
    for k in 0..18 {
        soup.put(&blade(), glam::DAffine3::from_mat3(turn_about(DVec3::Z, 20.0 * f64::from(k))));
    }
    for (radius_m, z_m) in [(0.72, 0.52), (1.62, 0.52)] {
        soup.put(&hoop(radius_m), moved(0.0, 0.0, z_m));
    }
    for k in 0..6 {
        let angle = TAU * f64::from(k) / 6.0;
        let at = |r: f64| dvec3(r * cos(angle), r * sin(angle), 0.5);
        soup.tube(Material::Iron, &[at(0.05), at(1.64)], 0.014, 5);
    }
    soup.tube(Material::Iron, &[dvec3(0.0, 0.0, 0.62), dvec3(0.0, 0.0, -0.3)], 0.10, 10);
    soup.block(Material::Iron, [-0.16, 0.16], [-0.2, 0.22], [-0.28, 0.24]);
    tail(&mut soup);
    soup
}

/// One twisted blade, a thin closed sheet.
fn blade() -> Soup {
    let mut soup = Soup::default();
    let edge = |r: f64, half_m: f64, twist_m: f64, z: f64| {
        [dvec3(-half_m, r, 0.5 - twist_m + z), dvec3(half_m, r, 0.5 + twist_m + z)]
    };
    let (t, inner, outer) = (0.006, (0.66, 0.075, 0.06), (1.82, 0.21, 0.10));
    let [a, b] = edge(inner.0, inner.1, inner.2, -t);
    let [c, d] = edge(outer.0, outer.1, outer.2, -t);
    let lift = dvec3(0.0, 0.0, 2.0 * t);
    soup.hexahedron(Material::Galvanised, Crease::Flat, [a, b, c, d, a + lift, b + lift, c + lift, d + lift]);
    soup
}

fn hoop(radius_m: f64) -> Soup {
    let mut flat = Soup::default();
    let ring: Vec<_> =
        (0..4).map(|k| f64::from(k) * TAU / 4.0).map(|a| (radius_m + 0.016 * cos(a), 0.016 * sin(a))).collect();
    flat.lathe(Material::Iron, Crease::Smooth, &ring, 32);
    let mut soup = Soup::default();
    soup.put(&flat, glam::DAffine3::from_mat3(turn_about(DVec3::X, 90.0)));
    soup
}

fn tail(soup: &mut Soup) {
    for y_m in [-0.1, 0.12] {
        soup.tube(Material::Iron, &[dvec3(0.0, y_m, -0.2), dvec3(0.0, y_m * 2.0, -2.0)], 0.02, 5);
    }
    let outline = [dvec2(1.5, -0.26), dvec2(2.9, -0.62), dvec2(2.9, 0.62), dvec2(1.5, 0.26)];
    let mut plate = Soup::default();
    plate.prism(Material::PaintRed, Crease::Flat, &outline, -0.008, 0.008);
    soup.put(&plate, glam::DAffine3::from_mat3(turn_about(DVec3::Y, 90.0)));
}
