//! The canopy: two slabs with a slatted gap between them, on four posts, with the station's name standing on top.

use glam::{DAffine3, DVec2, DVec3, dvec2, dvec3};

use crate::letters::width_of;
use crate::material::Material;
use crate::round::rounded_rectangle;
use crate::shapes::turn_about;
use crate::soup::{Crease, Soup};

/// Range of x that the canopy covers, in metres.
const X_M: [f64; 2] = [-3.2, 9.6];
/// Height of its underside and of its top.
const LOW_M: f64 = 4.46;
const HIGH_M: f64 = 4.84;

/// A horizontal slab with round corners between two heights.
pub(crate) fn slab(soup: &mut Soup, material: Material, middle_m: DVec2, half_m: DVec2, radius_m: f64, y_m: [f64; 2]) {
    let mut plate = Soup::default();
    plate.prism(material, Crease::Soft, &rounded_rectangle(half_m, radius_m, 7), y_m[0], y_m[1]);
    let lie_down = turn_about(DVec3::X, -90.0);
    soup.put(&plate, DAffine3::from_mat3_translation(lie_down, dvec3(middle_m.x, 0.0, middle_m.y)));
}

/// Slabs, fascia bands, slats, girders and lamps.
pub(crate) fn canopy() -> Soup {
    let mut soup = Soup::default();
    let (middle_x, half_x) = ((X_M[0] + X_M[1]) * 0.5, (X_M[1] - X_M[0]) * 0.5);
    for z in [[0.5, 3.8], [5.4, 8.5]] {
        let (middle, half) = (dvec2(middle_x, (z[0] + z[1]) * 0.5), dvec2(half_x, (z[1] - z[0]) * 0.5));
        slab(&mut soup, Material::PaintCream, middle, half, 0.45, [LOW_M, HIGH_M]);
        slab(&mut soup, Material::PaintRed, middle, half + DVec2::splat(0.05), 0.5, [LOW_M + 0.12, LOW_M + 0.24]);
    }
    slats(&mut soup);
    girders(&mut soup);
    soup
}

fn slats(soup: &mut Soup) {
    let count = 36;
    for k in 0..count {
        let x_m = X_M[0] + 0.55 + (X_M[1] - X_M[0] - 1.1) * f64::from(k) / f64::from(count - 1);
        let tilt = turn_about(DVec3::Z, -28.0);
        let mut slat = Soup::default();
        slat.block(Material::PaintWhite, [-0.018, 0.018], [-0.11, 0.11], [3.7, 5.5]);
        soup.put(&slat, DAffine3::from_mat3_translation(tilt, dvec3(x_m, 4.66, 0.0)));
    }
    for x_m in [X_M[0] + 0.28, X_M[1] - 0.28] {
        soup.block(Material::PaintCream, [x_m - 0.09, x_m + 0.09], [LOW_M + 0.02, HIGH_M - 0.02], [3.6, 5.6]);
    }
}

fn girders(soup: &mut Soup) {
    for x_m in [-1.5, 7.9] {
        for (x, y) in [([-0.08, 0.08], [4.20, 4.23]), ([-0.015, 0.015], [4.215, 4.48]), ([-0.08, 0.08], [4.44, 4.47])] {
            soup.block(Material::PaintTurquoise, x.map(|v| v + x_m), y, [0.9, 8.1]);
        }
    }
    for (x_m, z_m) in [(0.6, 2.2), (5.8, 2.2), (0.6, 6.9), (5.8, 6.9)] {
        soup.bevelled(
            Material::PaintWhite,
            dvec3(x_m - 0.6, 4.36, z_m - 0.11),
            dvec3(x_m + 0.6, 4.48, z_m + 0.11),
            0.03,
        );
    }
}

/// A round post with a foot.
pub(crate) fn post() -> Soup {
    let mut soup = Soup::default();
    let profile = [(0.0, 0.0), (0.20, 0.0), (0.20, 0.22), (0.12, 0.32), (0.085, 0.36), (0.085, 4.33), (0.0, 4.33)];
    soup.lathe(Material::PaintTurquoise, Crease::Soft, &profile, 16);
    soup
}

/// The name in letters 1.05 m high, on two rails and struts; the origin is the roof below the middle.
pub(crate) fn standing_name() -> Soup {
    let mut soup = Soup::default();
    let high_m = 1.05;
    let half_m = width_of("SUNBAKE") * high_m * 0.5 + 0.25;
    let mut text = Soup::default();
    text.letters(Material::PaintRed, "SUNBAKE", high_m, 0.17, 0.16);
    soup.put(&text, crate::shapes::moved(0.0, 0.32 + high_m * 0.5, 0.0));
    for y_m in [0.42, 1.12] {
        soup.tube(Material::Iron, &[dvec3(-half_m, y_m, -0.13), dvec3(half_m, y_m, -0.13)], 0.022, 6);
    }
    for k in 0..6 {
        let x_m = -half_m + 0.1 + (2.0 * half_m - 0.2) * f64::from(k) / 5.0;
        soup.tube(Material::Iron, &[dvec3(x_m, -0.05, -0.13), dvec3(x_m, 1.2, -0.13)], 0.022, 6);
        soup.tube(Material::Iron, &[dvec3(x_m, -0.05, -0.85), dvec3(x_m, 1.1, -0.13)], 0.018, 6);
    }
    soup
}
