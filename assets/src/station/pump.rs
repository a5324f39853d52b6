//! The pumps, their islands, and the ice box by the door.

use glam::{DVec2, DVec3, dvec2, dvec3};

use super::canopy::slab;
use crate::material::Material;
use crate::shapes::moved;
use crate::soup::{Crease, Soup};

/// A kerb island with a bollard at each end; stands from 0.1 m below the lot.
pub(crate) fn island() -> Soup {
    let mut soup = Soup::default();
    slab(&mut soup, Material::Concrete, DVec2::ZERO, dvec2(2.1, 0.6), 0.55, [0.0, 0.27]);
    let bollard = [(0.0, 0.2), (0.09, 0.2), (0.09, 1.02), (0.075, 1.08), (0.04, 1.11), (0.0, 1.12)];
    let mut post = Soup::default();
    post.lathe(Material::PaintMustard, Crease::Soft, &bollard, 12);
    soup.put(&post, moved(-1.8, 0.0, 0.0)).put(&post, moved(1.8, 0.0, 0.0));
    soup
}

/// A pump with its hose on the +X side, faces towards +Z and -Z.
pub(crate) fn pump() -> Soup {
    let mut soup = Soup::default();
    soup.bevelled(Material::Iron, dvec3(-0.36, 0.0, -0.27), dvec3(0.36, 0.12, 0.27), 0.02);
    soup.bevelled(Material::PaintRed, dvec3(-0.33, 0.10, -0.24), dvec3(0.33, 0.98, 0.24), 0.05);
    soup.bevelled(Material::PaintCream, dvec3(-0.31, 0.94, -0.22), dvec3(0.31, 1.62, 0.22), 0.07);
    soup.bevelled(Material::PaintRed, dvec3(-0.34, 1.58, -0.25), dvec3(0.34, 1.74, 0.25), 0.05);
    for side in [-1.0, 1.0] {
        let z = |near: f64, far: f64| if side > 0.0 { [near, far] } else { [-far, -near] };
        soup.block(Material::PaintWhite, [-0.22, 0.22], [1.12, 1.50], z(0.20, 0.245));
        soup.block(Material::Dark, [-0.18, 0.18], [1.24, 1.44], z(0.22, 0.255));
        soup.block(Material::PaintWhite, [-0.20, 0.20], [0.30, 0.84], z(0.22, 0.262));
        soup.block(Material::PaintTurquoise, [-0.14, 0.14], [0.48, 0.66], z(0.24, 0.272));
    }
    globe(&mut soup);
    hose(&mut soup);
    soup
}

fn globe(soup: &mut Soup) {
    soup.lathe(Material::Iron, Crease::Soft, &[(0.0, 1.72), (0.11, 1.72), (0.09, 1.80), (0.0, 1.82)], 14);
    soup.ball(Material::PaintWhite, dvec3(0.0, 1.99, 0.0), 0.21, 16);
}

fn hose(soup: &mut Soup) {
    soup.block(Material::Iron, [0.28, 0.42], [1.18, 1.34], [-0.06, 0.06]);
    let nozzle = [dvec3(0.39, 1.36, 0.02), dvec3(0.40, 1.12, 0.03), dvec3(0.43, 1.02, 0.04)];
    soup.tube(Material::Galvanised, &nozzle, 0.026, 8);
    let path: Vec<DVec3> = (0..=16)
        .map(|k| {
            let t = f64::from(k) / 16.0;
            let sag = 4.0 * t * (1.0 - t);
            dvec3(0.33 + 0.20 * sag, 0.40 + 0.64 * t * t + 0.02 - 0.26 * sag, 0.16 - 0.12 * t)
        })
        .collect();
    let mut bent = path;
    bent.push(dvec3(0.425, 1.10, 0.035));
    soup.tube(Material::Rubber, &bent, 0.020, 7);
}

/// A low chest for ice, with two lids.
pub(crate) fn ice_box() -> Soup {
    let mut soup = Soup::default();
    soup.bevelled(Material::PaintWhite, dvec3(-0.85, 0.06, -0.38), dvec3(0.85, 1.25, 0.38), 0.04);
    soup.block(Material::Iron, [-0.78, 0.78], [0.0, 0.08], [-0.30, 0.30]);
    for x in [[-0.78, -0.03], [0.03, 0.78]] {
        soup.bevelled(Material::PaintTurquoise, dvec3(x[0], 0.35, 0.34), dvec3(x[1], 1.05, 0.42), 0.02);
        soup.block(Material::Galvanised, [x[0] + 0.30, x[0] + 0.45], [0.92, 0.96], [0.40, 0.46]);
    }
    soup
}
