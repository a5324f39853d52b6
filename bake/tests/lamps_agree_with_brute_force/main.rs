//! Times at which points see a lamp, in closed form and by rays, against brute force.

mod brute_force;
mod leaves_and_random_triangles;
mod walls_and_spheres;

use glam::{Vec2, Vec3};
use sunbake::testing::floor;

fn ground() -> Vec<[Vec3; 3]> {
    floor(Vec2::splat(-5.0), Vec2::splat(5.0), 0.0)
}

fn wall(min: [f32; 2], max: [f32; 2], z: f32) -> Vec<[Vec3; 3]> {
    let level = floor(Vec2::from(min), Vec2::from(max), 0.0);
    level.iter().map(|t| t.map(|v| Vec3::new(v.x, v.z, z))).collect()
}
