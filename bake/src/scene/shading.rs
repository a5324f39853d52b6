//! Shading normals in bake space, interpolated from the mesh's vertex normals.

use super::{Geometry, Scene};
use glam::{DMat3, DVec3, Vec3};

/// Least cosine between a shading normal and its triangle's normal; below it the triangle's normal is used.
const LEAST_COSINE: f64 = 0.1;

/// Transforms mesh normals to bake space.
#[derive(Debug, Clone)]
pub struct ShadingNormals {
    normal_from_object: Vec<DMat3>,
}

impl ShadingNormals {
    /// For every instance of a scene.
    pub fn new(scene: &Scene) -> Self {
        let inverse_transpose = |i: &super::Instance| DMat3::from_mat4(i.bake_from_object).inverse().transpose();
        Self { normal_from_object: scene.instances.iter().map(inverse_transpose).collect() }
    }

    /// Object space to bake space: a normal of an instance's mesh as a unit vector; zero if it has no direction.
    pub fn turned(&self, instance: usize, normal: Vec3) -> DVec3 {
        (self.normal_from_object[instance] * normal.as_dvec3()).normalize_or_zero()
    }

    /// The interpolated unit normal at a point of a triangle (weights of its second and third corner), on the
    /// triangle's front. The triangle's own normal where the mesh has no normals, or where they deviate too far from
    /// it.
    pub fn at(&self, scene: &Scene, geometry: &Geometry, triangle: usize, [u, v]: [f64; 2]) -> DVec3 {
        let plane = geometry.normal(triangle);
        let surface = geometry.surface(triangle);
        let mesh = &scene.meshes[scene.instances[surface.instance].mesh];
        let Some(normals) = &mesh.normals else { return plane };
        let vertex = |k: usize| mesh.indices[3 * surface.mesh_triangle + k] as usize;
        let corner = |k: usize| self.turned(surface.instance, normals[vertex(k)]);
        let blended = (corner(0) * (1.0 - u - v) + corner(1) * u + corner(2) * v).normalize_or_zero();
        if blended.dot(plane) < LEAST_COSINE { plane } else { blended }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Instance, Mesh, Node};
    use crate::testing::SceneBuilder;
    use glam::DMat4;

    fn scene(matrix: DMat4) -> Scene {
        let triangle = [Vec3::ZERO, Vec3::Z, Vec3::X];
        let mut scene = SceneBuilder::new().soup(&[triangle]).build();
        let tilted = Vec3::new(0.5, 1.0, 0.0).normalize();
        scene.meshes[0] = Mesh { normals: Some(vec![tilted; 3]), ..scene.meshes[0].clone() };
        scene.nodes[0] = Node { parent_from_node: matrix, world_from_node: matrix, ..scene.nodes[0].clone() };
        scene.instances[0] =
            Instance { bake_from_object: matrix, is_mirrored: matrix.determinant() < 0.0, ..scene.instances[0] };
        scene
    }

    fn normal(matrix: DMat4) -> DVec3 {
        let scene = scene(matrix);
        ShadingNormals::new(&scene).at(&scene, &Geometry::new(&scene), 0, [0.3, 0.3])
    }

    #[test]
    fn normals_turn_stretch_and_mirror_with_their_instance() {
        let tilted = DVec3::new(0.5, 1.0, 0.0).normalize();
        assert!(normal(DMat4::IDENTITY).distance(tilted) < 1e-6);
        // Stretched along x, the slope across x becomes gentler.
        let stretched = DVec3::new(0.25, 1.0, 0.0).normalize();
        assert!(normal(DMat4::from_scale(DVec3::new(2.0, 1.0, 1.0))).distance(stretched) < 1e-6);
        let mirrored = DVec3::new(-0.5, 1.0, 0.0).normalize();
        assert!(normal(DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0))).distance(mirrored) < 1e-6);
    }
}
