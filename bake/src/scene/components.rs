//! Connected parts of a scene: triangles that share corners, or corners at the same place of one instance.
//!
//! They are what casts *one* shadow: a picket, a post, a trunk. An object is too coarse (a fence is one mesh), and a
//! triangle too fine (a picket's shadow would fall apart where one face takes over from another).

use super::{Geometry, Scene};
use glam::Vec3;
use std::collections::HashMap;

/// The connected part of every triangle.
pub struct Components {
    /// For each flat triangle of [`Geometry`], its part: 0 to `count - 1`, in the order of their first triangles.
    pub of_triangle: Vec<u32>,
    /// Number of parts.
    pub count: usize,
}

impl Components {
    /// Finds the parts of each mesh once, by the bits of its corners' coordinates, and numbers them by instance.
    pub fn new(scene: &Scene, geometry: &Geometry) -> Self {
        let of_mesh: Vec<(Vec<u32>, u32)> =
            scene.meshes.iter().map(|mesh| parts(&mesh.positions, &mesh.indices)).collect();
        let mut of_triangle = Vec::with_capacity(geometry.triangles.len());
        let mut count = 0;
        for instance in &scene.instances {
            let (parts, part_count) = &of_mesh[instance.mesh];
            of_triangle.extend(parts.iter().map(|part| count + part));
            count += part_count;
        }
        Self { of_triangle, count: count as usize }
    }
}

/// The part of each triangle of a mesh, and how many there are.
fn parts(positions: &[Vec3], indices: &[u32]) -> (Vec<u32>, u32) {
    let mut first_at = HashMap::with_capacity(positions.len());
    // Adding zero makes -0 and 0 one place.
    let first = |(place, v): (&Vec3, u32)| *first_at.entry((*place + 0.0).to_array().map(f32::to_bits)).or_insert(v);
    let mut parent: Vec<u32> = positions.iter().zip(0..).map(first).collect();
    let triangles = indices.as_chunks::<3>().0;
    for triangle in triangles {
        let roots = triangle.map(|v| root(&mut parent, v));
        let least = roots.into_iter().min().unwrap_or_default();
        roots.into_iter().for_each(|v| parent[v as usize] = least);
    }
    let mut numbers = HashMap::new();
    let mut number = |triangle: &[u32; 3]| {
        let next = numbers.len() as u32;
        *numbers.entry(root(&mut parent, triangle[0])).or_insert(next)
    };
    let of_triangle = triangles.iter().map(&mut number).collect();
    (of_triangle, numbers.len() as u32)
}

/// The representative of a corner's set; ways to it are halved on the way.
pub(crate) fn root(parent: &mut [u32], mut v: u32) -> u32 {
    while parent[v as usize] != v {
        parent[v as usize] = parent[parent[v as usize] as usize];
        v = parent[v as usize];
    }
    v
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{SceneBuilder, block};

    #[test]
    fn blocks_of_one_mesh_are_parts_of_their_own() {
        let block = |x: f32| block(Vec3::new(x, 0.0, 0.0), Vec3::new(x + 1.0, 1.0, 1.0));
        // The second and the third share a face's corners.
        let soup: Vec<[Vec3; 3]> = [0.0, 3.0, 4.0].into_iter().flat_map(block).collect();
        let scene = SceneBuilder::new().soup(&soup).soup(&block(9.0)).build();
        let found = Components::new(&scene, &Geometry::new(&scene));
        assert_eq!(found.count, 3);
        let first = |block: usize| found.of_triangle[12 * block];
        assert_eq!([0, 1, 2, 3].map(first), [0, 1, 1, 2]);
        assert!((0..4).all(|b| found.of_triangle[12 * b..12 * (b + 1)].iter().all(|part| *part == first(b))));
    }
}
