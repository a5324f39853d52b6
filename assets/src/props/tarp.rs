//! A car under a tarpaulin. The cloth is simulated: a net of points that fall, keep their distances and slide over the
//! car. Based on: Müller and others, *Position Based Dynamics*, 2007. Only `+ - * /` and square roots, so the folds are
//! the same everywhere.

use glam::{DVec3, dvec2, dvec3};

use crate::material::Material;
use crate::noise::lattice;
use crate::soup::{Crease, Soup, corner};

/// Points of the net along the car and across it, and the length of a mesh, in metres.
const ALONG: usize = 68;
const ACROSS: usize = 46;
const MESH_M: f64 = 0.084;
const STEPS: usize = 260;
const ROUNDS: usize = 14;
/// Seconds a step.
const STEP_S: f64 = 1.0 / 60.0;
/// How far the cloth stays off the car and the ground, in metres.
const THICK_M: f64 = 0.025;

/// A box with round edges, part of the car's shape; metres.
struct Lump {
    middle_m: DVec3,
    half_m: DVec3,
    radius_m: f64,
}

impl Lump {
    fn distance_m(&self, p_m: DVec3) -> f64 {
        let q = (p_m - self.middle_m).abs() - self.half_m + DVec3::splat(self.radius_m);
        q.max(DVec3::ZERO).length() + q.max_element().min(0.0) - self.radius_m
    }
}

fn lump(middle_m: [f64; 3], half_m: [f64; 3], radius_m: f64) -> Lump {
    Lump { middle_m: middle_m.into(), half_m: half_m.into(), radius_m }
}

/// A saloon 4.6 m long along X, its bonnet at +X.
fn car() -> Vec<Lump> {
    let mut lumps = vec![
        lump([0.0, 0.60, 0.0], [2.28, 0.24, 0.86], 0.20),
        lump([1.2, 0.72, 0.0], [1.0, 0.20, 0.74], 0.16),
        lump([-1.75, 0.76, 0.0], [0.5, 0.20, 0.78], 0.16),
        lump([-0.30, 1.18, 0.0], [0.86, 0.24, 0.66], 0.20),
        lump([-0.35, 0.98, 0.0], [1.22, 0.14, 0.72], 0.12),
    ];
    for side in [-1.0, 1.0] {
        lumps.push(lump([0.62, 0.98, 0.93 * side], [0.07, 0.07, 0.12], 0.06));
        lumps.push(lump([2.18, 0.72, 0.62 * side], [0.14, 0.11, 0.14], 0.10));
        lumps.push(lump([-2.0, 0.90, 0.74 * side], [0.34, 0.14, 0.05], 0.04));
    }
    lumps
}

fn distance_m(car: &[Lump], p_m: DVec3) -> f64 {
    car.iter().map(|lump| lump.distance_m(p_m)).fold(f64::INFINITY, f64::min)
}

/// The direction away from the car.
fn away(car: &[Lump], p_m: DVec3) -> DVec3 {
    let step = 1e-3;
    let slope = |axis: DVec3| distance_m(car, p_m + axis * step) - distance_m(car, p_m - axis * step);
    dvec3(slope(DVec3::X), slope(DVec3::Y), slope(DVec3::Z)).normalize_or(DVec3::Y)
}

struct Cloth {
    now_m: Vec<DVec3>,
    before_m: Vec<DVec3>,
    links: Vec<Link>,
}

/// Two points that stay `rest_m` apart; a soft link (below 1) only resists bending.
struct Link {
    a: usize,
    b: usize,
    rest_m: f64,
    stiffness: f64,
}

fn index(i: usize, k: usize) -> usize {
    i * ACROSS + k
}

