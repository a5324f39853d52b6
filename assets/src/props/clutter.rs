//! Barrels, tyres, rocks and shrubs: small things that are used many times.

use std::f64::consts::TAU;

use glam::{DVec3, dvec2, dvec3};

use crate::material::Material;
use crate::noise::{Rng, fbm};
use crate::shapes::moved;
use crate::soup::{Crease, Soup, corner};
use crate::trig::{cos, sin};

/// An oil barrel 0.88 m high with two beads and a sunken lid.
pub(crate) fn barrel(material: Material) -> Soup {
    let mut soup = Soup::default();
    let profile = [
        (0.0, 0.0),
        (0.29, 0.0),
        (0.29, 0.28),
        (0.305, 0.30),
        (0.29, 0.32),
        (0.29, 0.56),
        (0.305, 0.58),
        (0.29, 0.60),
        (0.29, 0.86),
        (0.30, 0.88),
        (0.28, 0.88),
        (0.27, 0.855),
        (0.0, 0.855),
    ];
    soup.lathe(material, Crease::Soft, &profile, 20);
    let mut bung = Soup::default();
    bung.lathe(Material::Iron, Crease::Soft, &[(0.0, 0.84), (0.035, 0.84), (0.035, 0.875), (0.0, 0.875)], 8);
    soup.put(&bung, moved(0.17, 0.0, 0.0));
    soup
}

/// A tyre lying flat; its middle is the origin.
pub(crate) fn tyre() -> Soup {
    let mut soup = Soup::default();
    let profile = [
        (0.19, -0.075),
        (0.21, -0.095),
        (0.27, -0.105),
        (0.315, -0.085),
        (0.335, -0.05),
        (0.34, 0.0),
        (0.335, 0.05),
        (0.315, 0.085),
        (0.27, 0.105),
        (0.21, 0.095),
        (0.19, 0.075),
        (0.225, 0.0),
    ];
    soup.lathe(Material::Rubber, Crease::Smooth, &profile, 24);
    soup
}

/// A boulder about 1 m across, half of it meant to be below the ground.
pub(crate) fn rock(seed: u32) -> Soup {
    let mut soup = Soup::default();
    soup.ball(Material::Rock, DVec3::ZERO, 0.5, 14);
    soup.warp(|p| {
        let dent = fbm(p.x * 3.1 + p.y * 1.9 + 20.0, p.z * 3.1 - p.y * 2.3 + 20.0, 3, 0, seed) - 0.5;
        p * dvec3(1.15, 0.78, 0.95) * (1.0 + 0.9 * dent)
    });
    for patch in &mut soup.patches {
        patch.crease = Crease::Soft;
    }
    soup
}

/// A desert bush about 1 m high: twigs from one root, with leaf cards on their upper halves.
pub(crate) fn shrub(seed: u32) -> Soup {
    let mut soup = Soup::default();
    let mut rng = Rng::new(seed);
    for k in 0..11 {
        let angle = TAU * (f64::from(k) + rng.range(-0.3, 0.3)) / 11.0;
        let (reach_m, high_m) = (rng.range(0.30, 0.70), rng.range(0.35, 0.85));
        let out = dvec3(cos(angle), 0.0, sin(angle));
        let tip = out * reach_m + DVec3::Y * high_m;
        let knee = out * reach_m * 0.35 + DVec3::Y * high_m * 0.55;
        soup.taper(Material::Twig, &[(DVec3::Y * -0.1, 0.014), (knee, 0.010), (tip, 0.004)], 3);
        for _ in 0..4 {
            let at = knee.lerp(tip, rng.range(0.3, 1.05));
            leaf_card(&mut soup, at, out * 0.6 + DVec3::Y, rng.range(0.20, 0.32), &mut rng);
        }
    }
    soup
}

/// A square leaf card of `size_m` that grows from `root_m` roughly along `along`, turned at random.
pub(crate) fn leaf_card(soup: &mut Soup, root_m: DVec3, along: DVec3, size_m: f64, rng: &mut Rng) {
    let jitter = dvec3(rng.range(-0.6, 0.6), rng.range(-0.4, 0.5), rng.range(-0.6, 0.6));
    let up = (along.normalize() + jitter).normalize();
    let side = up.cross(dvec3(rng.range(-1.0, 1.0), rng.range(-0.3, 0.3), rng.range(-1.0, 1.0))).normalize_or(DVec3::X);
    let (half, tip) = (side * size_m * 0.5, root_m + up * size_m);
    soup.patch(Material::Leaf, Crease::Flat);
    soup.quad([
        corner(root_m - half, dvec2(0.0, 1.0)),
        corner(root_m + half, dvec2(1.0, 1.0)),
        corner(tip + half, dvec2(1.0, 0.0)),
        corner(tip - half, dvec2(0.0, 0.0)),
    ]);
}
