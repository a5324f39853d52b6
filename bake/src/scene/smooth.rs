//! Smooth surfaces: the shape that shading normals tell of, where triangles are facets of it.
//!
//! Theory: a smooth-shaded ball of few faces shows its facets wherever light depends on the faces: a face that turns
//! away from the sun is dark, though its shading normals still see the sun, and rays that start on it meet the ball
//! itself. Phong tessellation (Boubekeur and Alexa, *ACM Transactions on Graphics* 27(5), 2008) lays a curved patch
//! over each triangle: a point P goes to the mean, by its weights b, of its projections onto the corners' tangent
//! planes. Hanika ("Hacking the shadow terminator", *Ray Tracing Gems II*, chapter 4, 2021) starts shadow rays on that
//! patch. Multiplied out, with corners V and their normals n, it is a vector for each edge:
//!
//! ```text
//! P' = P + sum over edges ij of b_i b_j lift_ij,    lift_ij = ((V_i - V_j) . n_i) n_i + ((V_j - V_i) . n_j) n_j
//! ```
//!
//! The two triangles of an edge agree on its vector, so that the patches meet. And a shader needs no more than three
//! vectors a triangle.
//!
//! Departures:
//!
//! * Hanika leaves out the part of a corner that would go inwards; here a whole edge either bulges to the side that is
//!   seen, or is left out. So both sides of a sheet share the vectors, and normals that are alike but not the
//!   triangle's (as artists give to leaves) lift nothing.
//! * [`crate::visibility::RayStart`] says which rays start there: only those to lights that the shading normal sees and
//!   the face does not. Other points stay, so that small things on large faces keep their shadows.
//! * Not every triangle with normals is a facet of something smooth. Where normals turn by less than half a degree
//!   ([`ALIKE_COSINE`]) a facet's terminator lies where the light is below a hundredth, and where they lean more than
//!   40 degrees from the face ([`LEAST_COSINE`]) the shape has edges there, as a box has whose normals were averaged.
//!   Both count as flat, and nothing about them changes.

use super::{Geometry, Scene, ShadingNormals};
use glam::{DVec3, Vec3};

/// Least cosine between a corner's normal and the face's: 40 degrees. Balls of 20 faces and hexagonal columns are
/// smooth; square columns and boxes have edges.
const LEAST_COSINE: f64 = 0.766;
/// Cosine between normals of a triangle above which they are alike: half a degree, as wide as the sun.
const ALIKE_COSINE: f64 = 0.999_962;

/// No entry.
const FLAT: u32 = u32::MAX;

/// Corner normals of the smooth triangles of a scene, bake space.
#[derive(Debug, Clone, Default)]
pub(super) struct SmoothTriangles {
    /// For each flat index its place in `normals`, or [`FLAT`]. Empty where nothing is smooth.
    place: Vec<u32>,
    normals: Vec<[Vec3; 3]>,
}

/// A point of a smooth surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SmoothPoint {
    /// Unit shading normal, on the front.
    pub normal: DVec3,
    /// From the point to the smooth shape, in metres, as the front shows it and as the back does. Zero where that side
    /// is hollow.
    pub lift_m: [DVec3; 2],
}

impl SmoothPoint {
    /// The same, seen as a surface whose front is this one's back.
    pub fn turned(self) -> Self {
        let [front, back] = self.lift_m;
        Self { normal: -self.normal, lift_m: [back, front] }
    }
}

impl SmoothTriangles {
    /// Finds them. `geometry` has the corners.
    pub fn of(scene: &Scene, geometry: &Geometry) -> Self {
        let turn = ShadingNormals::new(scene);
        let mut found = Self::default();
        for (index, instance) in scene.instances.iter().enumerate() {
            let mesh = &scene.meshes[instance.mesh];
            let Some(normals) = mesh.normals.as_ref().filter(|_| scene.is_there(index)) else {
                continue;
            };
            let normals: Vec<DVec3> = normals.iter().map(|normal| turn.turned(index, *normal)).collect();
            for (triangle, corners) in (geometry.first_triangle[index]..).zip(mesh.indices.chunks_exact(3)) {
                let at_corners = [0, 1, 2].map(|k| normals[corners[k] as usize]);
                if is_smooth(geometry.normal(triangle as usize), &at_corners) {
                    found.place.resize(geometry.triangles.len(), FLAT);
                    found.place[triangle as usize] = found.normals.len() as u32;
                    found.normals.push(at_corners.map(|normal| normal.as_vec3()));
                }
            }
        }
        found
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.normals.len()
    }

    /// The corners' normals; none of a flat triangle.
    pub fn normals(&self, triangle: usize) -> Option<[DVec3; 3]> {
        let place = self.place.get(triangle).filter(|&&place| place != FLAT)?;
        Some(self.normals[*place as usize].map(|normal| normal.as_dvec3()))
    }
}

