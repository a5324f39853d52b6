//! Scenes made by code, for the tests of this workspace. Not part of the public interface.

pub mod atlas;

use crate::scene::{Alpha, Dropped, Image, Instance, Material, Mesh, Node, Role, Scene, Source, TextureRef};
use glam::{DMat4, DVec3, Vec2, Vec3, Vec4};

/// Builds a [`Scene`] without a file.
#[derive(Debug, Clone)]
pub struct SceneBuilder {
    scene: Scene,
}

impl Default for SceneBuilder {
    fn default() -> Self {
        Self::new()
    }
}

impl SceneBuilder {
    /// An empty scene with one opaque grey material.
    pub fn new() -> Self {
        Self {
            scene: Scene {
                source: Source { file_name: "made by code".into(), sha256: String::new() },
                nodes: Vec::new(),
                meshes: Vec::new(),
                instances: Vec::new(),
                materials: vec![opaque()],
                images: Vec::new(),
                cameras: Vec::new(),
                sun_direction: None,
                centre_m: DVec3::ZERO,
                half_extent_m: DVec3::ZERO,
                dropped: Dropped::default(),
                warnings: Vec::new(),
                file: None,
            },
        }
    }

    /// Adds triangles that share no vertex, in world space, as one instance.
    pub fn soup(self, triangles: &[[Vec3; 3]]) -> Self {
        self.soup_of(triangles, opaque())
    }

    /// The same, of a material.
    pub fn soup_of(self, triangles: &[[Vec3; 3]], material: Material) -> Self {
        let positions: Vec<Vec3> = triangles.iter().flatten().copied().collect();
        let indices = (0..positions.len() as u32).collect();
        self.mesh_of(Mesh { positions, indices, ..Mesh::default() }, material, &[DMat4::IDENTITY])
    }

    /// Adds a mesh under one node per matrix.
    pub fn mesh_of(mut self, mut mesh: Mesh, material: Material, world_from_object: &[DMat4]) -> Self {
        let scene = &mut self.scene;
        scene.materials.push(material);
        mesh.material = scene.materials.len() - 1;
        mesh.gltf = (scene.meshes.len(), 0);
        scene.meshes.push(mesh);
        for &matrix in world_from_object {
            let node = Node {
                name: None,
                gltf: scene.nodes.len(),
                parent: None,
                parent_from_node: matrix,
                world_from_node: matrix,
            };
            scene.nodes.push(node);
            scene.instances.push(Instance {
                node: scene.nodes.len() - 1,
                mesh: scene.meshes.len() - 1,
                bake_from_object: matrix,
                is_mirrored: matrix.determinant() < 0.0,
                role: Role::default(),
            });
        }
        self
    }

    /// Adds an axis-aligned box, closed, facing outwards.
    pub fn block(self, min: Vec3, max: Vec3) -> Self {
        self.soup(&block(min, max))
    }

    /// Adds an image and gives back its index with the builder.
    pub fn image(mut self, width: u32, height: u32, rgba: Vec<[u8; 4]>) -> (Self, usize) {
        let name = "made by code".into();
        self.scene.images.push(Image { name, width, height, rgba });
        let index = self.scene.images.len() - 1;
        (self, index)
    }

    /// The scene, its bake space centred on its bounding box.
    pub fn build(mut self) -> Scene {
        let scene = &mut self.scene;
        let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for instance in &scene.instances {
            for position in &scene.meshes[instance.mesh].positions {
                let world = instance.bake_from_object.transform_point3(position.as_dvec3());
                (min, max) = (min.min(world), max.max(world));
            }
        }
        if min.is_finite() && max.is_finite() {
            scene.centre_m = ((min + max) * 0.5).as_vec3().as_dvec3();
            scene.half_extent_m = (max - min) * 0.5;
        }
        for instance in &mut scene.instances {
            instance.bake_from_object = DMat4::from_translation(-scene.centre_m) * instance.bake_from_object;
        }
        self.scene
    }
}

/// An opaque, single-sided, mid-grey material.
pub fn opaque() -> Material {
    Material {
        name: None,
        gltf: None,
        base_color: Vec4::new(0.5, 0.5, 0.5, 1.0),
        base_color_texture: None,
        emissive: Vec3::ZERO,
        alpha: Alpha::Opaque,
        is_double_sided: false,
        is_unlit: false,
        is_clear: false,
    }
}

/// A double-sided material whose texture is an alpha mask with a cutoff of one half.
pub fn alpha_masked(texture: TextureRef) -> Material {
    Material {
        base_color_texture: Some(texture),
        alpha: Alpha::Mask { cutoff: 0.5 },
        is_double_sided: true,
        ..opaque()
    }
}

