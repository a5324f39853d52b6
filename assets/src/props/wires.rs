//! Poles along the main road and the wires between them, hanging as catenaries.

use glam::{DVec3, dvec3};

use crate::ground::height_m;
use crate::material::Material;
use crate::noise::mix;
use crate::shapes::{moved, turned};
use crate::soup::{Crease, Soup};

/// Radius of a wire, in metres.
const WIRE_RADIUS_M: f64 = 0.012;
/// Heights of the two cross-arms above the pole's foot, in metres.
const ARM_M: [f64; 2] = [8.35, 7.55];
/// Where the insulators stand along a cross-arm (along Z), in metres.
const INSULATOR_Z_M: [f64; 4] = [-1.05, -0.45, 0.45, 1.05];
/// Top of an insulator's groove above its arm's middle, in metres.
const GROOVE_M: f64 = 0.24;

/// A pole that stands at a place of the ground and is turned by `degrees`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pole {
    pub(crate) x_m: f64,
    pub(crate) z_m: f64,
    pub(crate) degrees: f64,
}

impl Pole {
    /// The pole's foot.
    pub(crate) fn foot_m(self) -> DVec3 {
        dvec3(self.x_m, height_m(self.x_m, self.z_m), self.z_m)
    }

    /// Where wire `k` of cross-arm `arm` is tied.
    fn tie_m(self, arm: usize, k: usize) -> DVec3 {
        let local = dvec3(0.0, ARM_M[arm] + GROOVE_M, INSULATOR_Z_M[k]);
        turned(self.foot_m(), self.degrees).transform_point3(local)
    }
}

/// A wooden pole with two cross-arms (along Z), braces, insulators and step bolts.
pub(crate) fn pole() -> Soup {
    let mut soup = Soup::default();
    let path = [(dvec3(0.0, -0.6, 0.0), 0.17), (dvec3(0.0, 4.0, 0.0), 0.145), (dvec3(0.0, 9.0, 0.0), 0.115)];
    soup.taper(Material::Wood, &path, 9);
    for y_m in ARM_M {
        soup.block(Material::Wood, [0.09, 0.20], [y_m - 0.065, y_m + 0.065], [-1.25, 1.25]);
        for side in [-1.0, 1.0] {
            soup.beam(
                Material::Iron,
                dvec3(0.17, y_m - 0.02, side * 0.75),
                dvec3(0.12, y_m - 0.58, side * 0.05),
                0.03,
                0.02,
            );
        }
        for z_m in INSULATOR_Z_M {
            soup.put(&insulator(), moved(0.145, y_m + 0.05, z_m));
        }
    }
    for k in 0..10 {
        let (y_m, side) = (2.6 + 0.45 * f64::from(k), if k % 2 == 0 { 1.0 } else { -1.0 });
        soup.tube(Material::Iron, &[dvec3(0.0, y_m, side * 0.08), dvec3(0.0, y_m, side * 0.27)], 0.012, 5);
    }
    soup
}

fn insulator() -> Soup {
    let mut soup = Soup::default();
    soup.tube(Material::Iron, &[DVec3::ZERO, DVec3::Y * 0.10], 0.012, 5);
    let bell = [
        (0.0, 0.07),
        (0.055, 0.06),
        (0.06, 0.11),
        (0.035, 0.14),
        (0.045, 0.16),
        (0.03, 0.19),
        (0.042, 0.21),
        (0.0, 0.235),
    ];
    soup.lathe(Material::Porcelain, Crease::Soft, &bell, 8);
    soup
}

/// A transformer can that hangs on a pole's -X side, its fuse arms above.
pub(crate) fn transformer() -> Soup {
    let mut soup = Soup::default();
    let can = [(0.0, 0.0), (0.24, 0.02), (0.25, 0.10), (0.25, 0.85), (0.22, 0.92), (0.0, 0.95)];
    soup.lathe(Material::Galvanised, Crease::Soft, &can, 16);
    for z_m in [-0.12, 0.12] {
        soup.put(&insulator(), moved(0.0, 0.90, z_m));
    }
    for y_m in [0.25, 0.7] {
        soup.block(Material::Iron, [0.2, 0.42], [y_m - 0.03, y_m + 0.03], [-0.05, 0.05]);
    }
    soup
}

/// Every wire between the poles, and the service drop to the shop's mast at `mast_m`.
pub(crate) fn wires(poles: &[Pole], mast_m: DVec3, drop_from: usize) -> Soup {
    let mut soup = Soup::default();
    for pair in poles.windows(2) {
        for (arm, k) in [(0, 0), (0, 1), (0, 2), (0, 3), (1, 0), (1, 3)] {
            let sag_m = 0.55 + 0.10 * arm as f64 + 0.05 * k as f64;
            wire(&mut soup, groove(pair[0], arm, k), groove(pair[1], arm, k), sag_m);
        }
    }
    for k in [0, 1] {
        let side = dvec3(0.0, 0.12 * k as f64, 0.0);
        wire(&mut soup, groove(poles[drop_from], 1, k), mast_m + side, 0.5 + 0.07 * k as f64);
    }
    soup
}

/// The tie point, moved onto the insulator, which stands beside the pole.
fn groove(pole: Pole, arm: usize, k: usize) -> DVec3 {
    let beside = turned(DVec3::ZERO, pole.degrees).transform_point3(DVec3::X * 0.145);
    pole.tie_m(arm, k) + beside
}

/// A wire that hangs `sag_m` below the straight line in its middle.
fn wire(soup: &mut Soup, a_m: DVec3, b_m: DVec3, sag_m: f64) {
    let count = 14;
    let path: Vec<DVec3> = (0..=count)
        .map(|k| {
            let t = f64::from(k) / f64::from(count);
            a_m.lerp(b_m, t) - DVec3::Y * hang(t, a_m.distance(b_m), sag_m)
        })
        .collect();
    soup.tube(Material::Dark, &path, WIRE_RADIUS_M, 5);
}

/// How far a catenary hangs below its chord at the fraction `t`, when it hangs `sag_m` in the middle.
fn hang(t: f64, span_m: f64, sag_m: f64) -> f64 {
    // The catenary's parameter from the parabola that it is near to; its shape then follows from cosh.
    let parameter_m = span_m * span_m / (8.0 * sag_m);
    let rise_m = |x_m: f64| parameter_m * (cosh(x_m / parameter_m) - 1.0);
    let ends_m = rise_m(span_m * 0.5);
    mix(0.0, sag_m, (ends_m - rise_m(span_m * (t - 0.5))) / ends_m)
}

/// Hyperbolic cosine of a small number.
fn cosh(x: f64) -> f64 {
    let s = x * x;
    1.0 + s / 2.0 * (1.0 + s / 12.0 * (1.0 + s / 30.0 * (1.0 + s / 56.0)))
}
