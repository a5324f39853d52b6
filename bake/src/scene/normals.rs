//! Repairs vertex normals, so that all have unit length.

use glam::{DVec3, Vec3};

/// Normalises all normals. One that is zero or not finite is replaced by the area-weighted mean normal of the triangles
/// at its vertex.
pub(super) fn repaired(mut normals: Vec<Vec3>, positions: &[Vec3], indices: &[u32]) -> Vec<Vec3> {
    let unit = |normal: Vec3| normal.as_dvec3().try_normalize().map(DVec3::as_vec3);
    let mut is_sound = true;
    for normal in &mut normals {
        *normal = unit(*normal).unwrap_or(Vec3::ZERO);
        is_sound &= *normal != Vec3::ZERO;
    }
    if !is_sound {
        let flat = from_triangles(positions, indices);
        for (normal, flat) in normals.iter_mut().zip(flat).filter(|(normal, _)| **normal == Vec3::ZERO) {
            *normal = flat;
        }
    }
    normals
}

/// The area-weighted mean normal of the triangles at each vertex; +Y where they cancel.
fn from_triangles(positions: &[Vec3], indices: &[u32]) -> Vec<Vec3> {
    let mut sums = vec![DVec3::ZERO; positions.len()];
    for triangle in indices.as_chunks::<3>().0 {
        let [a, b, c] = triangle.map(|i| positions.get(i as usize).map_or(DVec3::ZERO, |p| p.as_dvec3()));
        let cross = (b - a).cross(c - a);
        for &corner in triangle {
            sums.get_mut(corner as usize).into_iter().for_each(|sum| *sum += cross);
        }
    }
    sums.into_iter().map(|sum| sum.try_normalize().unwrap_or(DVec3::Y).as_vec3()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn broken_normals_become_those_of_their_triangles() {
        let positions = [Vec3::ZERO, Vec3::X, Vec3::Z, Vec3::Y];
        let normals = vec![Vec3::ZERO, Vec3::splat(f32::NAN), Vec3::new(0.0, -3.0, 0.0), Vec3::INFINITY];
        let fixed = repaired(normals, &positions, &[0, 1, 2]);
        assert_eq!(fixed, [Vec3::NEG_Y, Vec3::NEG_Y, Vec3::NEG_Y, Vec3::Y]);
    }
}
