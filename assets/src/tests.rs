//! What the committed scene promises.

use std::collections::HashMap;
use std::sync::OnceLock;

use glam::{DVec3, Vec3};

use crate::scene::{Content, Mesh, Node, Scene};
use crate::weld::{PointKey, point_key};

fn scene() -> &'static Scene {
    static SCENE: OnceLock<Scene> = OnceLock::new();
    SCENE.get_or_init(crate::gas_station_scene)
}

/// The corners of every triangle of a mesh.
fn triangles(mesh: &Mesh) -> impl Iterator<Item = [DVec3; 3]> {
    mesh.primitives.iter().flat_map(|p| {
        let at = |k: u32| Vec3::from_array(p.positions_m[k as usize]).as_dvec3();
        p.indices.chunks_exact(3).map(move |t| [at(t[0]), at(t[1]), at(t[2])])
    })
}

/// How often each directed edge is used.
fn directed_edges(mesh: &Mesh) -> HashMap<(PointKey, PointKey), u32> {
    let mut edges = HashMap::new();
    for corners in triangles(mesh) {
        let key = corners.map(point_key);
        for k in 0..3 {
            *edges.entry((key[k], key[(k + 1) % 3])).or_default() += 1;
        }
    }
    edges
}

#[test]
fn committed_file_is_what_the_code_makes() {
    let committed = include_bytes!("../gas_station.glb");
    let made = crate::glb::write(scene());
    assert!(made == committed, "run `cargo run -p sunbake-assets` and commit gas_station.glb");
}

/// Triangles that a node draws.
fn triangle_count(node: &Node) -> usize {
    match node.content {
        Content::Mesh(id) => triangles(&scene().meshes[id.0]).count(),
        Content::Camera { .. } => 0,
    }
}

#[test]
fn triangle_count_is_in_range() {
    let count: usize = scene().nodes.iter().map(triangle_count).sum();
    assert!((30_000..150_000).contains(&count), "{count} triangles");
}

#[test]
fn no_triangle_is_degenerate() {
    for mesh in &scene().meshes {
        for [a, b, c] in triangles(mesh) {
            let double_area_m2 = (b - a).cross(c - a).length();
            assert!(double_area_m2 > 1e-8, "{}: {a} {b} {c}", mesh.name);
        }
    }
}

#[test]
fn closed_meshes_are_closed() {
    for mesh in scene().meshes.iter().filter(|m| m.closed) {
        let edges = directed_edges(mesh);
        for (&(a, b), &count) in &edges {
            let back = edges.get(&(b, a)).copied().unwrap_or(0);
            assert_eq!((count, back), (1, 1), "{}: edge {a:?} {b:?}", mesh.name);
        }
    }
}

/// The parts of a mesh: triangles that hang together by their corners.
fn parts(mesh: &Mesh) -> Vec<Vec<[DVec3; 3]>> {
    let mut part_of: HashMap<PointKey, usize> = HashMap::new();
    let mut parts: Vec<Vec<[DVec3; 3]>> = Vec::new();
    for tri in triangles(mesh) {
        let keys = tri.map(point_key);
        let mut near: Vec<usize> = keys.iter().filter_map(|k| part_of.get(k).copied()).collect();
        near.sort_unstable();
        near.dedup();
        let home = near.first().copied().unwrap_or_else(|| {
            parts.push(vec![]);
            parts.len() - 1
        });
        for &other in near.iter().skip(1) {
            let moved = std::mem::take(&mut parts[other]);
            part_of.values_mut().filter(|p| **p == other).for_each(|p| *p = home);
            parts[home].extend(moved);
        }
        parts[home].push(tri);
        part_of.extend(keys.map(|k| (k, home)));
    }
    parts.retain(|p| !p.is_empty());
    parts
}

#[test]
fn every_part_of_a_closed_mesh_faces_outwards() {
    for mesh in scene().meshes.iter().filter(|m| m.closed) {
        for part in parts(mesh) {
            // Volumes are taken around a corner of the part: around the origin, small parts would drown in rounding.
            let origin = part[0][0];
            let volume = |[a, b, c]: &[DVec3; 3]| (*a - origin).dot((*b - origin).cross(*c - origin)) / 6.0;
            let volume_m3: f64 = part.iter().map(volume).sum();
            assert!(volume_m3 > 0.0, "{} at {origin}: {volume_m3} m3", mesh.name);
        }
    }
}

#[test]
fn normals_have_unit_length_and_follow_the_faces() {
    for mesh in &scene().meshes {
        for p in &mesh.primitives {
            for t in p.indices.chunks_exact(3) {
                let at = |k: usize| Vec3::from_array(p.positions_m[t[k] as usize]);
                let face = (at(1) - at(0)).cross(at(2) - at(0));
                for &k in t {
                    let normal = Vec3::from_array(p.normals[k as usize]);
                    assert!((normal.length() - 1.0).abs() < 1e-5, "{}", mesh.name);
                    assert!(normal.dot(face) > -0.3 * face.length(), "{}: {normal} {face}", mesh.name);
                }
            }
        }
    }
}

#[test]
fn some_node_is_mirrored_and_meshes_are_shared() {
    let nodes = &scene().nodes;
    assert!(nodes.iter().any(|n| n.scale.x < 0.0));
    assert!(nodes.len() > scene().meshes.len() * 2);
}
