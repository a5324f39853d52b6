//! A direction, and where rays along it meet triangles.
//!
//! Based on: Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", *Journal of Computer Graphics Techniques*
//! 2(1), 2013. Departures: in `f64`, so that there is no fall-back for edges that come out as zero, and without culling.

use glam::{DVec3, Vec3};

/// A ray's direction with what the triangle test needs of it; shared by all rays towards one sun.
#[derive(Debug, Clone, Copy)]
pub struct Direction {
    unit: DVec3,
    /// Axis along which the direction is largest, last; the other two in an order that keeps the winding.
    pub(super) axes: [usize; 3],
    /// Shear that turns the direction into the last axis.
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

    /// The direction itself.
    pub fn unit(&self) -> DVec3 {
        self.unit
    }

    /// Where a ray from `origin` meets a triangle, in front of the origin: distance and corner weights.
    #[inline]
    pub(super) fn meet(&self, origin: DVec3, corners: &[Vec3; 3]) -> Option<(f64, [f64; 2])> {
        let [a, b, c] = corners.map(|corner| self.sheared(corner.as_dvec3() - origin));
        let edges = [c.x * b.y - c.y * b.x, a.x * c.y - a.y * c.x, b.x * a.y - b.y * a.x];
        if edges.iter().any(|&e| e < 0.0) && edges.iter().any(|&e| e > 0.0) {
            return None;
        }
        let determinant = edges[0] + edges[1] + edges[2];
        let distance = (edges[0] * a.z + edges[1] * b.z + edges[2] * c.z) / determinant;
        // Not `distance <= 0.0`: a ray in the triangle's plane has a NaN here, and misses.
        (distance > 0.0).then(|| (distance, [edges[1] / determinant, edges[2] / determinant]))
    }

    #[inline]
    fn sheared(&self, v: DVec3) -> DVec3 {
        let along = v[self.axes[2]];
        let across = [v[self.axes[0]] - self.shear.x * along, v[self.axes[1]] - self.shear.y * along];
        DVec3::new(across[0], across[1], self.shear.z * along)
    }
}