/// The twelve triangles of an axis-aligned box, facing outwards.
pub fn block(min: Vec3, max: Vec3) -> Vec<[Vec3; 3]> {
    let corner = |i: usize| {
        let pick = |bit: usize, axis: usize| if i >> bit & 1 == 1 { max[axis] } else { min[axis] };
        Vec3::new(pick(0, 0), pick(1, 1), pick(2, 2))
    };
    const FACES: [[usize; 4]; 6] = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    FACES.iter().flat_map(|f| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]].map(|t| t.map(corner))).collect()
}

/// A level square facing up, from two triangles.
pub fn floor(min: Vec2, max: Vec2, y: f32) -> Vec<[Vec3; 3]> {
    let [a, b, c, d] =
        [[min.x, min.y], [min.x, max.y], [max.x, max.y], [max.x, min.y]].map(|[x, z]| Vec3::new(x, y, z));
    vec![[a, b, c], [a, c, d]]
}

/// A unit sphere: an icosahedron, each triangle split in four `level` times.
pub fn icosphere(level: u32) -> Vec<[Vec3; 3]> {
    let mut triangles = icosahedron();
    for _ in 0..level {
        triangles = triangles.into_iter().flat_map(quarter).collect();
    }
    triangles
}

fn quarter([a, b, c]: [Vec3; 3]) -> [[Vec3; 3]; 4] {
    // Midpoints are the same from both sides of an edge, since addition commutes.
    let [ab, bc, ca] = [(a + b).normalize(), (b + c).normalize(), (c + a).normalize()];
    [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
}

fn icosahedron() -> Vec<[Vec3; 3]> {
    let g = (1.0 + 5f32.sqrt()) / 2.0;
    let corners: Vec<Vec3> = [1.0, -1.0]
        .into_iter()
        .flat_map(|s| [g, -g].map(|t| [Vec3::new(0.0, s, t), Vec3::new(s, t, 0.0), Vec3::new(t, 0.0, s)]))
        .flatten()
        .map(Vec3::normalize)
        .collect();
    let edge = 1.1 * (4.0 / (1.0 + g * g)).sqrt();
    let near = |i: usize, j: usize| corners[i].distance(corners[j]) < edge;
    let mut faces = Vec::new();
    for i in 0..12 {
        for j in i + 1..12 {
            for k in j + 1..12 {
                if near(i, j) && near(j, k) && near(i, k) {
                    let [a, b, c] = [corners[i], corners[j], corners[k]];
                    faces.push(if (b - a).cross(c - a).dot(a) > 0.0 { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    faces
}

/// A ball of `columns` by `rows` faces with smooth normals, its vertices shared as modelling programs share them.
pub fn ball(columns: u32, rows: u32, centre: Vec3, radius: f32) -> Mesh {
    let across = columns + 1;
    let normal = |i: u32| {
        let row = i / across;
        // Exact, so that a pole is one point.
        match row {
            0 => return Vec3::Y,
            _ if row == rows => return Vec3::NEG_Y,
            _ => {}
        }
        let down = row as f32 / rows as f32 * std::f32::consts::PI;
        let around = (i % across % columns) as f32 / columns as f32 * std::f32::consts::TAU;
        Vec3::new(down.sin() * around.cos(), down.cos(), down.sin() * around.sin())
    };
    let normals: Vec<Vec3> = (0..across * (rows + 1)).map(normal).collect();
    let face = |i: u32| {
        let (row, column) = (i / columns, i % columns);
        let [a, b] = [row * across + column, (row + 1) * across + column];
        let upper = (row > 0).then_some([a, a + 1, b]);
        let lower = (row + 1 < rows).then_some([a + 1, b + 1, b]);
        upper.into_iter().chain(lower).flatten()
    };
    let indices = (0..columns * rows).flat_map(face).collect();
    let positions = normals.iter().map(|normal| centre + *normal * radius).collect();
    Mesh { positions, normals: Some(normals), indices, ..Mesh::default() }
}

/// The mesh seen from the other side: its triangles and normals turned over.
pub fn turned_over(mut mesh: Mesh) -> Mesh {
    mesh.indices.chunks_exact_mut(3).for_each(|triangle| triangle.swap(1, 2));
    mesh.normals.iter_mut().flatten().for_each(|normal| *normal = -*normal);
    mesh
}

/// The next number in [0, 1) of a linear congruential sequence (Knuth's MMIX constants).
pub fn pseudo_random(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1u64 << 53) as f64
}
