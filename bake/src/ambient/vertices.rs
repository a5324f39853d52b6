//! Ambient visibility of vertices, for engines without a second set of texture coordinates.
//!
//! A vertex stands for the surface around it. Its rays start from one point in each of its triangles, an eighth of the
//! way to the triangle's middle, so that none starts on an edge where walls meet. Points inside a solid are skipped;
//! otherwise every vertex that touches the ground would be darkened from below. Vertices of an instance with the same
//! position and normal (split by texture coordinates, for instance) share one value. Vertices cannot hold detail inside
//! a large triangle (Kavan, Bargteil and Sloan, "Least squares vertex baking", *Computer Graphics Forum* 30(4), 2011,
//! discuss what they can).

use super::estimate::{AmbientEngine, Estimates, solve_ambient};
use super::point::AmbientPoint;
use crate::atlas::SurfacePoint;
use crate::scene::{Geometry, Scene, ShadingNormals};
use std::collections::HashMap;

/// How far a corner's point is moved towards the middle of its triangle.
const PULL: f64 = 0.125;

/// For each instance, the ambient visibility of each vertex of its mesh, 0 to 1; of double-sided surfaces, that of the
/// side with more. Instances that take no shadows have 1. `on_progress` gets the number of positions that were done and
/// returns false to stop; then there is no answer. The second value is the number of rays traced.
pub fn ambient_visibility_of_vertices(
    engine: &AmbientEngine,
    scene: &Scene,
    geometry: &Geometry,
    normals: &ShadingNormals,
    on_progress: impl Fn(usize) -> bool + Sync,
) -> Option<(Vec<Vec<f32>>, u64)> {
    let mut corners: Vec<Vec<AmbientPoint>> = Vec::new();
    let mut places: Vec<Vec<u32>> = Vec::with_capacity(scene.instances.len());
    for instance in 0..scene.instances.len() {
        places.push(gather(scene, geometry, normals, instance, &mut corners));
    }
    let texel =
        |place: usize, points: &mut Vec<AmbientPoint>| engine.add_visible(corners[place].iter().copied(), points);
    let runs = solve_ambient(engine, corners.len(), texel, on_progress)?;
    let visibility = lighter_sides(&runs);
    let of_instance = |places: Vec<u32>| places.iter().map(|&place| value(&visibility, place)).collect();
    Some((places.into_iter().map(of_instance).collect(), runs.iter().map(|run| run.rays).sum()))
}

/// A vertex without a triangle has 1.
fn value(visibility: &[f32], place: u32) -> f32 {
    visibility.get(place as usize).copied().unwrap_or(1.0)
}

fn lighter_sides(runs: &[Estimates]) -> Vec<f32> {
    let mut visibility = Vec::new();
    for run in runs {
        let first = visibility.len();
        visibility.extend(run.front.iter().map(|front| front.visibility));
        for (index, back) in &run.back {
            let side = &mut visibility[first + *index as usize];
            *side = side.max(back.visibility);
        }
    }
    visibility
}

/// Adds the points of an instance's vertices to `places`, one entry per position and normal. Gives the entry of each
/// vertex, or `u32::MAX` for a vertex without a triangle.
fn gather(
    scene: &Scene,
    geometry: &Geometry,
    normals: &ShadingNormals,
    instance: usize,
    places: &mut Vec<Vec<AmbientPoint>>,
) -> Vec<u32> {
    let mesh = &scene.meshes[scene.instances[instance].mesh];
    let first = geometry.first_triangle[instance] as usize;
    let mut of_vertex = vec![u32::MAX; mesh.positions.len()];
    if !scene.receives(instance) {
        return of_vertex;
    }
    let mut known: HashMap<[u32; 6], u32> = HashMap::new();
    for (index, &vertex) in mesh.indices.iter().enumerate() {
        let vertex = vertex as usize;
        let normal = mesh.normals.as_ref().map_or(glam::Vec3::ZERO, |normals| normals[vertex]);
        let key = std::array::from_fn(|k| if k < 3 { mesh.positions[vertex][k] } else { normal[k - 3] }.to_bits());
        let place = *known.entry(key).or_insert_with(|| {
            places.push(Vec::new());
            places.len() as u32 - 1
        });
        of_vertex[vertex] = place;
        places[place as usize].push(corner(scene, geometry, normals, first + index / 3, index % 3));
    }
    of_vertex
}

/// The point that stands for a corner of a triangle.
fn corner(
    scene: &Scene,
    geometry: &Geometry,
    normals: &ShadingNormals,
    triangle: usize,
    corner: usize,
) -> AmbientPoint {
    let at = |pull: f64| [1, 2].map(|k| if corner == k { 1.0 - pull * 2.0 / 3.0 } else { pull / 3.0 });
    AmbientPoint {
        surface: SurfacePoint::of_triangle(scene, geometry, triangle, at(PULL)),
        shading_normal: normals.at(scene, geometry, triangle, at(0.0)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::AmbientRequest;
    use crate::testing::{SceneBuilder, block};
    use crate::trace::Tracer;
    use glam::Vec3;

    fn visibility_of(scene: &Scene) -> Vec<Vec<f32>> {
        let geometry = Geometry::new(scene);
        let tracer = Tracer::new(scene, &geometry);
        let engine = AmbientEngine::new(scene, &geometry, &tracer, AmbientRequest::with_rays(1024).estimate);
        ambient_visibility_of_vertices(&engine, scene, &geometry, &ShadingNormals::new(scene), |_| true).unwrap().0
    }

    #[test]
    fn a_vertex_inside_a_solid_is_dark_and_darkens_no_other() {
        let ground = block(Vec3::new(-50.0, -9.0, -50.0), Vec3::new(50.0, 0.0, 50.0));
        let stake = block(Vec3::new(-0.5, -2.0, -0.5), Vec3::new(0.5, 1.0, 0.5));
        let scene = SceneBuilder::new().soup(&ground).soup(&stake).build();
        for (position, &visibility) in scene.meshes[1].positions.iter().zip(&visibility_of(&scene)[1]) {
            assert!(if position.y < 0.0 { visibility == 0.0 } else { visibility > 0.5 }, "{visibility} at {position}");
        }
    }

    #[test]
    fn vertices_on_the_ground_see_half_of_the_sky_and_those_on_top_all_of_it() {
        // Both are solids, and they touch: what lies between them is buried.
        let ground = block(Vec3::new(-500.0, -1.0, -500.0), Vec3::new(500.0, 0.0, 500.0));
        let cube = block(Vec3::new(-1.0, 0.0, -1.0), Vec3::new(1.0, 2.0, 1.0));
        let scene = SceneBuilder::new().soup(&ground).soup(&cube).build();
        let found = visibility_of(&scene);
        for (position, &visibility) in scene.meshes[1].positions.iter().zip(&found[1]) {
            // No normals: a vertex is the mean of its faces, an upper one of a lid and of two or four walls.
            let expected = if position.y > 1.0 { 0.55..0.85 } else { 0.45..0.53 };
            assert!(expected.contains(&visibility), "{visibility} at {position}");
        }
    }
}
