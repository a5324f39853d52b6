//! Points of smooth surfaces: every engine starts its rays where brute force does, and gates them alike.

use glam::{DMat4, DQuat, DVec3, Vec2, Vec3};
use sunbake::scene::{Material, Mesh, Scene};
use sunbake::testing::{SceneBuilder, ball, floor, opaque, turned_over};
use sunbake_tests::Traced;
use sunbake_tests::engines::all_must_agree;
use sunbake_tests::paths::Random;

/// Random points of the smooth triangles.
fn agree(name: &str, scene: Scene, seed: u64) {
    let here = Traced::new(scene);
    let smooth: Vec<usize> = (0..here.geometry.triangles.len()).filter(|&i| here.geometry.is_smooth(i)).collect();
    let mut random = Random::new(seed);
    for _ in 0..6 {
        let mut point = || {
            let (u, v) = (random.range(0.0, 1.0), random.range(0.0, 1.0));
            here.point(smooth[random.index(smooth.len())], if u + v > 1.0 { [1.0 - u, 1.0 - v] } else { [u, v] })
        };
        let points: Vec<_> = (0..12).map(|_| point()).collect();
        assert!(points.iter().all(|point| point.smooth.is_some()));
        all_must_agree(name, &here, &random.path(), &points);
    }
}

fn ground() -> SceneBuilder {
    SceneBuilder::new().soup(&floor(Vec2::splat(-4.0), Vec2::splat(4.0), 0.0))
}

/// B19: a ball that hovers, one that stands on the ground, one half sunk, and two that overlap.
#[test]
fn b19_smooth_balls_agree_with_brute_force() {
    for (seed, height) in [(1, 1.3), (2, 1.0), (3, 0.2)] {
        let low = ball(12, 8, Vec3::new(0.0, height, 0.0), 1.0);
        agree("a ball", ground().mesh_of(low, opaque(), &[DMat4::IDENTITY]).build(), seed);
    }
    let pair = [0.0, 1.6].map(|x| DMat4::from_translation(DVec3::new(x, 1.2, 0.0)));
    agree("two balls", ground().mesh_of(ball(10, 6, Vec3::ZERO, 1.0), opaque(), &pair).build(), 4);
}

/// B19 and B11: mirrored, stretched and sheared.
#[test]
fn b19_mirrored_and_stretched_balls_agree_with_brute_force() {
    let turn = DQuat::from_euler(glam::EulerRot::XYZ, 0.3, 0.7, -0.4);
    for (seed, scale) in [(5, DVec3::new(-1.0, 1.0, 1.0)), (6, DVec3::new(1.5, 0.6, -1.1))] {
        let matrix = DMat4::from_scale_rotation_translation(scale, turn, DVec3::Y * 1.5);
        agree("mirrored", ground().mesh_of(ball(12, 8, Vec3::ZERO, 1.0), opaque(), &[matrix]).build(), seed);
    }
}

/// B19: the inside of a bowl, and a sheet that is bent two ways and seen from both sides.
#[test]
fn b19_bowls_and_bent_sheets_agree_with_brute_force() {
    let bowl = turned_over(lower_half(ball(12, 8, Vec3::Y * 1.1, 1.0)));
    let both = Material { is_double_sided: true, ..opaque() };
    agree("a bowl", ground().mesh_of(bowl.clone(), opaque(), &[DMat4::IDENTITY]).build(), 7);
    agree("a bowl of two sides", ground().mesh_of(bowl, both.clone(), &[DMat4::IDENTITY]).build(), 8);
    agree("a saddle", ground().mesh_of(saddle(), both, &[DMat4::from_translation(DVec3::Y)]).build(), 9);
}

fn lower_half(mut mesh: Mesh) -> Mesh {
    let is_low = |triangle: &&[u32]| triangle.iter().all(|&i| mesh.positions[i as usize].y < 1.11);
    mesh.indices = mesh.indices.chunks_exact(3).filter(is_low).flatten().copied().collect();
    mesh
}

/// A sheet whose height is `(x^2 - z^2) / 3`.
fn saddle() -> Mesh {
    const EDGE: u32 = 5;
    let at = |i: u32| [i % EDGE, i / EDGE].map(|k| k as f32 / (EDGE - 1) as f32 * 2.0 - 1.0);
    let positions = (0..EDGE * EDGE).map(at).map(|[x, z]| Vec3::new(x, (x * x - z * z) / 3.0, z)).collect();
    let normals =
        (0..EDGE * EDGE).map(at).map(|[x, z]| Vec3::new(-x * 2.0 / 3.0, 1.0, z * 2.0 / 3.0).normalize()).collect();
    let cell = |i: u32| {
        let a = i / (EDGE - 1) * EDGE + i % (EDGE - 1);
        [a, a + EDGE, a + 1, a + 1, a + EDGE, a + EDGE + 1]
    };
    let indices = (0..(EDGE - 1) * (EDGE - 1)).flat_map(cell).collect();
    Mesh { positions, normals: Some(normals), indices, ..Mesh::default() }
}
