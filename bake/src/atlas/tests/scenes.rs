//! Scenes built by code.

use crate::scene::{Alpha, Dropped, Instance, Material, Mesh, Node, Role, Scene, Source};
use glam::{DMat4, DVec3, Vec2, Vec3, Vec4};

/// A scene of these meshes, each under these matrices.
pub fn scene(parts: Vec<(Mesh, Vec<DMat4>)>) -> Scene {
    let mut scene = Scene {
        source: Source { file_name: "made by code".into(), sha256: String::new() },
        nodes: Vec::new(),
        meshes: Vec::new(),
        instances: Vec::new(),
        materials: vec![material(Alpha::Opaque), material(Alpha::Invisible)],
        images: Vec::new(),
        cameras: Vec::new(),
        sun_direction: None,
        centre_m: DVec3::ZERO,
        half_extent_m: DVec3::ONE,
        dropped: Dropped::default(),
        warnings: Vec::new(),
        file: None,
    };
    for (mesh, matrices) in parts {
        for matrix in matrices {
            scene.nodes.push(Node {
                name: None,
                gltf: scene.nodes.len(),
                parent: None,
                parent_from_node: matrix,
                world_from_node: matrix,
            });
            scene.instances.push(Instance {
                node: scene.nodes.len() - 1,
                mesh: scene.meshes.len(),
                bake_from_object: matrix,
                is_mirrored: matrix.determinant() < 0.0,
                role: Role::default(),
            });
        }
        scene.meshes.push(mesh);
    }
    scene
}

fn material(alpha: Alpha) -> Material {
    Material {
        name: None,
        gltf: None,
        base_color: Vec4::ONE,
        base_color_texture: None,
        emissive: Vec3::ZERO,
        alpha,
        is_double_sided: false,
        is_unlit: false,
        is_clear: false,
    }
}

/// Once, where it is.
pub fn once() -> Vec<DMat4> {
    vec![DMat4::IDENTITY]
}

pub fn mesh(positions: Vec<Vec3>, indices: Vec<u32>) -> Mesh {
    Mesh { positions, indices, ..Mesh::default() }
}

/// The six sides of a box of this size, 24 vertices.
pub fn cuboid(size: Vec3) -> Mesh {
    let mut made = mesh(Vec::new(), Vec::new());
    for side in 0..6 {
        let (axis, sign) = (side / 2, if side % 2 == 0 { -1.0 } else { 1.0 });
        let corner = |a: f32, b: f32| {
            let mut p = [0.0; 3];
            (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (sign, a * sign, b);
            Vec3::from(p) * size * 0.5
        };
        let first = made.positions.len() as u32;
        made.positions.extend([corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)]);
        made.indices.extend([0, 1, 2, 0, 2, 3].map(|k| first + k));
    }
    made
}

/// A sphere of radius 1: `2 * rings * rings` quads, closed.
pub fn sphere(rings: u32) -> Mesh {
    let (around, mut made) = (2 * rings, mesh(Vec::new(), Vec::new()));
    for ring in 0..=rings {
        for step in 0..around {
            let polar = std::f32::consts::PI * ring as f32 / rings as f32;
            let azimuth = std::f32::consts::TAU * step as f32 / around as f32;
            made.positions.push(Vec3::new(polar.sin() * azimuth.cos(), polar.cos(), polar.sin() * azimuth.sin()));
        }
    }
    for ring in 0..rings {
        for step in 0..around {
            let at = |r: u32, s: u32| r * around + s % around;
            let (a, b, c, d) = (at(ring, step), at(ring, step + 1), at(ring + 1, step + 1), at(ring + 1, step));
            made.indices.extend(if ring == 0 { vec![a, c, d] } else { vec![a, b, c] });
            made.indices.extend(if ring == 0 || ring == rings - 1 { vec![] } else { vec![a, c, d] });
        }
    }
    made
}

/// Ground of `side` by `side` quads a metre wide, with hills of this height.
pub fn hills(side: u32, height: f32) -> Mesh {
    let mut made = mesh(Vec::new(), Vec::new());
    for z in 0..=side {
        for x in 0..=side {
            let (x, z) = (x as f32, z as f32);
            made.positions.push(Vec3::new(x, height * ((x * 0.7).sin() + (z * 0.5).cos()), z));
        }
    }
    for z in 0..side {
        for x in 0..side {
            let a = z * (side + 1) + x;
            let (b, c, d) = (a + 1, a + side + 1, a + side + 2);
            made.indices.extend([a, c, b, b, c, d]);
        }
    }
    made
}

/// Separate triangles from corner lists.
pub fn triangles(corners: &[[Vec3; 3]]) -> Mesh {
    mesh(corners.as_flattened().to_vec(), (0..3 * corners.len() as u32).collect())
}

/// A quad in the plane y = 0 with these texture coordinates at its low and high corner, in set 1.
pub fn lit_quad(low: Vec2, high: Vec2) -> Mesh {
    let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
    let mut quad = mesh(corners.map(|(x, z)| Vec3::new(x, 0.0, z)).to_vec(), vec![0, 2, 1, 0, 3, 2]);
    quad.texcoords = vec![None, Some(corners.map(|(x, z)| low + (high - low) * Vec2::new(x, z)).to_vec())];
    quad
}