/// Whether a face is a facet of something smooth.
fn is_smooth(face: DVec3, normals: &[DVec3; 3]) -> bool {
    let [a, b, c] = normals;
    // Zero vectors and NaN lean too far.
    normals.iter().all(|normal| normal.dot(face) >= LEAST_COSINE)
        && [a.dot(*b), b.dot(*c), c.dot(*a)].iter().any(|&cosine| cosine < ALIKE_COSINE)
}

/// For the edges from each corner to the next, by how much the smooth shape rises over it, times four at its middle:
/// see the module.
pub(super) fn edge_lifts(corners: &[DVec3; 3], normals: &[DVec3; 3]) -> [DVec3; 3] {
    [0, 1, 2].map(|i| {
        let k = (i + 1) % 3;
        let edge = corners[i] - corners[k];
        normals[i] * edge.dot(normals[i]) - normals[k] * edge.dot(normals[k])
    })
}

/// From a point of a triangle (weights of its second and third corner) to the smooth shape, as `side` shows it.
pub(super) fn lift(edge_lifts: &[DVec3; 3], [u, v]: [f64; 2], side: DVec3) -> DVec3 {
    let weights = [(1.0 - u - v) * u, u * v, v * (1.0 - u - v)];
    let rising = edge_lifts.iter().zip(weights).filter(|(lift, _)| lift.dot(side) > 0.0);
    rising.map(|(lift, weight)| *lift * weight).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    const UP: DVec3 = DVec3::Y;

    fn leaning(degrees: f64, about: f64) -> DVec3 {
        let (sin, cos) = degrees.to_radians().sin_cos();
        DVec3::new(sin * about.cos(), cos, sin * about.sin())
    }

    #[test]
    fn flat_and_sharp_and_broken_normals_are_not_smooth() {
        let thirds = [0.0, 2.1, 4.2];
        assert!(is_smooth(UP, &thirds.map(|about| leaning(20.0, about))));
        assert!(!is_smooth(UP, &[UP; 3]), "flat");
        assert!(!is_smooth(UP, &[leaning(20.0, 1.0); 3]), "alike");
        assert!(!is_smooth(UP, &thirds.map(|about| leaning(0.2, about))), "nearly flat");
        assert!(!is_smooth(UP, &thirds.map(|about| leaning(54.7, about))), "the corner of a box");
        assert!(!is_smooth(UP, &[-UP, leaning(20.0, 0.0), UP]), "turned over");
        assert!(!is_smooth(UP, &[DVec3::ZERO, leaning(20.0, 0.0), UP]), "without direction");
        assert!(!is_smooth(UP, &[DVec3::NAN, leaning(20.0, 0.0), UP]), "not a number");
        assert!(!is_smooth(DVec3::ZERO, &thirds.map(|about| leaning(20.0, about))), "without area");
    }

    /// Projecting onto each corner's tangent plane is the same, where nothing is left out.
    #[test]
    fn lifts_are_hanikas_on_convex_faces() {
        let corners = [DVec3::new(1.0, 0.1, 0.0), DVec3::new(-0.4, 0.0, 0.9), DVec3::new(-0.5, -0.1, -0.8)];
        let normals = corners.map(|corner| (corner + UP * 2.0).normalize());
        let lifts = edge_lifts(&corners, &normals);
        for [u, v] in [[0.2, 0.3], [0.5, 0.5], [0.0, 0.4], [1.0, 0.0], [0.1, 0.8]] {
            let weights = [1.0 - u - v, u, v];
            let point: DVec3 = corners.iter().zip(weights).map(|(corner, weight)| *corner * weight).sum();
            let projected = corners.iter().zip(normals).map(|(corner, n)| n * (*corner - point).dot(n).max(0.0));
            let expected: DVec3 = projected.zip(weights).map(|(lift, weight)| lift * weight).sum();
            assert!(lift(&lifts, [u, v], UP).distance(expected) < 1e-12);
            assert_eq!(lift(&lifts, [u, v], -UP), DVec3::ZERO, "the back is hollow");
        }
    }

    /// On a ball of radius 1 the smooth shape lies as far outside as the facet lies inside.
    #[test]
    fn the_shape_over_an_edge_of_a_ball_is_as_far_outside_as_the_edge_is_inside() {
        let half_angle: f64 = 0.1;
        let corner = |side: f64| DVec3::new(side * half_angle.sin(), half_angle.cos(), 0.0);
        let corners = [corner(-1.0), corner(1.0), DVec3::Z];
        let over = DVec3::Y * half_angle.cos() + lift(&edge_lifts(&corners, &corners), [0.5, 0.0], UP);
        assert!((over.length() - 1.0 - (1.0 - half_angle.cos())).abs() < 1e-4, "{}", over.length());
    }
}
