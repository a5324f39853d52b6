//! What stands in the shop: it is seen through the windows, and the sun walks over it.

use glam::{DVec3, dvec3};

use super::shop::FLOOR_M;
use crate::material::Material;
use crate::noise::Rng;
use crate::soup::{Crease, Soup};

/// The counter along the right side, with a till and jars. In the station's frame.
pub(crate) fn counter() -> Soup {
    let mut soup = Soup::default();
    let foot = FLOOR_M - 0.02;
    soup.block(Material::PaintTurquoise, [6.4, 8.6], [foot, 1.05], [-6.5, -5.95]);
    soup.bevelled(Material::Wood, dvec3(6.3, 1.04, -6.6), dvec3(8.7, 1.10, -5.82), 0.015);
    soup.block(Material::PaintTurquoise, [6.4, 6.95], [foot, 1.04], [-8.4, -6.45]);
    soup.bevelled(Material::Wood, dvec3(6.3, 1.045, -8.5), dvec3(7.05, 1.095, -6.5), 0.015);
    soup.bevelled(Material::PaintCream, dvec3(6.6, 1.09, -7.4), dvec3(6.95, 1.38, -6.95), 0.04);
    soup.bevelled(Material::Dark, dvec3(6.72, 1.36, -7.36), dvec3(6.90, 1.55, -7.0), 0.03);
    for (k, x_m) in [7.3, 7.55, 7.8].into_iter().enumerate() {
        let colour = [Material::PaintRed, Material::PaintMustard, Material::Porcelain][k];
        soup.put(&jar(colour), crate::shapes::moved(x_m, 1.09, -6.2));
    }
    soup
}

fn jar(material: Material) -> Soup {
    let mut soup = Soup::default();
    let profile = [(0.0, 0.0), (0.07, 0.0), (0.08, 0.03), (0.08, 0.15), (0.05, 0.19), (0.055, 0.22), (0.0, 0.22)];
    soup.lathe(material, Crease::Soft, &profile, 10);
    soup
}

/// A shelf rack, 1.8 m long in z, with goods on four boards.
pub(crate) fn shelf() -> Soup {
    let mut soup = Soup::default();
    let mut rng = Rng::new(401);
    for z_m in [-0.9, 0.9] {
        for x_m in [-0.22, 0.22] {
            soup.standing(Material::PaintWhite, dvec3(x_m, 0.0, z_m), dvec3(0.04, 1.72, 0.04));
        }
    }
    for k in 0..4 {
        let y_m = 0.18 + 0.44 * f64::from(k);
        soup.block(Material::PaintWhite, [-0.25, 0.25], [y_m, y_m + 0.03], [-0.93, 0.93]);
        goods(&mut soup, y_m + 0.025, &mut rng);
    }
    soup
}

/// One row of tins and packets, with gaps.
fn goods(soup: &mut Soup, y_m: f64, rng: &mut Rng) {
    const COLOURS: [Material; 6] = [
        Material::PaintRed,
        Material::PaintMustard,
        Material::PaintTurquoise,
        Material::PaintCream,
        Material::PaintNavy,
        Material::PaintWhite,
    ];
    let mut z_m = -0.82;
    while z_m < 0.76 {
        let colour = COLOURS[(rng.unit() * 6.0) as usize];
        let wide_m = rng.range(0.10, 0.20);
        let size = dvec3(rng.range(0.16, 0.36), rng.range(0.14, 0.30), wide_m);
        if rng.unit() > 0.22 {
            soup.standing(colour, dvec3(0.0, y_m, z_m + wide_m * 0.5), size);
        }
        z_m += wide_m + rng.range(0.015, 0.05);
    }
}

/// A tall fridge with two framed doors towards +Z.
pub(crate) fn fridge() -> Soup {
    let mut soup = Soup::default();
    soup.bevelled(Material::PaintWhite, dvec3(-0.7, 0.0, -0.35), dvec3(0.7, 2.0, 0.30), 0.03);
    for x in [[-0.66, -0.02], [0.02, 0.66]] {
        soup.block(Material::Dark, x, [0.25, 1.75], [0.28, 0.33]);
        soup.block(Material::Galvanised, [x[0] + 0.04, x[0] + 0.07], [0.8, 1.3], [0.32, 0.38]);
    }
    soup.block(Material::PaintRed, [-0.68, 0.68], [1.79, 1.96], [0.29, 0.34]);
    soup
}

/// A ceiling fan that hangs from the skylight's bar; the origin is where it is fixed.
pub(crate) fn fan() -> Soup {
    let mut soup = Soup::default();
    soup.block(Material::PaintWhite, [-0.95, 0.95], [0.0, 0.05], [-0.03, 0.03]);
    soup.tube(Material::Iron, &[dvec3(0.0, 0.02, 0.0), dvec3(0.0, -0.75, 0.0)], 0.02, 8);
    soup.lathe(
        Material::Iron,
        Crease::Soft,
        &[(0.0, -0.90), (0.08, -0.88), (0.11, -0.80), (0.08, -0.72), (0.0, -0.70)],
        12,
    );
    for k in 0..4 {
        let mut blade = Soup::default();
        blade.block(Material::Wood, [0.08, 0.78], [-0.81, -0.79], [-0.07, 0.07]);
        soup.put(&blade, crate::shapes::turned(DVec3::ZERO, 90.0 * f64::from(k)));
    }
    soup
}

/// A round stool.
pub(crate) fn stool() -> Soup {
    let mut soup = Soup::default();
    let foot = [(0.0, 0.0), (0.20, 0.0), (0.19, 0.03), (0.03, 0.06), (0.03, 0.66), (0.0, 0.66)];
    soup.lathe(Material::Galvanised, Crease::Soft, &foot, 12);
    let seat = [(0.0, 0.64), (0.17, 0.64), (0.19, 0.67), (0.19, 0.71), (0.15, 0.74), (0.0, 0.74)];
    soup.lathe(Material::PaintRed, Crease::Soft, &seat, 14);
    soup
}
