//! Triangles on their way to a mesh. Shapes pour triangles in; [`crate::weld`] turns them into indexed primitives.

use glam::{DAffine3, DVec2, DVec3, dvec2};

use crate::material::Material;

/// How normals are made inside one patch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Crease {
    /// Every face keeps its own normal.
    Flat,
    /// Faces that meet below about 45 degrees share normals.
    Soft,
    /// All faces that share a point share its normal.
    Smooth,
}

impl Crease {
    /// The least cosine between two face normals that may still be averaged.
    pub(crate) fn least_cosine(self) -> f64 {
        match self {
            Self::Flat => 0.999,
            Self::Soft => 0.70,
            Self::Smooth => -2.0,
        }
    }
}

/// One corner of a triangle. The texture coordinate is in metres; the material says how many metres a tile is.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Corner {
    pub(crate) position_m: DVec3,
    pub(crate) uv_m: DVec2,
}

/// A corner from its position and texture coordinate (both in metres).
pub(crate) fn corner(position_m: DVec3, uv_m: DVec2) -> Corner {
    Corner { position_m, uv_m }
}

/// A triangle, counter-clockwise seen from outside. Normals are averaged only inside one `patch`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Tri {
    pub(crate) corners: [Corner; 3],
    pub(crate) patch: usize,
}

/// What all triangles of one shape share.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Patch {
    pub(crate) material: Material,
    pub(crate) crease: Crease,
    /// Patches of one group share normals where they meet.
    pub(crate) group: usize,
}

/// A bag of triangles in patches.
#[derive(Debug, Clone, Default)]
pub(crate) struct Soup {
    pub(crate) tris: Vec<Tri>,
    pub(crate) patches: Vec<Patch>,
}

impl Soup {
    /// Starts a new patch: what follows belongs to it.
    pub(crate) fn patch(&mut self, material: Material, crease: Crease) -> &mut Self {
        let group = self.patches.len();
        self.patches.push(Patch { material, crease, group });
        self
    }

    /// Lets the latest patch share normals with patch `group`.
    pub(crate) fn in_group(&mut self, group: usize) -> &mut Self {
        if let Some(latest) = self.patches.last_mut() {
            latest.group = group;
        }
        self
    }

    /// Adds a triangle with given texture coordinates to the latest patch.
    pub(crate) fn tri(&mut self, corners: [Corner; 3]) -> &mut Self {
        let patch = self.patches.len() - 1;
        self.tris.push(Tri { corners, patch });
        self
    }

    /// Adds a four-cornered face with given texture coordinates to the latest patch.
    pub(crate) fn quad(&mut self, c: [Corner; 4]) -> &mut Self {
        self.tri([c[0], c[1], c[2]]).tri([c[0], c[2], c[3]])
    }

    /// Adds a convex polygon, its texture projected along the axis that it faces most.
    pub(crate) fn polygon(&mut self, points_m: &[DVec3]) -> &mut Self {
        let normal = polygon_normal(points_m);
        let corners: Vec<Corner> = points_m.iter().map(|&p| corner(p, project(p, normal))).collect();
        for k in 1..corners.len() - 1 {
            self.tri([corners[0], corners[k], corners[k + 1]]);
        }
        self
    }

    /// Adds a copy of `other`, moved by `placement`. A mirroring placement turns the triangles round.
    pub(crate) fn put(&mut self, other: &Self, placement: DAffine3) -> &mut Self {
        let first_patch = self.patches.len();
        let mirrored = placement.matrix3.determinant() < 0.0;
        self.patches.extend(other.patches.iter().map(|p| Patch { group: p.group + first_patch, ..*p }));
        for tri in &other.tris {
            let mut corners = tri.corners;
            for c in &mut corners {
                c.position_m = placement.transform_point3(c.position_m);
            }
            if mirrored {
                corners.swap(1, 2);
            }
            self.tris.push(Tri { corners, patch: tri.patch + first_patch });
        }
        self
    }
}

/// Newell's normal of a polygon; not of unit length.
fn polygon_normal(points_m: &[DVec3]) -> DVec3 {
    let n = points_m.len();
    (0..n).map(|k| (points_m[k] - points_m[0]).cross(points_m[(k + 1) % n] - points_m[0])).sum()
}

/// Box projection: the two coordinates across the axis that `normal` follows most, v downwards on walls.
pub(crate) fn project(p: DVec3, normal: DVec3) -> DVec2 {
    let size = normal.abs();
    if size.y >= size.x && size.y >= size.z {
        dvec2(p.x, p.z)
    } else if size.x >= size.z {
        dvec2(p.z, -p.y)
    } else {
        dvec2(p.x, -p.y)
    }
}
