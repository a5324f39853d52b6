//! Triangle lists from lists, strips and fans, without degenerate triangles.
//!
//! Based on: Khronos Group, *glTF 2.0 Specification*, section 3.7.2.1 (topology types).
//!
//! A triangle is dropped if it repeats an index, has a corner that is not finite, or has no area. The last is decided
//! by shape, independent of size: height over longest edge is at most [`FLATTEST`]. A needle of 100,000 to 1 is kept,
//! since its plane is still known to a few digits in `f32`; one of 20,000,000 to 1 counts as a line, since its normal
//! would be noise.

use super::{Dropped, LoadError};
use crate::words::either;
use glam::{DVec3, Vec3};

/// Height over longest edge at and below which a triangle counts as a line.
const FLATTEST: f64 = 1e-7;

/// How vertices form triangles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Topology {
    List,
    Strip,
    Fan,
}

impl Topology {
    /// `None` for points and lines, which have no surface.
    pub fn from_mode(mode: u64) -> Option<Self> {
        match mode {
            4 => Some(Self::List),
            5 => Some(Self::Strip),
            6 => Some(Self::Fan),
            _ => None,
        }
    }

    /// Three indices a triangle. One or two indices left over at the end of a list are ignored.
    pub fn triangulate(self, order: &[u32]) -> Vec<u32> {
        match self {
            Self::List => order.as_chunks::<3>().0.as_flattened().to_vec(),
            Self::Strip => {
                let turn = |(i, w): (usize, &[u32; 3])| if i % 2 == 0 { *w } else { [w[0], w[2], w[1]] };
                order.array_windows().enumerate().flat_map(turn).collect()
            }
            Self::Fan => match order {
                [hub, rim @ ..] => rim.array_windows().flat_map(|[a, b]| [*a, *b, *hub]).collect(),
                [] => Vec::new(),
            },
        }
    }
}

/// An error if some index is not below `vertex_count`.
pub(super) fn check_range(indices: &[u32], vertex_count: usize, place: &str) -> Result<(), LoadError> {
    match indices.iter().position(|&index| index as usize >= vertex_count) {
        None => Ok(()),
        Some(at) => {
            let index = indices.get(at).copied().unwrap_or_default();
            let vertices = either(vertex_count as u64, "vertex", "vertices");
            let problem = format!("its index {at} is {index}, and it has only {vertex_count} {vertices}");
            Err(LoadError::structure(place, problem))
        }
    }
}

/// Removes degenerate triangles and counts them by reason. Indices must be in range.
pub(super) fn clean(indices: &[u32], positions: &[Vec3], dropped: &mut Dropped) -> Vec<u32> {
    let mut kept = Vec::with_capacity(indices.len());
    for triangle in indices.as_chunks::<3>().0 {
        let corners = triangle.map(|index| positions.get(index as usize).map_or(DVec3::NAN, |p| p.as_dvec3()));
        let [a, b, c] = *triangle;
        if a == b || b == c || c == a {
            dropped.repeated_index += 1;
        } else if !corners.iter().all(|corner| corner.is_finite()) {
            dropped.non_finite += 1;
        } else if is_line(corners) {
            dropped.zero_area += 1;
        } else {
            kept.extend(triangle);
        }
    }
    kept
}

fn is_line([a, b, c]: [DVec3; 3]) -> bool {
    let longest_squared = (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
    (b - a).cross(c - a).length() <= FLATTEST * longest_squared
}

/// The vertices that some triangle uses, in their old order, and the triangles renumbered to match.
pub(super) fn compact(indices: &[u32], vertex_count: usize) -> (Vec<u32>, Vec<u32>) {
    let mut new_from_old = vec![u32::MAX; vertex_count];
    for &index in indices {
        new_from_old.get_mut(index as usize).into_iter().for_each(|entry| *entry = 0);
    }
    let mut used = Vec::new();
    for (old, entry) in new_from_old.iter_mut().enumerate().filter(|(_, entry)| **entry == 0) {
        *entry = used.len() as u32;
        used.push(old as u32);
    }
    let indices = indices.iter().filter_map(|&index| new_from_old.get(index as usize).copied()).collect();
    (used, indices)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_and_fans_keep_every_triangle_facing_the_same_way() {
        assert_eq!(Topology::Strip.triangulate(&[0, 1, 2, 3, 4]), [0, 1, 2, 1, 3, 2, 2, 3, 4]);
        assert_eq!(Topology::Fan.triangulate(&[0, 1, 2, 3]), [1, 2, 0, 2, 3, 0]);
        assert_eq!(Topology::List.triangulate(&[0, 1, 2, 3, 4]), [0, 1, 2]);
        for topology in [Topology::List, Topology::Strip, Topology::Fan] {
            assert!(topology.triangulate(&[]).is_empty() && topology.triangulate(&[7]).is_empty());
        }
    }

    /// B7.
    #[test]
    fn bad_triangles_are_dropped_and_counted_by_reason() {
        let positions = [
            Vec3::ZERO,
            Vec3::X,
            Vec3::Y,
            Vec3::X * 2.0,
            Vec3::splat(f32::NAN),
            Vec3::new(f32::INFINITY, 0.0, 0.0),
            Vec3::X,
        ];
        let indices = [0, 1, 2, 0, 0, 2, 0, 1, 3, 0, 1, 4, 0, 5, 2, 1, 6, 2];
        let mut dropped = Dropped::default();
        assert_eq!(clean(&indices, &positions, &mut dropped), [0, 1, 2]);
        assert_eq!(dropped, Dropped { repeated_index: 1, zero_area: 2, non_finite: 2 });
    }

    #[test]
    fn needles_are_dropped_by_shape_at_any_size() {
        for size in [1e-12f32, 1e-4, 1.0, 1e4, 1e15] {
            let needle = |height: f32| [Vec3::ZERO, Vec3::X * size, Vec3::new(0.5 * size, height * size, 0.0)];
            let mut dropped = Dropped::default();
            assert_eq!(clean(&[0, 1, 2], &needle(1e-5), &mut dropped).len(), 3, "1e5 : 1 at {size}");
            assert_eq!(clean(&[0, 1, 2], &needle(5e-8), &mut dropped).len(), 0, "2e7 : 1 at {size}");
            assert_eq!(dropped.zero_area, 1);
        }
    }

    #[test]
    fn compaction_keeps_the_order_of_what_is_used() {
        let (used, indices) = compact(&[5, 1, 3, 3, 1, 5], 7);
        assert_eq!(used, [1, 3, 5]);
        assert_eq!(indices, [2, 0, 1, 1, 0, 2]);
    }

    #[test]
    fn an_index_beyond_the_vertices_is_named_with_its_place() {
        let error = check_range(&[0, 1, 9], 3, "meshes[2] primitive 1").expect_err("9 of 3").to_string();
        assert!(error.contains("meshes[2] primitive 1: its index 2 is 9, and it has only 3 vertices"), "{error}");
    }
}