impl Cloth {
    /// A flat sheet above the car, slightly askew and uneven.
    fn spread() -> Self {
        let at = |i: usize, k: usize| {
            let (u, v) = (i as f64 - 0.5 * (ALONG - 1) as f64, k as f64 - 0.5 * (ACROSS - 1) as f64);
            let uneven = 0.02 * lattice(i as i32, k as i32, 301);
            dvec3(u * MESH_M - 0.03 + 0.05 * v * MESH_M, 1.50 + uneven, v * MESH_M + 0.05 - 0.05 * u * MESH_M)
        };
        let now_m: Vec<_> = (0..ALONG).flat_map(|i| (0..ACROSS).map(move |k| at(i, k))).collect();
        Self { before_m: now_m.clone(), now_m, links: links() }
    }

    fn step(&mut self, car: &[Lump]) {
        for (now, before) in self.now_m.iter_mut().zip(&mut self.before_m) {
            let velocity = (*now - *before) * 0.985;
            *before = *now;
            *now += velocity - DVec3::Y * (9.81 * STEP_S * STEP_S);
        }
        for _ in 0..ROUNDS {
            self.keep_distances();
        }
        self.keep_out(car);
    }

    fn keep_distances(&mut self) {
        for link in &self.links {
            let apart = self.now_m[link.b] - self.now_m[link.a];
            let long_m = apart.length();
            let fix = apart * (0.5 * link.stiffness * (long_m - link.rest_m) / long_m);
            self.now_m[link.a] += fix;
            self.now_m[link.b] -= fix;
        }
    }

    /// Pushes points out of the car and the ground; what touches sticks half.
    fn keep_out(&mut self, car: &[Lump]) {
        for (now, before) in self.now_m.iter_mut().zip(&mut self.before_m) {
            let inside_m = THICK_M - distance_m(car, *now);
            if inside_m > 0.0 {
                *now += away(car, *now) * inside_m;
                *before = before.lerp(*now, 0.55);
            }
            if now.y < THICK_M {
                now.y = THICK_M;
                *before = before.lerp(*now, 0.8);
            }
        }
    }
}

fn links() -> Vec<Link> {
    let mut links = Vec::new();
    for i in 0..ALONG {
        for k in 0..ACROSS {
            for (di, dk, stiffness) in
                [(1, 0, 1.0), (0, 1, 1.0), (1, 1, 0.35), (1, -1, 0.35), (2, 0, 0.10), (0, 2, 0.10)]
            {
                let (ni, nk) = (i + di, k as i64 + dk);
                if ni < ALONG && (0..ACROSS as i64).contains(&nk) {
                    let rest_m = MESH_M * dvec2(di as f64, dk as f64).length();
                    links.push(Link { a: index(i, k), b: index(ni, nk as usize), rest_m, stiffness });
                }
            }
        }
    }
    links
}

/// The tarpaulin, an open sheet; the car's middle is the origin, its bonnet points to +X.
pub(crate) fn tarpaulin() -> Soup {
    let car = car();
    let mut cloth = Cloth::spread();
    for _ in 0..STEPS {
        cloth.step(&car);
    }
    let mut soup = Soup::default();
    soup.patch(Material::Tarp, Crease::Smooth);
    let at = |i: usize, k: usize| corner(cloth.now_m[index(i, k)], dvec2(i as f64, k as f64) * MESH_M);
    for i in 1..ALONG {
        for k in 1..ACROSS {
            soup.quad([at(i - 1, k - 1), at(i - 1, k), at(i, k), at(i, k - 1)]);
        }
    }
    soup
}

/// What shows below the cloth: a dark floor pan and axles. The wheels are tyres of their own.
pub(crate) fn underside() -> Soup {
    let mut soup = Soup::default();
    soup.bevelled(Material::Dark, dvec3(-2.1, 0.30, -0.70), dvec3(2.1, 0.62, 0.70), 0.05);
    for x_m in [-1.35, 1.38] {
        soup.tube(Material::Iron, &[dvec3(x_m, 0.33, -0.70), dvec3(x_m, 0.33, 0.70)], 0.14, 10);
    }
    soup
}
