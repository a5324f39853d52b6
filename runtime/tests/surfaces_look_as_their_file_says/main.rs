//! Lit pictures show materials as glTF says: against closed forms, and on the GPU as on the CPU. These tests need a GPU
//! adapter.

mod blending;
mod files;
mod highlights;
mod normal_maps;
mod twins;

use glam::{DMat4, DVec3, Vec2, Vec3};
use sunbake::maps::Bits;
use sunbake::scene::{Material, Mesh, Role, Scene};
use sunbake::sun::SunPath;
use sunbake::testing::SceneBuilder;
use sunbake_runtime::gpu::Gpu;
use sunbake_runtime::technique::{BakedCpu, BakedGpu, Technique};
use sunbake_runtime::testing::{bake, standing_sun, view};
use sunbake_runtime::{Filter, Moment, Shot, Stage, View};

/// Where the sun stands in these tests: high, and aside.
const SUN: DVec3 = DVec3::new(0.48, 0.8, 0.36);

fn sun() -> Option<SunPath> {
    Some(standing_sun(SUN, 0.0))
}

/// A square on the ground, one metre from its middle to its edges, whose texture lies as on a page: u to +X, v to +Z.
fn square() -> Mesh {
    let corners = [Vec2::new(-1.0, -1.0), Vec2::new(-1.0, 1.0), Vec2::new(1.0, 1.0), Vec2::new(1.0, -1.0)];
    let order = [0, 1, 2, 0, 2, 3].map(|i| corners[i]);
    Mesh {
        positions: order.map(|p| Vec3::new(p.x, 0.0, p.y)).to_vec(),
        texcoords: vec![Some(order.map(|p| p * 0.5 + 0.5).to_vec())],
        indices: (0..6).collect(),
        ..Mesh::default()
    }
}

/// A baked stage of squares. Those that are less than half opaque neither cast nor take shadows, as in a file.
fn squares(all: &[(Mesh, Material, DMat4)]) -> Stage {
    let add = |builder: SceneBuilder, (mesh, material, at): &(Mesh, Material, DMat4)| {
        builder.mesh_of(mesh.clone(), material.clone(), &[*at])
    };
    bake(with_clear_panes(all.iter().fold(SceneBuilder::new(), add).build()), sun(), 12, Bits::Eight)
}

/// Gives panes that are less than half opaque the role that a file's have.
fn with_clear_panes(mut scene: Scene) -> Scene {
    for index in 0..scene.instances.len() {
        if scene.material(index).base_color.w < 0.5 {
            scene.instances[index].role = Role { casts: false, receives: false, ..Role::default() };
        }
    }
    scene
}

/// A small picture towards the origin of world space.
fn towards_origin(stage: &Stage, eye_m: DVec3) -> View {
    view(stage, eye_m, DVec3::ZERO, [9, 9])
}

/// Light of the middle pixel on the GPU and on the CPU, which must agree.
fn middle(gpu: &Gpu, stage: &Stage, eye_m: DVec3, moment: &Moment) -> Vec3 {
    let shot = Shot::new(stage, towards_origin(stage, eye_m));
    let mut on_gpu = BakedGpu::new(gpu, stage, Filter::Nearest).unwrap();
    let mut on_cpu = BakedCpu::new(stage, Filter::Nearest);
    let [a, b] = [on_gpu.color(&shot, moment).unwrap().pixels[40], on_cpu.color(&shot, moment).unwrap().pixels[40]];
    assert!((a - b).abs().max_element() < 2e-3 * (1.0 + a.max_element()), "GPU {a}, CPU {b}");
    b
}

/// The sun alone, at the middle of its stand.
fn sun_alone(stage: &Stage) -> Moment {
    stage.moment(0.5).without_sky()
}
