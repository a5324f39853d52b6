//! Bodies: triangles that are connected by edges, and which of them bound a solid.
//!
//! The volumes of a solid take half of the work: where a ray from a shaded point to the light leaves the body through a
//! back face, it has entered through a front face, so the front faces alone cast the body's whole shadow. This takes
//! two things:
//!
//! * The surface is *closed*: along every edge as many triangles run one way as the other. Edges of four triangles are
//!   allowed; open edges, edges of three triangles and Moebius strips are not.
//! * It is nowhere *inside out*: no point has a negative winding number. One ray is cast from every triangle, and the
//!   faces of its own body are counted that it leaves and enters through. A body that is inside out everywhere is
//!   turned over.
//!
//! Any other body is *open*. That costs more, and is right for any triangles.

use super::weld::Welded;
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use sunbake::trace::{Direction, Tracer};

/// Tilts of rays against the normal, along two tangents. They are irregular, so that rays through typical models hit no
/// edges. If the first ray finds a negative winding number, the other two are cast as well, and the median counts.
const TILTS: [[f64; 2]; 3] = [[0.211_324_87, 0.173_205_08], [-0.312_357_2, 0.087_431_9], [0.071_913_7, -0.283_177_1]];

/// The bodies of a welded scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Bodies {
    /// For each triangle, its body.
    pub of_triangle: Vec<u32>,
    /// The shape of each body.
    pub shapes: Vec<Shape>,
}

/// Whether a body bounds a solid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Shape {
    /// It bounds a solid, front faces outside.
    Solid,
    /// It bounds a solid, front faces inside.
    InsideOut,
    /// Not closed, or inside out in part.
    Open,
}

impl Bodies {
    /// Finds the bodies. `corners_m` are the welded triangles, counter-clockwise from the front; `flat` are their
    /// indices in the tracer's geometry.
    pub fn new(welded: &Welded, corners_m: &[[Vec3; 3]], flat: &[u32], tracer: &Tracer) -> Self {
        let (of_triangle, count) = connected(welded);
        let mut is_closed = vec![true; count];
        for edge in 0..welded.edges.len() {
            let uses = welded.uses_of(edge);
            if uses.iter().map(|u| u.sign()).sum::<i32>() != 0 {
                is_closed[of_triangle[uses[0].triangle()] as usize] = false;
            }
        }
        let mut bodies = Self { of_triangle, shapes: vec![Shape::Open; count] };
        bodies.find_shapes(&is_closed, corners_m, flat, tracer);
        bodies
    }

    fn find_shapes(&mut self, is_closed: &[bool], corners_m: &[[Vec3; 3]], flat: &[u32], tracer: &Tracer) {
        let mut triangle_of_flat = vec![u32::MAX; flat.iter().max().map_or(0, |&last| last as usize + 1)];
        for (triangle, &flat) in flat.iter().enumerate() {
            triangle_of_flat[flat as usize] = triangle as u32;
        }
        let windings =
            Windings { corners_m, triangle_of_flat: &triangle_of_flat, of_triangle: &self.of_triangle, tracer };
        let in_closed = |&triangle: &usize| is_closed[self.of_triangle[triangle] as usize];
        let outside: Vec<(u32, bool)> = (0..corners_m.len())
            .into_par_iter()
            .filter(in_closed)
            .map(|triangle| (self.of_triangle[triangle], windings.winding_in_front_of(triangle) >= 0))
            .collect();
        let mut found = vec![[false; 2]; is_closed.len()];
        for (body, is_outside) in outside {
            found[body as usize][usize::from(is_outside)] = true;
        }
        for ((shape, found), is_closed) in self.shapes.iter_mut().zip(found).zip(is_closed) {
            *shape = match found {
                [false, true] if *is_closed => Shape::Solid,
                [true, false] if *is_closed => Shape::InsideOut,
                _ => Shape::Open,
            };
        }
    }
}

/// Computes winding numbers.
struct Windings<'a> {
    corners_m: &'a [[Vec3; 3]],
    triangle_of_flat: &'a [u32],
    of_triangle: &'a [u32],
    tracer: &'a Tracer,
}

