//! Saguaros.

use glam::{DVec3, dvec3};

use crate::material::Material;
use crate::shapes::turn_about;
use crate::soup::Soup;

/// An arm: height where it leaves the stem, direction in degrees, how far it reaches out and up, in metres.
pub(crate) struct Arm {
    pub(crate) from_m: f64,
    pub(crate) degrees: f64,
    pub(crate) out_m: f64,
    pub(crate) up_m: f64,
}

/// A ribbed stem with arms.
pub(crate) fn saguaro(high_m: f64, arms: &[Arm]) -> Soup {
    let mut soup = Soup::default();
    let stem = [
        (-0.3, 0.16),
        (0.6, 0.19),
        (high_m * 0.6, 0.21),
        (high_m - 0.35, 0.18),
        (high_m - 0.12, 0.14),
        (high_m - 0.02, 0.07),
        (high_m, 0.0),
    ];
    let path: Vec<_> = stem.iter().map(|&(y, r)| (DVec3::Y * y, r)).collect();
    soup.ribbed(Material::Cactus, &path, 24, 0.86);
    for arm in arms {
        soup.ribbed(Material::Cactus, &arm_path(arm), 16, 0.84);
    }
    soup
}

fn arm_path(arm: &Arm) -> Vec<(DVec3, f64)> {
    let turn = turn_about(DVec3::Y, arm.degrees);
    let at = |out: f64, up: f64| turn * dvec3(out, arm.from_m + up, 0.0);
    let (o, u) = (arm.out_m, arm.up_m);
    vec![
        (at(0.05, 0.0), 0.08),
        (at(o * 0.55, -0.02), 0.105),
        (at(o * 0.85, 0.08), 0.115),
        (at(o, 0.30), 0.12),
        (at(o, u * 0.7), 0.125),
        (at(o, u - 0.12), 0.10),
        (at(o, u - 0.02), 0.05),
        (at(o, u), 0.0),
    ]
}
