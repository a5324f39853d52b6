//! The tall roadside sign: a lattice mast between two pairs of panels, under a sunburst.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3, dvec2, dvec3};

use super::lattice::Lattice;
use crate::material::Material;
use crate::round::arc;
use crate::shapes::turned;
use crate::soup::{Crease, Soup, corner};
use crate::trig::{cos, sin};

/// The whole sign; it stands at the origin and reads from +Z and -Z.
pub(crate) fn sign() -> Soup {
    let mast = Lattice {
        material: Material::PaintNavy,
        y_m: [-0.15, 9.3],
        half_m: [0.42, 0.30],
        bays: 10,
        leg_radius_m: 0.045,
        brace_radius_m: 0.018,
    };
    let mut soup = mast.soup();
    soup.block(Material::Concrete, [-0.75, 0.75], [-0.3, 0.22], [-0.75, 0.75]);
    for degrees in [0.0, 180.0] {
        soup.put(&panel(Material::SignSun, dvec2(2.7, 1.35), 0.14), turned(dvec3(0.0, 7.55, 0.0), degrees));
        soup.put(&panel(Material::SignGas, dvec2(1.25, 0.625), 0.12), turned(dvec3(0.0, 5.3, 0.0), degrees));
    }
    stays(&mut soup);
    soup.put(&sunburst(), turned(dvec3(0.0, 10.35, 0.0), 0.0));
    soup
}

/// A panel 0.42 m in front of the mast's axis, its face towards +Z with the whole texture on it.
fn panel(face: Material, half_m: DVec2, thick_m: f64) -> Soup {
    let mut soup = Soup::default();
    let (front_m, back_m) = (0.42 + thick_m, 0.42);
    let at = |x: f64, y: f64, z: f64| dvec3(x * half_m.x, y * half_m.y, z);
    let rim = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    soup.patch(face, Crease::Flat);
    soup.quad(rim.map(|(x, y)| corner(at(x, y, front_m), dvec2(0.5 + 0.5 * x, 0.5 - 0.5 * y))));
    soup.patch(Material::PaintRed, Crease::Flat);
    for k in 0..4 {
        let ((ax, ay), (bx, by)) = (rim[k], rim[(k + 1) % 4]);
        soup.polygon(&[at(ax, ay, back_m), at(bx, by, back_m), at(bx, by, front_m), at(ax, ay, front_m)]);
    }
    soup.polygon(&[at(-1.0, 1.0, back_m), at(1.0, 1.0, back_m), at(1.0, -1.0, back_m), at(-1.0, -1.0, back_m)]);
    soup
}

/// Rails that hold the panels to the mast.
fn stays(soup: &mut Soup) {
    for (y_m, half_m) in [(6.5, 2.5), (7.55, 2.5), (8.6, 2.5), (4.95, 1.1), (5.65, 1.1)] {
        for z_m in [-0.37, 0.37] {
            soup.block(Material::Iron, [-half_m, half_m], [y_m - 0.035, y_m + 0.035], [z_m - 0.035, z_m + 0.035]);
        }
        for x_m in [-half_m + 0.1, half_m - 0.1] {
            soup.block(Material::Iron, [x_m - 0.02, x_m + 0.02], [y_m - 0.02, y_m + 0.02], [-0.44, 0.44]);
        }
    }
}

/// A disc with sixteen rays on a ring, in the XY plane.
fn sunburst() -> Soup {
    let mut soup = Soup::default();
    let mut disc = arc(DVec2::splat(0.62), 0.0, 360.0, 33);
    disc.pop();
    soup.prism(Material::PaintMustard, Crease::Soft, &disc, -0.11, 0.11);
    soup.tube(Material::Iron, &[dvec3(0.0, -1.3, 0.0), dvec3(0.0, 0.3, 0.0)], 0.06, 8);
    for k in 0..16 {
        let long_m = if k % 2 == 0 { 1.30 } else { 1.02 };
        let ray = [dvec2(0.70, -0.085), dvec2(long_m, -0.012), dvec2(long_m, 0.012), dvec2(0.70, 0.085)];
        let angle = TAU * f64::from(k) / 16.0;
        let outline = ray.map(|p| dvec2(cos(angle), sin(angle)).rotate(p));
        soup.prism(Material::PaintMustard, Crease::Flat, &outline, -0.045, 0.045);
        let spoke = |r: f64| -> DVec3 { (dvec2(cos(angle), sin(angle)) * r).extend(0.0) };
        soup.tube(Material::Iron, &[spoke(0.58), spoke(0.74)], 0.02, 5);
    }
    soup
}
