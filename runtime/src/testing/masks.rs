//! Hard masks compared with hard truth, and with the masks of every other way of drawing shadow volumes.

use super::{standing_sun, view};
use crate::camera::{Camera, View};
use crate::compare::MaskAgreement;
use crate::gpu::{Gpu, VolumeSettings};
use crate::image::Raster;
use crate::light::Moment;
use crate::shot::Shot;
use crate::stage::Stage;
use crate::technique::{LightKind, Technique, Truth, Volumes};
use crate::volumes::{Mode, VolumeOptimizations};
use glam::{DMat3, DVec3, Vec2};
use sunbake::lamp::{LampKey, LampPath};
use sunbake::scene::{Alpha, Scene};
use sunbake::testing::{SceneBuilder, floor};
use sunbake::trace::Direction;

/// A GPU. Tests that need one fail without.
pub fn gpu() -> Gpu {
    Gpu::open().expect("these tests need a GPU adapter: install mesa-vulkan-drivers")
}

/// A direction to the sun that is along no axis and no diagonal.
pub const OBLIQUE_SUN: DVec3 = DVec3::new(0.53, 0.62, 0.31);

/// Level ground, twelve metres wide.
pub fn ground() -> SceneBuilder {
    SceneBuilder::new().soup(&floor(Vec2::splat(-6.0), Vec2::splat(6.0), 0.0))
}

/// A view of the ground from above at a slant, 128 by 128 pixels.
pub fn oblique_view(stage: &Stage) -> View {
    view(stage, DVec3::new(4.1, 3.7, 5.3), DVec3::new(0.1, 0.4, -0.2), [128, 128])
}

/// A scene under a sun that stands still at t = 1/2.
pub fn under_sun(scene: Scene, towards: DVec3) -> Stage {
    Stage::plain(scene, Some(standing_sun(towards, 0.0047)))
}

/// A scene with a lamp that is at a place at t = 0.
pub fn under_lamp(scene: Scene, at: DVec3) -> Stage {
    Stage::plain(scene, None).with_lamp(Some(&lamp_at(at)))
}

/// A lamp without size that is at a place, world space, at t = 0.
pub fn lamp_at(place: DVec3) -> LampPath {
    let key = |t, x| LampKey { t, position_m: place + DVec3::X * x };
    LampPath::new(vec![key(0.0, 0.0), key(1.0, 1.0)], 0.0, 10.0).expect("the lamp moves")
}

/// Every way of drawing volumes: each mode with all optimizations, and three modes without any.
pub fn all_ways() -> Vec<VolumeSettings> {
    let way = |mode, optimizations| VolumeSettings { mode, optimizations, ..VolumeSettings::default() };
    let saved = Mode::ALL.map(|mode| way(mode, VolumeOptimizations::default()));
    let unsaved = [Mode::Planned, Mode::Triangles, Mode::Gpu].map(|mode| way(mode, VolumeOptimizations::NONE));
    saved.into_iter().chain(unsaved).collect()
}

/// A mask of the sun or of the lamp.
pub fn mask(technique: &mut dyn Technique, shot: &Shot, moment: &Moment, light: LightKind) -> Raster<f32> {
    let mask = match light {
        LightKind::Sun => technique.visibility(shot, moment),
        LightKind::Lamp => technique.lamp_visibility(shot, moment),
    };
    mask.unwrap_or_else(|error| panic!("{}: {error}", technique.name()))
}

/// How far one way of drawing volumes agrees with truth in a shot.
pub fn agreement(volumes: &mut Volumes, shot: &Shot, moment: &Moment, light: LightKind) -> MaskAgreement {
    let truth = mask(&mut Truth::Hard, shot, moment, light);
    let found = mask(volumes, shot, moment, light);
    let depths_m = volumes.renderer().depths_m(&shot.view, light == LightKind::Lamp).unwrap_or_default();
    MaskAgreement::new(shot, moment, light, &found, &truth, &depths_m)
}

/// Asserts that every way of drawing a moment's volumes gives the same mask, bit for bit, and that it is right: no
/// unexplained error outside of truth's edges, few explained ones, and few errors in the band.
pub fn assert_right(
    gpu: &Gpu,
    name: &str,
    stage: &Stage,
    views: &[View],
    moment: &Moment,
    light: LightKind,
) -> MaskAgreement {
    let all = assert_ways_agree(gpu, name, stage, views, moment, light);
    let explained = all.at_fine_edges + all.of_other_surfaces;
    assert!(all.unexplained.is_empty(), "{name}: wrong at {:?}", all.unexplained);
    assert!(explained <= all.pixels / 3000, "{name}: {}", all.sentence());
    // Stacks of sheets have most: one and a half in a hundred.
    assert!(all.wrong_in_band <= 4 + all.in_band / 40, "{name}: {}", all.sentence());
    all
}

