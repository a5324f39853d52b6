//! Tubes, turned (lathe) shapes and balls: closed shapes with smooth sides.

use std::f64::consts::TAU;

use glam::{DMat3, DVec2, DVec3, dvec2, dvec3};

use crate::material::Material;
use crate::shapes::frame_along;
use crate::soup::{Corner, Crease, Soup, corner};
use crate::trig::{cos, sin};

impl Soup {
    /// A tube of one radius along `path_m`, with flat caps.
    pub(crate) fn tube(&mut self, material: Material, path_m: &[DVec3], radius_m: f64, sides: usize) -> &mut Self {
        let path: Vec<_> = path_m.iter().map(|&p| (p, radius_m)).collect();
        self.taper(material, &path, sides)
    }

    /// A tube along points with a radius each, with flat caps. A radius of 0 at an end makes a tip.
    pub(crate) fn taper(&mut self, material: Material, path_m: &[(DVec3, f64)], sides: usize) -> &mut Self {
        self.ribbed(material, path_m, sides, 1.0)
    }

    /// A [`Soup::taper`] whose every second edge lies at `rib` times the radius.
    pub(crate) fn ribbed(&mut self, material: Material, path_m: &[(DVec3, f64)], sides: usize, rib: f64) -> &mut Self {
        let rings = tube_rings(path_m, sides, rib);
        // A pentagon turns by 72 degrees from side to side: too much for `Soft`.
        let crease = match sides {
            0..=4 => Crease::Flat,
            5..=7 => Crease::Smooth,
            _ => Crease::Soft,
        };
        let girth_m = TAU * path_m.iter().fold(0.0, |most: f64, p| most.max(p.1));
        self.patch(material, crease);
        let mut along_m = 0.0;
        for k in 1..rings.len() {
            let next_m = along_m + path_m[k].0.distance(path_m[k - 1].0);
            self.band(&rings[k - 1], &rings[k], along_m, next_m, girth_m);
            along_m = next_m;
        }
        let first: Vec<_> = rings[0].iter().rev().copied().collect();
        self.patch(material, Crease::Flat).polygon(&first).polygon(&rings[rings.len() - 1])
    }

    /// A shape turned around +Y. `profile_m` holds (radius, height) from bottom to top along its outside; where it
    /// neither begins nor ends on the axis it must be a loop (its first point is joined to its last).
    pub(crate) fn lathe(
        &mut self,
        material: Material,
        crease: Crease,
        profile_m: &[(f64, f64)],
        sides: usize,
    ) -> &mut Self {
        let is_loop = profile_m[0].0 > 0.0;
        let girth_m = TAU * profile_m.iter().fold(0.0, |most: f64, p| most.max(p.0));
        let ring = |&(radius_m, y_m): &(f64, f64)| -> Vec<DVec3> {
            let spoke = |j: usize| TAU * j as f64 / sides as f64;
            (0..sides).map(|j| dvec3(radius_m * cos(spoke(j)), y_m, -radius_m * sin(spoke(j)))).collect()
        };
        self.patch(material, crease);
        let mut along_m = 0.0;
        for k in 0..profile_m.len() - usize::from(!is_loop) {
            let (a, b) = (profile_m[k], profile_m[(k + 1) % profile_m.len()]);
            let next_m = along_m + dvec2(a.0 - b.0, a.1 - b.1).length();
            self.band(&ring(&a), &ring(&b), along_m, next_m, girth_m);
            along_m = next_m;
        }
        self
    }

    /// A ball with `sides` meridians.
    pub(crate) fn ball(&mut self, material: Material, centre_m: DVec3, radius_m: f64, sides: usize) -> &mut Self {
        let mut ball = Self::default();
        let rows = sides / 2;
        let angle = |k: usize| TAU * 0.5 * (k as f64 / rows as f64 - 0.5);
        let mut profile: Vec<_> = (0..=rows).map(|k| (radius_m * cos(angle(k)), radius_m * sin(angle(k)))).collect();
        profile[0].0 = 0.0;
        profile[rows].0 = 0.0;
        ball.lathe(material, Crease::Smooth, &profile, sides);
        self.put(&ball, glam::DAffine3::from_translation(centre_m))
    }

    /// Moves every point by `place`.
    pub(crate) fn warp(&mut self, place: impl Fn(DVec3) -> DVec3) -> &mut Self {
        for c in self.tris.iter_mut().flat_map(|t| &mut t.corners) {
            c.position_m = place(c.position_m);
        }
        self
    }

    /// The faces between two rings of equally many points; u runs around, v along.
    fn band(&mut self, from: &[DVec3], to: &[DVec3], v0_m: f64, v1_m: f64, girth_m: f64) {
        let sides = from.len();
        let uv_corner = |ring: &[DVec3], j: usize, v: f64| -> Corner {
            corner(ring[j % sides], dvec2(girth_m * j as f64 / sides as f64, v))
        };
        for j in 0..sides {
            self.quad([
                uv_corner(from, j, v0_m),
                uv_corner(from, j + 1, v0_m),
                uv_corner(to, j + 1, v1_m),
                uv_corner(to, j, v1_m),
            ]);
        }
    }
}

/// A ring of points around every point of the path; the frame is carried along without twist.
fn tube_rings(path_m: &[(DVec3, f64)], sides: usize, rib: f64) -> Vec<Vec<DVec3>> {
    let last = path_m.len() - 1;
    let mut frame = DMat3::IDENTITY;
    let mut rings = Vec::with_capacity(path_m.len());
    for (k, &(centre_m, radius_m)) in path_m.iter().enumerate() {
        let ahead = path_m[(k + 1).min(last)].0 - centre_m;
        let behind = centre_m - path_m[k.saturating_sub(1)].0;
        let direction = ahead.normalize_or_zero() + behind.normalize_or_zero();
        let up = if k == 0 { DVec3::Y } else { frame.y_axis };
        frame = frame_along(direction, up);
        let spoke = |j: usize| TAU * (j as f64 + 0.5) / sides as f64;
        let around = |j: usize| {
            let reach_m = if j.is_multiple_of(2) { radius_m } else { radius_m * rib };
            frame * dvec3(reach_m * cos(spoke(j)), reach_m * sin(spoke(j)), 0.0)
        };
        rings.push((0..sides).map(|j| centre_m + around(j)).collect());
    }
    rings
}

/// `count` points of an arc around the origin, from `from_deg` to `to_deg`, counter-clockwise when rising.
pub(crate) fn arc(radius: DVec2, from_deg: f64, to_deg: f64, count: usize) -> Vec<DVec2> {
    let angle = |k: usize| (from_deg + (to_deg - from_deg) * k as f64 / (count - 1) as f64).to_radians();
    (0..count).map(|k| radius * dvec2(cos(angle(k)), sin(angle(k)))).collect()
}

/// The outline of a rectangle with round corners, centred on the origin, counter-clockwise.
pub(crate) fn rounded_rectangle(half: DVec2, radius: f64, points_a_corner: usize) -> Vec<DVec2> {
    let mut outline = Vec::new();
    for (k, sign) in [dvec2(1.0, 1.0), dvec2(-1.0, 1.0), dvec2(-1.0, -1.0), dvec2(1.0, -1.0)].iter().enumerate() {
        let from = 90.0 * k as f64;
        let centre = *sign * (half - DVec2::splat(radius));
        outline.extend(arc(DVec2::splat(radius), from, from + 90.0, points_a_corner).iter().map(|p| *p + centre));
    }
    outline
}
