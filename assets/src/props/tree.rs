//! A mesquite tree: branches that fork, and leaf cards on the thin ones.

use glam::{DVec3, dvec3};

use super::clutter::leaf_card;
use crate::material::Material;
use crate::noise::Rng;
use crate::shapes::turn_about;
use crate::soup::Soup;

/// Wood (closed) and leaves (open cards) of one tree.
pub(crate) struct Tree {
    pub(crate) wood: Soup,
    pub(crate) leaves: Soup,
}

/// A branch yet to grow.
#[derive(Debug, Clone, Copy)]
struct Shoot {
    root_m: DVec3,
    along: DVec3,
    long_m: f64,
    radius_m: f64,
    /// Forks that may still follow.
    forks: u32,
}

/// A tree about 6 m high with its root at the origin.
pub(crate) fn mesquite(seed: u32) -> Tree {
    let mut tree = Tree { wood: Soup::default(), leaves: Soup::default() };
    let mut rng = Rng::new(seed);
    let trunk = Shoot {
        root_m: DVec3::Y * -0.25,
        along: dvec3(0.12, 1.0, 0.06).normalize(),
        long_m: 1.7,
        radius_m: 0.21,
        forks: 5,
    };
    tree.grow(trunk, &mut rng);
    tree
}

impl Tree {
    fn grow(&mut self, shoot: Shoot, rng: &mut Rng) {
        let path = bent(shoot, rng);
        let sides = if shoot.radius_m > 0.10 { 8 } else { 5 };
        self.wood.taper(Material::Bark, &path, sides);
        let (tip, radius_m) = path[path.len() - 1];
        if shoot.forks < 3 {
            self.dress(&path, shoot, rng);
        }
        if shoot.forks == 0 {
            return;
        }
        let count = if shoot.forks >= 4 { 3 } else { 2 };
        let first = rng.range(0.0, 360.0);
        for k in 0..count {
            let along = fork(shoot, first + 360.0 * f64::from(k) / f64::from(count), rng);
            let long_m = shoot.long_m * rng.range(0.66, 0.84);
            let root_m = tip - along * (radius_m * 0.3);
            self.grow(Shoot { root_m, along, long_m, radius_m: radius_m * 0.78, forks: shoot.forks - 1 }, rng);
        }
    }

    /// Leaf cards along a thin branch.
    fn dress(&mut self, path: &[(DVec3, f64)], shoot: Shoot, rng: &mut Rng) {
        let count = [6, 3, 1][shoot.forks as usize];
        for _ in 0..count {
            let t = rng.range(0.15, 1.0) * (path.len() - 1) as f64;
            let k = (t as usize).min(path.len() - 2);
            let at = path[k].0.lerp(path[k + 1].0, t - k as f64);
            let droop = shoot.along * 0.8 + DVec3::Y * rng.range(-0.5, 0.5);
            leaf_card(&mut self.leaves, at, droop, rng.range(0.42, 0.66), rng);
        }
    }
}

/// The directions of branches after a fork: aside, a little up, never steeply down.
fn fork(shoot: Shoot, around_deg: f64, rng: &mut Rng) -> DVec3 {
    let aside = shoot.along.any_orthonormal_vector();
    let tilt = turn_about(aside, rng.range(26.0, 46.0)) * shoot.along;
    let mut along = turn_about(shoot.along, around_deg + rng.range(-25.0, 25.0)) * tilt;
    along.y = (along.y + 0.10).max(-0.05);
    along.normalize()
}

/// A slightly crooked path with a radius at each point.
fn bent(shoot: Shoot, rng: &mut Rng) -> Vec<(DVec3, f64)> {
    let parts = if shoot.forks > 2 { 4 } else { 2 };
    let (mut at, mut along) = (shoot.root_m, shoot.along);
    let mut path = vec![(at, shoot.radius_m)];
    for k in 1..=parts {
        along = (along + dvec3(rng.range(-0.2, 0.2), rng.range(-0.12, 0.16), rng.range(-0.2, 0.2))).normalize();
        at += along * (shoot.long_m / f64::from(parts));
        path.push((at, shoot.radius_m * (1.0 - 0.28 * f64::from(k) / f64::from(parts))));
    }
    path
}
