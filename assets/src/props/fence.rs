//! A picket fence in two kinds of panel, and a post-and-wire fence for the open land.

use glam::{DAffine3, DVec3, dvec2, dvec3};

use crate::material::Material;
use crate::noise::Rng;
use crate::shapes::turn_about;
use crate::soup::{Crease, Soup};

/// Length of a picket panel along X, in metres.
pub(crate) const PANEL_M: f64 = 2.4;

/// A panel along +X from the origin with its post at the start. `seed` chooses which pickets lean, and one that broke.
pub(crate) fn picket_panel(seed: u32) -> Soup {
    let mut soup = Soup::default();
    let mut rng = Rng::new(seed);
    soup.block(Material::WoodWhite, [-0.05, 0.05], [-0.35, 1.22], [-0.085, 0.015]);
    for y_m in [0.34, 0.92] {
        soup.block(Material::WoodWhite, [-0.03, PANEL_M + 0.01], [y_m, y_m + 0.08], [-0.045, 0.0]);
    }
    let broken = (rng.unit() * 13.0) as i32;
    for k in 0..13 {
        let x_m = PANEL_M * (f64::from(k) + 0.5) / 13.0;
        let high_m = if k == broken { 0.62 } else { rng.range(1.10, 1.20) };
        let lean = turn_about(DVec3::Z, rng.range(-1.6, 1.6));
        soup.put(&picket(high_m, k == broken), DAffine3::from_mat3_translation(lean, dvec3(x_m, 0.0, 0.0)));
    }
    soup
}

fn picket(high_m: f64, broken: bool) -> Soup {
    let (half_m, tip_m) = (0.046, if broken { 0.02 } else { 0.09 });
    let peak_x = if broken { half_m * 0.6 } else { 0.0 };
    let outline = [
        dvec2(-half_m, -0.06),
        dvec2(half_m, -0.06),
        dvec2(half_m, high_m - tip_m),
        dvec2(peak_x, high_m),
        dvec2(-half_m, high_m - tip_m),
    ];
    let mut soup = Soup::default();
    soup.prism(Material::WoodWhite, Crease::Flat, &outline, -0.004, 0.018);
    soup
}

/// One rough post of a wire fence.
pub(crate) fn post() -> Soup {
    let mut soup = Soup::default();
    let path = [(dvec3(0.0, -0.4, 0.0), 0.06), (dvec3(0.015, 0.5, 0.01), 0.055), (dvec3(0.0, 1.25, -0.01), 0.048)];
    soup.taper(Material::Wood, &path, 7);
    soup
}

/// Three strands of wire along posts that stand at `feet_m`.
pub(crate) fn strands(feet_m: &[DVec3]) -> Soup {
    let mut soup = Soup::default();
    for high_m in [0.42, 0.76, 1.10] {
        let path: Vec<DVec3> = feet_m.iter().map(|&foot| foot + dvec3(0.0, high_m, 0.05)).collect();
        soup.tube(Material::Iron, &path, 0.008, 5);
    }
    soup
}