/// Asserts that every way of drawing a moment's volumes gives the same mask, bit for bit. Gives how far it agrees with
/// truth.
pub fn assert_ways_agree(
    gpu: &Gpu,
    name: &str,
    stage: &Stage,
    views: &[View],
    moment: &Moment,
    light: LightKind,
) -> MaskAgreement {
    let (all, differ) = compare_ways(gpu, name, stage, views, moment, light);
    assert!(differ.is_empty(), "{name} differs from what is planned: {differ:?}");
    all
}

/// How far the planned way of drawing a moment's volumes agrees with truth, and which other ways differ from it, in how
/// many pixels.
pub fn compare_ways(
    gpu: &Gpu,
    name: &str,
    stage: &Stage,
    views: &[View],
    moment: &Moment,
    light: LightKind,
) -> (MaskAgreement, Vec<(VolumeSettings, usize)>) {
    let mut ways: Vec<Volumes> = all_ways()
        .into_iter()
        .map(|way| Volumes::new(gpu, stage, way).unwrap_or_else(|e| panic!("{name}: {e}")))
        .collect();
    let (mut all, mut differ) = (MaskAgreement::default(), Vec::new());
    for view in views {
        let shot = Shot::new(stage, *view);
        let expected = mask(&mut ways[0], &shot, moment, light);
        for (way, settings) in ways.iter_mut().zip(all_ways()).skip(1) {
            let found = mask(way, &shot, moment, light);
            let count = found.pixels.iter().zip(&expected.pixels).filter(|(a, b)| a != b).count();
            differ.extend((count > 0).then_some((settings, count)));
        }
        let found = agreement(&mut ways[0], &shot, moment, light);
        all.add(&found);
    }
    println!("{name}: {}", all.sentence());
    (all, differ)
}

/// The scene without alpha masks, as shadow volumes draw it.
pub fn with_solid_leaves(mut scene: Scene) -> Scene {
    for material in &mut scene.materials {
        if matches!(material.alpha, Alpha::Mask { .. }) {
            material.alpha = Alpha::Opaque;
        }
    }
    scene
}

/// Four cameras around a stage: its default one, turned about its middle by quarters.
pub fn cameras_around(stage: &Stage) -> [Camera; 4] {
    let camera = Camera::default_of(stage, 1.0);
    [0.0f64, 90.0, 180.0, 270.0].map(|deg| {
        let turn = DMat3::from_rotation_y(deg.to_radians());
        Camera {
            eye_m: turn * camera.eye_m,
            forward: turn * camera.forward,
            right: turn * camera.right,
            up: turn * camera.up,
            ..camera
        }
    })
}

/// A camera whose eye is in shadow, near a surface, and looks at another one: inside a shadow volume. `pick` chooses
/// which. None where nothing is in shadow.
pub fn camera_in_shadow(stage: &Stage, towards_light: DVec3, pick: usize) -> Option<Camera> {
    let count = stage.geometry.triangles.len();
    let direction = Direction::new(towards_light);
    // Steps by a large prime visit triangles in no order that a scene has.
    let triangle = |i: usize| (pick * 7_919 + i * 104_729) % count;
    let eyes = (0..count.min(20_000)).filter_map(|i| {
        let triangle = triangle(i);
        let normal = stage.geometry.normal(triangle);
        let above_m = 0.02 * stage.scene.half_extent_m.max_element();
        let eye_m = stage.geometry.point(triangle, [0.3, 0.3]) + normal * above_m;
        let is_shaded = normal != DVec3::ZERO && stage.tracer().is_occluded(eye_m, &direction);
        is_shaded.then_some(eye_m)
    });
    let eye_m = eyes.into_iter().next()?;
    (0..count).find_map(|i| {
        let target_m = stage.geometry.point(triangle(i + 1), [0.3, 0.3]);
        let hit = stage.primary_hit(eye_m, target_m - eye_m)?;
        let is_seen = hit.distance_m > 0.05 * stage.scene.half_extent_m.max_element();
        is_seen.then(|| Camera::look_at(eye_m, target_m, 1.2)).flatten()
    })
}
