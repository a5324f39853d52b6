//! Welding: corners with equal coordinates become one point, whatever mesh, primitive or texture seam they come from.
//! Triangles that share two points share an edge.
//!
//! Corners are equal if rounding parts them at most: a sphere whose seam ends at the sine of a whole turn, which is not
//! quite 0, is closed. Coordinates count in steps of the precision that the largest of them has in `f32`. More would
//! move corners by more than volumes are biased, and then they would not start at the surface that is drawn.

use glam::Vec3;
use rayon::prelude::*;

/// Step of coordinates that are told apart, as a share of the largest: half of what `f32` resolves there.
const STEP: f64 = 1.0 / (1 << 24) as f64;

/// Triangles over shared points, with their edges.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Welded {
    /// Points in bake space, in metres.
    pub points_m: Vec<Vec3>,
    /// Points of each triangle, in the order of its corners.
    pub triangles: Vec<[u32; 3]>,
    /// Edges: their two points, the lower index first.
    pub edges: Vec<[u32; 2]>,
    /// For each edge, where its uses begin; one more entry at the end.
    pub first_use: Vec<u32>,
    /// Triangles along each edge.
    pub uses: Vec<EdgeUse>,
}

/// A triangle along an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct EdgeUse(u32);

impl EdgeUse {
    fn new(triangle: u32, is_against: bool) -> Self {
        Self(triangle << 1 | u32::from(is_against))
    }

    /// Index of the triangle.
    pub fn triangle(self) -> usize {
        (self.0 >> 1) as usize
    }

    /// +1 where the triangle's corners run from the edge's lower index to its higher, -1 where they run the other way.
    pub fn sign(self) -> i32 {
        1 - 2 * (self.0 & 1) as i32
    }

    /// Triangle and sign in one number: twice the triangle's index, plus one where the sign is -1.
    pub fn code(self) -> u32 {
        self.0
    }

    /// The same use by another triangle's number.
    pub fn renumbered(self, triangle: u32) -> Self {
        Self(triangle << 1 | self.0 & 1)
    }

    /// The same use where the triangle's corners, or the edge's points, have changed places.
    pub fn reversed(self) -> Self {
        Self(self.0 ^ 1)
    }
}

impl Welded {
    /// Welds triangles, given by their corners. A triangle has no edge between two equal corners.
    pub fn new(corners_m: &[[Vec3; 3]]) -> Self {
        let (points_m, triangles) = weld(corners_m);
        let mut directed: Vec<([u32; 2], EdgeUse)> = triangles
            .par_iter()
            .enumerate()
            .flat_map_iter(|(triangle, points)| {
                let edge = move |k: usize| {
                    let (from, to) = (points[k], points[(k + 1) % 3]);
                    (from != to).then(|| ([from.min(to), from.max(to)], EdgeUse::new(triangle as u32, from > to)))
                };
                (0..3).filter_map(edge)
            })
            .collect();
        directed.par_sort_unstable();
        let mut welded = Self { points_m, triangles, ..Self::default() };
        for run in directed.chunk_by(|a, b| a.0 == b.0) {
            welded.edges.push(run[0].0);
            welded.first_use.push(welded.uses.len() as u32);
            welded.uses.extend(run.iter().map(|&(_, edge_use)| edge_use));
        }
        welded.first_use.push(welded.uses.len() as u32);
        welded
    }

    /// Triangles along an edge.
    pub fn uses_of(&self, edge: usize) -> &[EdgeUse] {
        &self.uses[self.first_use[edge] as usize..self.first_use[edge + 1] as usize]
    }
}

fn weld(corners_m: &[[Vec3; 3]]) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let flat = corners_m.as_flattened();
    let largest_m = flat.par_iter().map(|corner| corner.abs().max_element()).reduce(|| 0.0, f32::max);
    let steps_per_m = 1.0 / (f64::from(largest_m) * STEP).max(f64::MIN_POSITIVE);
    let key = |corner: &Vec3| corner.to_array().map(|x| (f64::from(x) * steps_per_m).round() as i32);
    let mut sorted: Vec<([i32; 3], u32)> = flat.par_iter().enumerate().map(|(i, c)| (key(c), i as u32)).collect();
    sorted.par_sort_unstable();
    let mut points_m = Vec::new();
    let mut triangles = vec![[0; 3]; corners_m.len()];
    for run in sorted.chunk_by(|a, b| a.0 == b.0) {
        for &(_, corner) in run {
            triangles.as_flattened_mut()[corner as usize] = points_m.len() as u32;
        }
        points_m.push(flat[run[0].1 as usize]);
    }
    (points_m, triangles)
}

#[cfg(test)]
mod tests {
    use super::*;
    use sunbake::testing::block;

    #[test]
    fn a_cube_of_loose_triangles_welds_to_8_points_and_18_edges() {
        let welded = Welded::new(&block(Vec3::ZERO, Vec3::ONE));
        // Twelve edges of the cube, and the diagonals of its six faces.
        assert_eq!((welded.points_m.len(), welded.edges.len()), (8, 18));
        for edge in 0..18 {
            let signs: i32 = welded.uses_of(edge).iter().map(|u| u.sign()).sum();
            assert_eq!((welded.uses_of(edge).len(), signs), (2, 0));
        }
    }

    #[test]
    fn both_zeros_are_one_coordinate() {
        let [a, b, c] = [Vec3::ZERO, Vec3::X, Vec3::Y];
        let welded = Welded::new(&[[a, b, c], [Vec3::splat(-0.0), c, b]]);
        assert_eq!((welded.points_m.len(), welded.edges.len()), (3, 3));
    }

    #[test]
    fn corners_that_rounding_parts_are_one_and_those_a_step_apart_are_not() {
        let [a, b, c] = [Vec3::ZERO, Vec3::X, Vec3::Y];
        let points = |z: f32| Welded::new(&[[a, b, c], [a.with_z(z), c, b.with_z(-z)]]).points_m.len();
        assert_eq!((points(9.4e-17), points(1e-9), points(1e-7)), (3, 3, 5));
    }

    #[test]
    fn a_triangle_has_no_edge_between_two_equal_corners() {
        let welded = Welded::new(&[[Vec3::ZERO, Vec3::ZERO, Vec3::X]]);
        assert_eq!(welded.edges.len(), 1);
        assert_eq!(welded.uses_of(0).iter().map(|u| u.sign()).sum::<i32>(), 0);
    }
}