impl Windings<'_> {
    /// The winding number of a triangle's own body in front of the triangle: the median of up to three rays.
    fn winding_in_front_of(&self, triangle: usize) -> i32 {
        let first = self.along(triangle, TILTS[0]);
        if first >= 0 {
            return first;
        }
        let mut found = [first, self.along(triangle, TILTS[1]), self.along(triangle, TILTS[2])];
        found.sort_unstable();
        found[1]
    }

    fn along(&self, triangle: usize, tilt: [f64; 2]) -> i32 {
        let corners = self.corners_m[triangle].map(|corner| corner.as_dvec3());
        let normal = cross(&corners).normalize_or_zero();
        let start_m = (corners[0] + corners[1] + corners[2]) / 3.0;
        let (right, up) = normal.any_orthonormal_pair();
        let direction = (normal + right * tilt[0] + up * tilt[1]).normalize();
        // Triangles at the start itself are coincident: neither in front nor behind.
        let coincident_m = start_m.abs().max_element() * 1e-6;
        let mut winding = 0;
        self.tracer.for_each_hit(start_m, &Direction::new(direction), |flat, distance_m| {
            let met = self.triangle_of_flat.get(flat as usize).copied().unwrap_or(u32::MAX) as usize;
            let is_own = met < self.of_triangle.len() && self.of_triangle[met] == self.of_triangle[triangle];
            if is_own && met != triangle && distance_m > coincident_m {
                let leaves = cross(&self.corners_m[met].map(|corner| corner.as_dvec3())).dot(direction) > 0.0;
                winding += if leaves { 1 } else { -1 };
            }
        });
        winding
    }
}

/// Twice a triangle's area, along its normal.
pub fn cross([a, b, c]: &[DVec3; 3]) -> DVec3 {
    (*b - *a).cross(*c - *a)
}

/// For each triangle the number of its connected component (union-find), and how many components there are.
fn connected(welded: &Welded) -> (Vec<u32>, usize) {
    let mut parent: Vec<u32> = (0..welded.triangles.len() as u32).collect();
    for edge in 0..welded.edges.len() {
        let uses = welded.uses_of(edge);
        for pair in uses.windows(2) {
            let [a, b] = [pair[0], pair[1]].map(|u| root(&mut parent, u.triangle() as u32));
            parent[a.max(b) as usize] = a.min(b);
        }
    }
    let mut number = vec![u32::MAX; parent.len()];
    let mut count = 0;
    let of_triangle = (0..parent.len() as u32).map(|triangle| {
        let root = root(&mut parent, triangle) as usize;
        if number[root] == u32::MAX {
            number[root] = count;
            count += 1;
        }
        number[root]
    });
    let of_triangle = of_triangle.collect();
    (of_triangle, count as usize)
}

fn root(parent: &mut [u32], mut of: u32) -> u32 {
    while parent[of as usize] != of {
        parent[of as usize] = parent[parent[of as usize] as usize];
        of = parent[of as usize];
    }
    of
}

#[cfg(test)]
mod tests {
    use super::*;
    use sunbake::scene::Geometry;
    use sunbake::testing::{SceneBuilder, block};

    fn shapes(triangles: &[[Vec3; 3]]) -> Vec<Shape> {
        let scene = SceneBuilder::new().soup(triangles).build();
        let geometry = Geometry::new(&scene);
        let flat: Vec<u32> = (0..geometry.triangles.len() as u32).collect();
        let welded = Welded::new(&geometry.triangles);
        Bodies::new(&welded, &geometry.triangles, &flat, &Tracer::new(&scene, &geometry)).shapes
    }

    fn flipped(triangles: &[[Vec3; 3]]) -> Vec<[Vec3; 3]> {
        triangles.iter().map(|&[a, b, c]| [a, c, b]).collect()
    }

    #[test]
    fn closed_open_and_turned_over_boxes_are_told_apart() {
        let cube = block(Vec3::ZERO, Vec3::ONE);
        assert_eq!(shapes(&cube), [Shape::Solid]);
        assert_eq!(shapes(&flipped(&cube)), [Shape::InsideOut]);
        assert_eq!(shapes(&cube[2..]), [Shape::Open]);
        let mut one_flipped = cube;
        one_flipped[3].swap(0, 1);
        assert_eq!(shapes(&one_flipped), [Shape::Open]);
    }

    #[test]
    fn boxes_that_share_an_edge_are_one_solid_and_boxes_that_cross_are_two() {
        let cube = block(Vec3::ZERO, Vec3::ONE);
        let beside = [cube.clone(), block(Vec3::new(1.0, 1.0, 0.0), Vec3::new(2.0, 2.0, 1.0))].concat();
        assert_eq!(shapes(&beside), [Shape::Solid]);
        let across = [cube, block(Vec3::splat(0.5), Vec3::splat(1.5))].concat();
        assert_eq!(shapes(&across), [Shape::Solid, Shape::Solid]);
    }

    #[test]
    fn a_body_that_is_inside_out_in_part_is_open() {
        // A box and a box turned over that share an edge: closed throughout, and one of them winds the wrong way.
        let cube = block(Vec3::ZERO, Vec3::ONE);
        let turned = flipped(&block(Vec3::new(1.0, 1.0, 0.0), Vec3::new(2.0, 2.0, 1.0)));
        assert_eq!(shapes(&[cube, turned].concat()), [Shape::Open]);
    }

    #[test]
    fn a_sheet_modelled_from_both_sides_is_closed() {
        let sheet = [[Vec3::ZERO, Vec3::X, Vec3::Y]];
        assert_eq!(shapes(&[sheet.to_vec(), flipped(&sheet)].concat()), [Shape::Solid]);
    }
}
