//! The phone booth. Its glass is left out; the bars throw the shadow.

use glam::dvec3;

use crate::material::Material;
use crate::soup::Soup;

/// A booth 0.96 m square and 2.5 m high, open towards +Z.
pub(crate) fn booth() -> Soup {
    let mut soup = Soup::default();
    soup.block(Material::Concrete, [-0.56, 0.56], [-0.15, 0.06], [-0.56, 0.56]);
    for (x_m, z_m) in [(-0.44, -0.44), (0.44, -0.44), (-0.44, 0.44), (0.44, 0.44)] {
        soup.standing(Material::PaintRed, dvec3(x_m, 0.04, z_m), dvec3(0.08, 2.26, 0.08));
    }
    soup.bevelled(Material::PaintRed, dvec3(-0.53, 2.26, -0.53), dvec3(0.53, 2.50, 0.53), 0.05);
    for (z, high) in [([0.525, 0.55], 0.16), ([-0.55, -0.525], 0.16)] {
        soup.block(Material::PaintWhite, [-0.40, 0.40], [2.38 - high * 0.5, 2.38 + high * 0.5], z);
    }
    for x_m in [-0.44, 0.44] {
        side_bars(&mut soup, x_m);
    }
    soup.block(Material::PaintCream, [-0.42, 0.42], [0.12, 2.28], [-0.45, -0.42]);
    telephone(&mut soup);
    soup
}

fn side_bars(soup: &mut Soup, x_m: f64) {
    soup.block(Material::PaintRed, [x_m - 0.015, x_m + 0.015], [0.12, 0.72], [-0.42, 0.42]);
    for k in 0..5 {
        let y_m = 1.02 + 0.29 * f64::from(k);
        soup.block(Material::PaintRed, [x_m - 0.02, x_m + 0.02], [y_m - 0.018, y_m + 0.018], [-0.42, 0.42]);
    }
    for z_m in [-0.14, 0.14] {
        soup.block(Material::PaintRed, [x_m - 0.014, x_m + 0.014], [0.70, 2.28], [z_m - 0.016, z_m + 0.016]);
    }
}

fn telephone(soup: &mut Soup) {
    soup.bevelled(Material::Dark, dvec3(-0.17, 1.12, -0.43), dvec3(0.17, 1.62, -0.24), 0.03);
    soup.block(Material::Galvanised, [-0.10, 0.12], [1.34, 1.54], [-0.25, -0.23]);
    soup.block(Material::Wood, [-0.34, 0.34], [0.98, 1.02], [-0.43, -0.18]);
    let handset =
        [dvec3(-0.20, 1.58, -0.28), dvec3(-0.22, 1.50, -0.24), dvec3(-0.22, 1.36, -0.24), dvec3(-0.20, 1.28, -0.28)];
    soup.tube(Material::Dark, &handset, 0.026, 7);
    let cord = [
        dvec3(-0.20, 1.29, -0.28),
        dvec3(-0.23, 1.08, -0.25),
        dvec3(-0.16, 0.90, -0.24),
        dvec3(-0.05, 0.95, -0.28),
        dvec3(-0.02, 1.14, -0.33),
    ];
    soup.tube(Material::Galvanised, &cord, 0.010, 5);
}
