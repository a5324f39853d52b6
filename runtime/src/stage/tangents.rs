//! Tangents of meshes whose files have none.
//!
//! Based on: Mikkelsen, *Simulation of Wrinkled Surfaces Revisited*, 2008 (MikkTSpace), which glTF asks for.
//!
//! **Theory.** A triangle's tangent is the direction in which its u grows. A vertex has the mean of its triangles'
//! tangents, each made perpendicular to the vertex normal and weighted by the triangle's angle there. Triangles whose
//! texture is mirrored have a mean of their own.
//!
//! **Departures.** Triangles share a vertex where its position, normal and coordinates are the same numbers, whether or
//! not they share an edge.

use glam::{Vec2, Vec3, Vec4};
use std::collections::HashMap;
use sunbake::scene::alpha::image_uvs;
use sunbake::scene::{Mesh, TextureRef};

/// What corners that share a tangent have in common: bits of position, normal and coordinates, and the side of the
/// texture that shows.
type Shared = ([u32; 8], bool);

/// Least weight, for needles whose angles are lost in rounding.
const LEAST_ANGLE_RAD: f32 = 1e-4;

/// Tangents of the corners of all triangles, for a texture. A tangent is zero where coordinates do not change.
pub fn tangents(mesh: &Mesh, texture: &TextureRef) -> Vec<Vec4> {
    let corners: Vec<(Shared, Vec3)> = (0..mesh.triangle_count()).flat_map(|i| of_triangle(mesh, texture, i)).collect();
    let mut sums: HashMap<Shared, Vec3> = HashMap::new();
    for (shared, tangent) in &corners {
        *sums.entry(*shared).or_default() += *tangent;
    }
    let finished = |(shared, own): &(Shared, Vec3)| {
        let sum = sums.get(shared).and_then(|sum| sum.try_normalize());
        // Opposite tangents cancel out; then each keeps its own.
        sum.unwrap_or(own.normalize_or_zero()).extend(if shared.1 { -1.0 } else { 1.0 })
    };
    corners.iter().map(finished).collect()
}

/// For each corner, what it shares its tangent with, and the triangle's weighted tangent there.
fn of_triangle(mesh: &Mesh, texture: &TextureRef, triangle: usize) -> [(Shared, Vec3); 3] {
    let vertices = [0, 1, 2].map(|k| mesh.indices[3 * triangle + k] as usize);
    let points = vertices.map(|vertex| mesh.positions[vertex]);
    let uvs = image_uvs(mesh, texture, triangle);
    let (along, across) = ([points[1] - points[0], points[2] - points[0]], [uvs[1] - uvs[0], uvs[2] - uvs[0]]);
    let area = across[0].perp_dot(across[1]);
    // V points down, so where u grows to the right of the front, the bitangent is up and the area negative.
    let is_mirrored = area > 0.0;
    let tangent = (along[0] * across[1].y - along[1] * across[0].y) * area.signum();
    let tangent = if area == 0.0 { Vec3::ZERO } else { tangent.normalize_or_zero() };
    let flat = along[0].cross(along[1]).normalize_or_zero();
    [0, 1, 2].map(|k| {
        let normal = mesh.normals.as_ref().map_or(flat, |normals| normals[vertices[k]]);
        let [to_next, to_last] = [1, 2].map(|step| points[(k + step) % 3] - points[k]);
        let flattened = (tangent - normal * normal.dot(tangent)).normalize_or_zero();
        (
            shared(points[k], normal, uvs[k], is_mirrored),
            flattened * to_next.angle_between(to_last).max(LEAST_ANGLE_RAD),
        )
    })
}

fn shared(point: Vec3, normal: Vec3, uv: Vec2, is_mirrored: bool) -> Shared {
    // Adding zero turns -0 into 0.
    let numbers = [point.x, point.y, point.z, normal.x, normal.y, normal.z, uv.x, uv.y];
    (numbers.map(|x| (x + 0.0).to_bits()), is_mirrored)
}
