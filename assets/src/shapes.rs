//! Boxes, beams and prisms: closed shapes with flat faces.

use glam::{DAffine3, DMat3, DVec2, DVec3, dvec3};

use crate::material::Material;
use crate::soup::{Crease, Soup};
use crate::trig::{cos, sin};

/// The affine map that turns by `degrees` around +Y (counter-clockwise seen from above) and then moves to `at_m`.
pub(crate) fn turned(at_m: DVec3, degrees: f64) -> DAffine3 {
    let (s, c) = (sin(degrees.to_radians()), cos(degrees.to_radians()));
    let turn = DMat3::from_cols(dvec3(c, 0.0, -s), DVec3::Y, dvec3(s, 0.0, c));
    DAffine3::from_mat3_translation(turn, at_m)
}

/// Moves without turning.
pub(crate) fn moved(x_m: f64, y_m: f64, z_m: f64) -> DAffine3 {
    DAffine3::from_translation(dvec3(x_m, y_m, z_m))
}

/// A turn by `degrees` around the unit vector `axis`.
pub(crate) fn turn_about(axis: DVec3, degrees: f64) -> DMat3 {
    let (s, c) = (sin(degrees.to_radians()), cos(degrees.to_radians()));
    let column = |v: DVec3| v * c + axis.cross(v) * s + axis * axis.dot(v) * (1.0 - c);
    DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z))
}

/// An orthonormal frame whose third column is `direction`; its second column leans towards `up`.
pub(crate) fn frame_along(direction: DVec3, up: DVec3) -> DMat3 {
    let z = direction.normalize();
    let up = if up.cross(z).length() < 1e-3 { DVec3::X } else { up };
    let x = up.cross(z).normalize();
    DMat3::from_cols(x, z.cross(x), z)
}

impl Soup {
    /// A box between two opposite corners (metres).
    pub(crate) fn cuboid(&mut self, material: Material, low_m: DVec3, high_m: DVec3) -> &mut Self {
        self.hexahedron(material, Crease::Flat, box_corners(low_m, high_m))
    }

    /// A box from the ranges of its x, y and z, in metres.
    pub(crate) fn block(&mut self, material: Material, x_m: [f64; 2], y_m: [f64; 2], z_m: [f64; 2]) -> &mut Self {
        self.cuboid(material, dvec3(x_m[0], y_m[0], z_m[0]), dvec3(x_m[1], y_m[1], z_m[1]))
    }

    /// A box that stands on `base_m` (the middle of its bottom face).
    pub(crate) fn standing(&mut self, material: Material, base_m: DVec3, size_m: DVec3) -> &mut Self {
        let half = dvec3(size_m.x * 0.5, 0.0, size_m.z * 0.5);
        self.cuboid(material, base_m - half, base_m + half + DVec3::Y * size_m.y)
    }

    /// Six faces over eight corners. Corner k has x from bit 0, y from bit 1 and z from bit 2 of k.
    pub(crate) fn hexahedron(&mut self, material: Material, crease: Crease, c: [DVec3; 8]) -> &mut Self {
        self.patch(material, crease);
        for f in [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]] {
            self.polygon(&f.map(|k| c[k]));
        }
        self
    }

    /// A straight bar from `a_m` to `b_m`, `wide_m` across and `high_m` towards +Y.
    pub(crate) fn beam(&mut self, material: Material, a_m: DVec3, b_m: DVec3, wide_m: f64, high_m: f64) -> &mut Self {
        let half = dvec3(wide_m, high_m, (b_m - a_m).length()) * 0.5;
        let mut bar = Self::default();
        bar.cuboid(material, -half, half);
        let placement = DAffine3::from_mat3_translation(frame_along(b_m - a_m, DVec3::Y), (a_m + b_m) * 0.5);
        self.put(&bar, placement)
    }

    /// A box whose twelve edges are cut back by `bevel_m`.
    pub(crate) fn bevelled(&mut self, material: Material, low_m: DVec3, high_m: DVec3, bevel_m: f64) -> &mut Self {
        let (middle, half) = ((low_m + high_m) * 0.5, (high_m - low_m) * 0.5);
        self.patch(material, Crease::Flat);
        // The vertex of corner `k` that lies on the face across `axis`.
        let vertex = |k: usize, axis: usize| {
            let mut p = half - DVec3::splat(bevel_m);
            p[axis] = half[axis];
            let sign = |bit: usize| if k >> bit & 1 == 1 { 1.0 } else { -1.0 };
            middle + p * dvec3(sign(0), sign(1), sign(2))
        };
        for axis in 0..3 {
            self.bevelled_axis(axis, &vertex);
        }
        for k in 0..8_usize {
            let mut p = [vertex(k, 0), vertex(k, 1), vertex(k, 2)];
            if k.count_ones() % 2 == 0 {
                p.reverse();
            }
            self.polygon(&p);
        }
        self
    }

    /// The two faces across `axis` and the four bevels along it.
    fn bevelled_axis(&mut self, axis: usize, vertex: &dyn Fn(usize, usize) -> DVec3) {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let around = [0, 1 << u, (1 << u) | (1 << v), 1 << v];
        self.polygon(&[3, 2, 1, 0].map(|k: usize| vertex(around[k], axis)));
        self.polygon(&around.map(|k| vertex(k | (1 << axis), axis)));
        for (at, from, to) in [(0, u, v), (1 << u, v, u), ((1 << u) | (1 << v), u, v), (1 << v, v, u)] {
            let (a, b) = (at, at | (1 << axis));
            self.polygon(&[vertex(a, from), vertex(a, to), vertex(b, to), vertex(b, from)]);
        }
    }

    /// A convex outline in the XY plane (counter-clockwise seen from +Z), drawn out from `z0_m` to `z1_m`.
    pub(crate) fn prism(
        &mut self,
        material: Material,
        crease: Crease,
        outline_m: &[DVec2],
        z0_m: f64,
        z1_m: f64,
    ) -> &mut Self {
        let at = |z: f64| -> Vec<DVec3> { outline_m.iter().map(|p| p.extend(z)).collect() };
        let (mut back, front) = (at(z0_m), at(z1_m));
        self.patch(material, crease);
        for k in 0..back.len() {
            let next = (k + 1) % back.len();
            self.polygon(&[back[k], back[next], front[next], front[k]]);
        }
        back.reverse();
        self.polygon(&front).polygon(&back)
    }
}

/// Eight corners of a box in [`Soup::hexahedron`]'s order.
pub(crate) fn box_corners(low_m: DVec3, high_m: DVec3) -> [DVec3; 8] {
    std::array::from_fn(|k| {
        let pick = |bit: usize, low: f64, high: f64| if k >> bit & 1 == 1 { high } else { low };
        dvec3(pick(0, low_m.x, high_m.x), pick(1, low_m.y, high_m.y), pick(2, low_m.z, high_m.z))
    })
}
