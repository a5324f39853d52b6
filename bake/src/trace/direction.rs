//! A ray direction, and the ray/triangle test.
//!
//! Based on: Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", *Journal of Computer Graphics Techniques*
//! 2(1), 2013. Departures: everything is in `f64`, so there is no fall-back for edge functions of zero; no culling.

use glam::{DVec3, Vec3};

/// A ray direction, prepared for the triangle test; shared by all rays towards one sun.
#[derive(Debug, Clone, Copy)]
pub struct Direction {
    unit: DVec3,
    /// The three axes: last the one along which the direction is largest, the others in an order that keeps the
    /// winding.
    pub(super) axes: [usize; 3],
    /// Shear that maps the direction to the last axis.
    pub(super) shear: DVec3,
}

impl Direction {
    /// Prepares a direction of unit length.
    pub fn new(unit: DVec3) -> Self {
        let last = unit.abs().max_position();
        let (mut first, mut second) = ((last + 1) % 3, (last + 2) % 3);
        if unit[last] < 0.0 {
            (first, second) = (second, first);
        }
        let shear = DVec3::new(unit[first], unit[second], 1.0) / unit[last];
        Self { unit, axes: [first, second, last], shear }
    }

    /// The vector of unit length that it was made of.
    pub fn unit(&self) -> DVec3 {
        self.unit
    }

    /// Intersects a ray from `origin` with a triangle: distance (in units of the origin's space) and weights of the
    /// second and third corner. Hits behind the origin do not count.
    #[inline]
    pub(super) fn intersect(&self, origin: DVec3, corners: &[Vec3; 3]) -> Option<(f64, [f64; 2])> {
        let [a, b, c] = corners.map(|corner| self.sheared(corner.as_dvec3() - origin));
        let edges = [c.x * b.y - c.y * b.x, a.x * c.y - a.y * c.x, b.x * a.y - b.y * a.x];
        if edges.iter().any(|&e| e < 0.0) && edges.iter().any(|&e| e > 0.0) {
            return None;
        }
        let determinant = edges[0] + edges[1] + edges[2];
        let distance = (edges[0] * a.z + edges[1] * b.z + edges[2] * c.z) / determinant;
        // A ray in the triangle's plane has a NaN distance, and must miss.
        (distance > 0.0).then(|| (distance, [edges[1] / determinant, edges[2] / determinant]))
    }

    #[inline]
    fn sheared(&self, v: DVec3) -> DVec3 {
        let along = v[self.axes[2]];
        let across = [v[self.axes[0]] - self.shear.x * along, v[self.axes[1]] - self.shear.y * along];
        DVec3::new(across[0], across[1], self.shear.z * along)
    }
}
