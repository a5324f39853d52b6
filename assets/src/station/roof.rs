//! What stands on the shop's roof.

use glam::{DVec3, dvec3};

use crate::material::Material;
use crate::shapes::{moved, turned};
use crate::soup::{Crease, Soup};

/// An evaporative cooler: a louvred box on legs with a duct elbow.
pub(crate) fn air_conditioner() -> Soup {
    let mut soup = Soup::default();
    for (x_m, z_m) in [(-0.5, -0.4), (0.5, -0.4), (-0.5, 0.4), (0.5, 0.4)] {
        soup.standing(Material::Iron, dvec3(x_m, 0.0, z_m), dvec3(0.06, 0.42, 0.06));
    }
    soup.block(Material::Galvanised, [-0.58, 0.58], [0.40, 0.47], [-0.48, 0.48]);
    soup.block(Material::Galvanised, [-0.58, 0.58], [1.20, 1.28], [-0.48, 0.48]);
    soup.block(Material::Dark, [-0.50, 0.50], [0.45, 1.22], [-0.40, 0.40]);
    for (x_m, z_m) in [(-0.54, -0.44), (0.54, -0.44), (-0.54, 0.44), (0.54, 0.44)] {
        soup.standing(Material::Galvanised, dvec3(x_m, 0.44, z_m), dvec3(0.075, 0.8, 0.075));
    }
    for k in 0..9 {
        let y_m = 0.53 + 0.08 * f64::from(k);
        for side in 0..4 {
            let mut slat = Soup::default();
            let (half_m, out_m) = if side % 2 == 0 { (0.52, 0.415) } else { (0.42, 0.515) };
            let tilt = 0.022;
            let at = |x: f64, y: f64, z: f64| dvec3(x, y_m + y, out_m + z);
            let lower = [at(-half_m, -tilt, 0.03), at(half_m, -tilt, 0.03)];
            let upper = [at(-half_m, tilt, -0.02), at(half_m, tilt, -0.02)];
            let thick = dvec3(0.0, 0.012, 0.0);
            let c = [
                upper[0],
                upper[1],
                upper[0] + thick,
                upper[1] + thick,
                lower[0],
                lower[1],
                lower[0] + thick,
                lower[1] + thick,
            ];
            slat.hexahedron(Material::Galvanised, Crease::Flat, c);
            soup.put(&slat, turned(DVec3::ZERO, 90.0 * f64::from(side)));
        }
    }
    let duct = [
        dvec3(0.0, 0.85, -0.38),
        dvec3(0.0, 0.85, -0.8),
        dvec3(0.0, 0.72, -1.0),
        dvec3(0.0, 0.5, -1.08),
        dvec3(0.0, 0.0, -1.08),
    ];
    soup.tube(Material::Galvanised, &duct, 0.21, 12);
    soup
}

/// A television aerial on a guyed mast.
pub(crate) fn aerial() -> Soup {
    let mut soup = Soup::default();
    soup.tube(Material::Iron, &[DVec3::ZERO, dvec3(0.0, 3.9, 0.0)], 0.025, 6);
    soup.tube(Material::Galvanised, &[dvec3(-0.9, 3.7, 0.0), dvec3(1.1, 3.7, 0.0)], 0.02, 6);
    for k in 0..9 {
        let (x_m, half_m) = (-0.85 + 0.23 * f64::from(k), 0.78 - 0.06 * f64::from(k));
        soup.tube(Material::Galvanised, &[dvec3(x_m, 3.71, -half_m), dvec3(x_m, 3.71, half_m)], 0.010, 5);
    }
    soup.tube(Material::Galvanised, &[dvec3(0.0, 3.2, -0.5), dvec3(0.0, 3.2, 0.5)], 0.012, 5);
    for (x_m, z_m) in [(1.2, 0.9), (-0.9, 1.0), (0.2, -0.45)] {
        soup.tube(Material::Iron, &[dvec3(0.0, 2.4, 0.0), dvec3(x_m, 0.03, z_m)], 0.008, 5);
    }
    soup
}

/// A vent pipe with a hat.
pub(crate) fn vent() -> Soup {
    let mut soup = Soup::default();
    soup.lathe(Material::Galvanised, Crease::Soft, &[(0.0, 0.0), (0.14, 0.0), (0.14, 0.85), (0.0, 0.85)], 12);
    let hat = [(0.0, 0.95), (0.26, 0.92), (0.25, 0.98), (0.10, 1.10), (0.0, 1.12)];
    soup.lathe(Material::Galvanised, Crease::Soft, &hat, 12);
    for k in 0..3 {
        let mut leg = Soup::default();
        leg.standing(Material::Galvanised, dvec3(0.12, 0.78, 0.0), dvec3(0.02, 0.2, 0.02));
        soup.put(&leg, turned(DVec3::ZERO, 120.0 * f64::from(k)));
    }
    soup
}

/// The mast that takes the electricity wire.
pub(crate) fn service_mast() -> Soup {
    let mut soup = Soup::default();
    let pipe = [dvec3(0.0, 0.0, 0.0), dvec3(0.0, 2.3, 0.0), dvec3(0.04, 2.48, 0.06), dvec3(0.1, 2.5, 0.16)];
    soup.tube(Material::Galvanised, &pipe, 0.04, 8);
    soup.put(&insulator(), moved(0.0, 2.05, 0.08));
    soup.beam(Material::Iron, dvec3(0.0, 2.06, 0.0), dvec3(0.0, 2.06, 0.12), 0.04, 0.03);
    soup
}

fn insulator() -> Soup {
    let mut soup = Soup::default();
    let profile = [(0.0, 0.0), (0.04, 0.0), (0.045, 0.04), (0.025, 0.06), (0.04, 0.08), (0.03, 0.11), (0.0, 0.12)];
    soup.lathe(Material::Porcelain, Crease::Soft, &profile, 8);
    soup
}
