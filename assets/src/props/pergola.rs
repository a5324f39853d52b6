//! A slatted pergola, the benches and the table below it.

use glam::dvec3;

use crate::material::Material;
use crate::soup::Soup;

/// A pergola 4.4 m by 3.4 m; its slats run along Z.
pub(crate) fn pergola() -> Soup {
    let mut soup = Soup::default();
    for (x_m, z_m) in [(-1.9, -1.4), (1.9, -1.4), (-1.9, 1.4), (1.9, 1.4)] {
        soup.standing(Material::Wood, dvec3(x_m, -0.3, z_m), dvec3(0.13, 2.72, 0.13));
        let inward = if x_m > 0.0 { -1.0 } else { 1.0 };
        soup.beam(Material::Wood, dvec3(x_m, 1.85, z_m), dvec3(x_m + inward * 0.5, 2.38, z_m), 0.07, 0.07);
    }
    for z_m in [-1.4, 1.4] {
        soup.block(Material::Wood, [-2.2, 2.2], [2.33, 2.51], [z_m - 0.05, z_m + 0.05]);
    }
    for k in 0..17 {
        let x_m = -2.08 + 0.26 * f64::from(k);
        soup.block(Material::Wood, [x_m - 0.028, x_m + 0.028], [2.49, 2.64], [-1.75, 1.75]);
    }
    soup
}

/// A bench 1.7 m long, facing +Z, with an arm rest at its +X end only.
pub(crate) fn bench() -> Soup {
    let mut soup = Soup::default();
    for x_m in [-0.68, 0.68] {
        soup.beam(Material::Iron, dvec3(x_m, -0.04, 0.20), dvec3(x_m, 0.42, 0.16), 0.05, 0.04);
        soup.beam(Material::Iron, dvec3(x_m, -0.04, -0.26), dvec3(x_m, 0.42, -0.16), 0.05, 0.04);
        soup.beam(Material::Iron, dvec3(x_m, 0.40, -0.16), dvec3(x_m, 0.90, -0.30), 0.05, 0.035);
        soup.block(Material::Iron, [x_m - 0.022, x_m + 0.022], [0.39, 0.43], [-0.2, 0.2]);
    }
    for k in 0..4 {
        let z_m = -0.17 + 0.115 * f64::from(k);
        soup.block(Material::PaintTurquoise, [-0.85, 0.85], [0.425, 0.46], [z_m - 0.047, z_m + 0.047]);
    }
    for (y_m, z_m) in [(0.57, -0.185), (0.70, -0.222), (0.83, -0.258)] {
        soup.block(Material::PaintTurquoise, [-0.85, 0.85], [y_m - 0.045, y_m + 0.045], [z_m - 0.012, z_m + 0.018]);
    }
    soup.beam(Material::Iron, dvec3(0.80, 0.44, 0.19), dvec3(0.80, 0.66, 0.19), 0.035, 0.035);
    soup.block(Material::Wood, [0.765, 0.835], [0.65, 0.685], [-0.24, 0.24]);
    soup
}

/// A round table.
pub(crate) fn table() -> Soup {
    let mut soup = Soup::default();
    let foot = [(0.0, -0.02), (0.26, -0.02), (0.24, 0.03), (0.04, 0.07), (0.04, 0.72), (0.0, 0.72)];
    soup.lathe(Material::Iron, crate::soup::Crease::Soft, &foot, 14);
    let top = [(0.0, 0.70), (0.46, 0.70), (0.48, 0.715), (0.48, 0.735), (0.46, 0.75), (0.0, 0.75)];
    soup.lathe(Material::PaintCream, crate::soup::Crease::Soft, &top, 24);
    soup
}
