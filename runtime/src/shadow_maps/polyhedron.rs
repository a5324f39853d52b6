//! A convex body as its faces, clipped by planes one after the other (Sutherland and Hodgman, "Reentrant polygon
//! clipping", *CACM* 17, 1974, face by face, and a new face where the plane cuts).

use glam::{DVec3, DVec4, Vec4Swizzles};

/// A convex body, by the corners of its faces.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Polyhedron {
    faces: Vec<Vec<DVec3>>,
}

impl Polyhedron {
    /// The box with these least and greatest coordinates.
    pub fn of_box([low, high]: [DVec3; 2]) -> Self {
        let corner = |i: usize| {
            let pick = |k: usize| if i >> k & 1 == 1 { high[k] } else { low[k] };
            DVec3::new(pick(0), pick(1), pick(2))
        };
        let faces = [[0, 2, 6, 4], [1, 3, 7, 5], [0, 1, 5, 4], [2, 3, 7, 6], [0, 1, 3, 2], [4, 5, 7, 6]];
        Self { faces: faces.map(|face| face.map(corner).to_vec()).into() }
    }

    /// The part where `plane . (point, 1) >= 0`.
    pub fn clipped_by(&self, plane: DVec4) -> Self {
        let height = |p: DVec3| plane.truncate().dot(p) + plane.w;
        let mut cap: Vec<DVec3> = Vec::new();
        let mut faces = Vec::new();
        for face in &self.faces {
            let mut kept = Vec::with_capacity(face.len() + 1);
            for (i, &p) in face.iter().enumerate() {
                let q = face[(i + 1) % face.len()];
                let (a, b) = (height(p), height(q));
                if a >= 0.0 {
                    kept.push(p);
                }
                if (a >= 0.0) != (b >= 0.0) {
                    let on_plane = p + (q - p) * (a / (a - b));
                    kept.push(on_plane);
                    cap.push(on_plane);
                }
            }
            if kept.len() > 2 {
                faces.push(kept);
            }
        }
        if cap.len() > 2 {
            faces.push(in_order(cap, plane.xyz()));
        }
        Self { faces }
    }

    /// The corners, some of them more than once.
    pub fn corners(&self) -> impl Iterator<Item = DVec3> {
        self.faces.iter().flatten().copied()
    }

    /// Whether nothing is left.
    pub fn is_empty(&self) -> bool {
        self.faces.is_empty()
    }
}

/// Points of a convex polygon in order around its middle.
fn in_order(mut points: Vec<DVec3>, normal: DVec3) -> Vec<DVec3> {
    let middle = points.iter().sum::<DVec3>() / points.len() as f64;
    let (across, up) = normal.normalize().any_orthonormal_pair();
    let angle = |p: &DVec3| (*p - middle).dot(up).atan2((*p - middle).dot(across));
    points.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube() -> Polyhedron {
        Polyhedron::of_box([DVec3::ZERO, DVec3::ONE])
    }

    #[test]
    fn cuts_keep_the_positive_side_of_their_planes() {
        let corner = cube().clipped_by(DVec4::new(-1.0, -1.0, -1.0, 1.0));
        let found: Vec<DVec3> = corner.corners().collect();
        for expected in [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z] {
            assert!(found.iter().any(|p| p.distance(expected) < 1e-12), "{expected}");
        }
        assert!(found.iter().all(|p| p.element_sum() < 1.0 + 1e-12));
        // A second plane goes through the face that the first one made.
        let slice = corner.clipped_by(DVec4::new(1.0, 0.0, 0.0, -0.25));
        let tip = DVec3::new(0.25, 0.75, 0.0);
        assert!(slice.corners().all(|p| p.x > 0.25 - 1e-12) && slice.corners().any(|p| p.distance(tip) < 1e-12));
    }

    #[test]
    fn planes_that_miss_leave_all_or_nothing() {
        assert_eq!(cube().clipped_by(DVec4::new(1.0, 0.0, 0.0, 5.0)), cube());
        assert!(cube().clipped_by(DVec4::new(1.0, 0.0, 0.0, -5.0)).is_empty());
    }
}
