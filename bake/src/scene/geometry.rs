//! Every triangle of every instance, in bake space, in one array.
//!
//! Rays are traced against this array, texels are sampled on it, and frames are drawn from it. Positions are computed
//! once, in `f64`, and rounded once to `f32`, so a point computed on a triangle lies on that same triangle for the
//! tracer. The doc of [`crate::scene`] explains the spaces.

use super::Scene;
use super::smooth::{self, SmoothPoint, SmoothTriangles};
use glam::{DVec3, Vec3};

/// Flattened triangles of a scene, in the order of its instances.
#[derive(Debug, Clone)]
pub struct Geometry {
    /// Corners in bake space, in the mesh's own order (a mirrored instance keeps it; see [`Geometry::normal`]).
    pub triangles: Vec<[Vec3; 3]>,
    /// For each instance, the index of its first triangle; one more entry at the end.
    pub first_triangle: Vec<u32>,
    /// For each triangle, its instance.
    pub instance: Vec<u32>,
    /// For each instance, the sign that turns the corners' cross product to the front: -1 if the instance is mirrored.
    front_sign: Vec<f64>,
    /// Corner normals of triangles that are facets of something smooth.
    smooth: SmoothTriangles,
}

/// A triangle found by its index.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SurfaceTriangle {
    /// Index in [`Scene::instances`].
    pub instance: usize,
    /// Index of the triangle within the instance's mesh.
    pub mesh_triangle: usize,
}

impl Geometry {
    /// Transforms every instance, and finds what is smooth: see [`SmoothPoint`]. Triangles of
    /// [`Alpha::Invisible`](super::Alpha::Invisible) surfaces are kept, so that indices stay aligned with the scene;
    /// [`Geometry::is_there`] tells them apart.
    pub fn new(scene: &Scene) -> Self {
        let faceted = Self::faceted(scene);
        Self { smooth: SmoothTriangles::of(scene, &faceted), ..faceted }
    }

    /// The same without regard to shading normals: every triangle is flat.
    pub fn faceted(scene: &Scene) -> Self {
        let count = scene.triangle_count();
        let mut geometry = Self {
            triangles: Vec::with_capacity(count),
            first_triangle: Vec::with_capacity(scene.instances.len() + 1),
            instance: Vec::with_capacity(count),
            front_sign: Vec::with_capacity(scene.instances.len()),
            smooth: SmoothTriangles::default(),
        };
        for (index, instance) in scene.instances.iter().enumerate() {
            geometry.first_triangle.push(geometry.triangles.len() as u32);
            geometry.front_sign.push(if instance.is_mirrored { -1.0 } else { 1.0 });
            let mesh = &scene.meshes[instance.mesh];
            let corners: Vec<Vec3> = mesh
                .positions
                .iter()
                .map(|p| instance.bake_from_object.transform_point3(p.as_dvec3()).as_vec3())
                .collect();
            for triangle in mesh.indices.chunks_exact(3) {
                geometry.triangles.push([0, 1, 2].map(|k| corners[triangle[k] as usize]));
                geometry.instance.push(index as u32);
            }
        }
        geometry.first_triangle.push(geometry.triangles.len() as u32);
        geometry
    }

    /// The instance, and the triangle within its mesh, of a flat index.
    pub fn surface(&self, triangle: usize) -> SurfaceTriangle {
        let instance = self.instance[triangle] as usize;
        SurfaceTriangle { instance, mesh_triangle: triangle - self.first_triangle[instance] as usize }
    }

    /// The triangle's front normal, unit length, or zero where its corners coincide after rounding.
    pub fn normal(&self, triangle: usize) -> DVec3 {
        let [a, b, c] = self.triangles[triangle].map(|v| v.as_dvec3());
        let sign = self.front_sign[self.instance[triangle] as usize];
        ((b - a).cross(c - a) * sign).normalize_or_zero()
    }

    /// The point with barycentric weights `(1 - u - v, u, v)`, in bake space.
    pub fn point(&self, triangle: usize, [u, v]: [f64; 2]) -> DVec3 {
        let [a, b, c] = self.triangles[triangle].map(|p| p.as_dvec3());
        a * (1.0 - u - v) + b * u + c * v
    }

    /// How many triangles are facets of something smooth.
    pub fn smooth_count(&self) -> usize {
        self.smooth.count()
    }

    /// Whether a triangle is a facet of something smooth.
    pub fn is_smooth(&self, triangle: usize) -> bool {
        self.smooth.normals(triangle).is_some()
    }

    /// What shading normals say of a point (weights of its triangle's second and third corner); none where the triangle
    /// is flat.
    pub fn smooth_point(&self, triangle: usize, [u, v]: [f64; 2]) -> Option<SmoothPoint> {
        let [a, b, c] = self.smooth.normals(triangle)?;
        let face = self.normal(triangle);
        let lifts = self.edge_lifts_m(triangle)?;
        Some(SmoothPoint {
            normal: (a * (1.0 - u - v) + b * u + c * v).normalize_or(face),
            lift_m: [face, -face].map(|side| smooth::lift(&lifts, [u, v], side)),
        })
    }

    /// For the edges of a smooth triangle, from each corner to the next, the vector that its bulge is made of:
    /// a point with weights a, b and c moves by `ab` times the first, `bc` times the second and `ca` times the third,
    /// of those that point to the side that is seen.
    pub fn edge_lifts_m(&self, triangle: usize) -> Option<[DVec3; 3]> {
        let normals = self.smooth.normals(triangle)?;
        Some(smooth::edge_lifts(&self.triangles[triangle].map(|corner| corner.as_dvec3()), &normals))
    }

    /// Whether the triangle can be seen: its instance is there, and its corners do not coincide.
    pub fn is_there(&self, scene: &Scene, triangle: usize) -> bool {
        scene.is_there(self.instance[triangle] as usize) && self.normal(triangle) != DVec3::ZERO
    }

    /// Whether the triangle can block light: its instance casts, and its corners do not coincide.
    pub fn casts(&self, scene: &Scene, triangle: usize) -> bool {
        scene.casts(self.instance[triangle] as usize) && self.normal(triangle) != DVec3::ZERO
    }

    /// Whether the triangle can be shaded: its instance takes shadows, and its corners do not coincide.
    pub fn receives(&self, scene: &Scene, triangle: usize) -> bool {
        scene.receives(self.instance[triangle] as usize) && self.normal(triangle) != DVec3::ZERO
    }
}
