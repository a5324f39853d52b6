//! Plans are compared with what is built, and what each effect adds with what it states. These tests need a GPU
//! adapter.

mod baked;
mod looks;
mod shadow_maps;
mod volumes;

use glam::{DMat4, DVec3, Vec2, Vec3};
use sunbake::maps::Bits;
use sunbake::scene::{Mesh, Scene};
use sunbake::sun::SunPath;
use sunbake::testing::{SceneBuilder, ball, block, floor, opaque};
use sunbake_runtime::gpu::{Output, VolumeSettings};
use sunbake_runtime::shadow_maps::{MapSettings, Variant};
use sunbake_runtime::technique::{BakedCpu, BakedGpu, ShadowMaps, Technique, Truth, Volumes};
use sunbake_runtime::testing::masks::{gpu, lamp_at};
use sunbake_runtime::testing::{bake, standing_sun, view, with_lamp};
use sunbake_runtime::{DrawPlan, Filter, Shot, Stage};

/// Texels of a triangle's cell, each way.
const CELL: u32 = 6;
/// Where pictures are taken from.
const ASIDE: DVec3 = DVec3::new(4.0, 3.0, 5.0);
/// Pixels each way.
const EDGE: u32 = 16;

const OUTPUTS: [Output; 3] = [Output::Lit, Output::Visibility, Output::LampVisibility];

fn sun(radius_rad: f64) -> Option<SunPath> {
    Some(standing_sun(DVec3::new(0.3, 1.0, 0.2), radius_rad))
}

fn cube(x: f32) -> Vec<[Vec3; 3]> {
    block(Vec3::new(x, 0.0, 0.0), Vec3::new(x + 1.0, 1.0, 1.0))
}

fn shot(stage: &Stage, eye: DVec3) -> Shot<'_> {
    Shot::new(stage, view(stage, eye, DVec3::new(0.4, 0.3, 0.2), [EDGE; 2]))
}

/// Draws a picture of a kind.
fn draw(technique: &mut dyn Technique, shot: &Shot, output: Output) {
    let moment = shot.stage.moment(0.5);
    match output {
        Output::Lit => drop(technique.color(shot, &moment).unwrap()),
        Output::Visibility => drop(technique.visibility(shot, &moment).unwrap()),
        Output::LampVisibility => drop(technique.lamp_visibility(shot, &moment).unwrap()),
    }
}

fn plain_box(radius_rad: f64) -> Stage {
    bake(SceneBuilder::new().soup(&cube(0.0)).build(), sun(radius_rad), CELL, Bits::Sixteen)
}

/// The names of the effects that are on in one plan and off in another.
fn turned_on<'a>(plan: &'a DrawPlan, other: &DrawPlan) -> Vec<&'a str> {
    plan.needs
        .iter()
        .filter(|need| need.is_on && !other.is_on(need.effect.name()))
        .map(|need| need.effect.name())
        .collect()
}

fn on_ground(edit: impl Fn(SceneBuilder) -> SceneBuilder) -> Scene {
    edit(SceneBuilder::new().soup(&floor(Vec2::splat(-3.0), Vec2::splat(3.0), 0.0))).build()
}

fn with_box(builder: SceneBuilder) -> SceneBuilder {
    builder.soup(&cube(0.0))
}

#[test]
fn every_effect_states_why_its_cost_and_what_toggles_it() {
    let gpu = gpu();
    let stage = with_lamp(bake(on_ground(with_lid), sun(0.0047), CELL, Bits::Eight), &lamp_at(ASIDE), CELL);
    let shot = shot(&stage, ASIDE);
    let maps = MapSettings { size_texels: 64, ..MapSettings::new(Variant::Ground) };
    let mut all: Vec<Box<dyn Technique + '_>> = vec![
        Box::new(BakedGpu::new(&gpu, &stage, Filter::Bilinear).unwrap()),
        Box::new(BakedCpu::new(&stage, Filter::Bilinear)),
        Box::new(Volumes::new(&gpu, &stage, VolumeSettings::default()).unwrap()),
        Box::new(ShadowMaps::new(&gpu, &stage, maps).unwrap()),
        Box::new(Truth::Hard),
        Box::new(Truth::Soft { rays: 4 }),
    ];
    for technique in &mut all {
        for drawn in [false, true] {
            if drawn {
                draw(technique.as_mut(), &shot, Output::Lit);
            }
            let plan = technique.draw_plan(&shot, Output::Lit);
            assert!(plan.is_on("lamp") && plan.needs.len() > 2, "{}", technique.name());
            for need in &plan.needs {
                let is_said = |text: &str| text.len() > 2;
                let is_whole = is_said(&need.why()) && is_said(&need.cost()) && is_said(need.toggled_by());
                assert!(is_whole, "{}: {need:?}", technique.name());
            }
            let text = plan.in_words();
            assert!(text.lines().all(|line| line.chars().count() <= 110), "{text}");
        }
    }
}

/// Five sides of a box beside the other.
fn with_lid(builder: SceneBuilder) -> SceneBuilder {
    let lid: Vec<_> = cube(1.5)[2..].iter().map(|t| t.map(|v| v + Vec3::new(0.0, 0.2, 0.0))).collect();
    with_box(builder).soup(&lid)
}

/// A ball beside the box.
fn with_ball(builder: SceneBuilder) -> SceneBuilder {
    let mesh = ball(12, 8, Vec3::new(1.8, 1.1, 0.5), 0.5);
    with_box(builder).mesh_of(mesh, opaque(), &[DMat4::IDENTITY])
}

/// The quad with normals of something round.
fn bent_quad() -> Mesh {
    let quad = quad();
    let normals = quad.positions.iter().map(|p| Vec3::new(p.x - 0.5, 1.5, p.z - 0.5).normalize()).collect();
    Mesh { normals: Some(normals), ..quad }
}

fn quad() -> Mesh {
    let triangles = floor(Vec2::ZERO, Vec2::ONE, 1.5);
    let positions: Vec<Vec3> = triangles.iter().flatten().copied().collect();
    Mesh { indices: (0..6).collect(), positions, ..Mesh::default() }
}
