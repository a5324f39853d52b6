//! B19 on the GPU: every technique ends the light on a smooth ball of few faces where it ends on a sphere, as truth
//! does on a ball of many faces. These tests need a GPU adapter.

use glam::{DMat4, DVec3, Vec2, Vec3};
use sunbake::maps::Bits;
use sunbake::scene::{Geometry, Material, Mesh, Scene};
use sunbake::testing::{SceneBuilder, ball, floor, opaque};
use sunbake::trace::Hit;
use sunbake_runtime::gpu::{Gpu, VolumeSettings};
use sunbake_runtime::shadow_maps::{MapSettings, Variant};
use sunbake_runtime::technique::{BakedCpu, BakedGpu, LightKind, ShadowMaps, Technique, Truth, Volumes};
use sunbake_runtime::testing::masks::{all_ways, compare_ways, gpu, under_lamp, under_sun};
use sunbake_runtime::testing::{bake, standing_sun, twins, view};
use sunbake_runtime::{Filter, Shot, Stage};

const EDGE: u32 = 96;
/// Suns at several heights, and how they stand to the view: beside it, behind the ball, and before it.
const SUNS: [[f64; 3]; 4] = [[1.0, 0.12, 0.3], [0.9, 0.7, -0.4], [-0.5, 0.3, -0.8], [0.2, 1.0, 0.5]];

fn scene(columns: u32, rows: u32) -> Scene {
    let mesh = ball(columns, rows, Vec3::Y * 1.3, 1.0);
    SceneBuilder::new()
        .mesh_of(mesh, opaque(), &[DMat4::IDENTITY])
        .soup(&floor(Vec2::splat(-4.0), Vec2::splat(4.0), 0.0))
        .build()
}

/// A ball close up, seen from its side.
fn shot(stage: &Stage) -> Shot<'_> {
    Shot::new(stage, view(stage, DVec3::new(0.5, 2.2, 4.2), DVec3::new(0.0, 1.3, 0.0), [EDGE; 2]))
}

/// Visibility from each pixel of the ball at which all four neighbours show it as well; none elsewhere.
fn on_ball(shot: &Shot, pixels: &[f32]) -> Vec<Option<f32>> {
    let balls = shot.stage.geometry.first_triangle[1];
    let shows = |i: usize| shot.hits()[i].is_some_and(|hit| hit.triangle < balls);
    let edge = EDGE as usize;
    let inner = |i: usize| {
        let (x, y) = (i % edge, i / edge);
        let is_within = x > 1 && y > 1 && x + 2 < edge && y + 2 < edge;
        is_within && [i, i - 2, i + 2, i - 2 * edge, i + 2 * edge].into_iter().all(shows)
    };
    (0..pixels.len()).map(|i| inner(i).then(|| pixels[i])).collect()
}

/// Whether a true sphere sees the sun at each pixel, in the direction from its centre of what the pixel shows.
fn on_sphere(shot: &Shot, towards: DVec3) -> Vec<f32> {
    let centre_m = DVec3::Y * 1.3 - shot.stage.scene.centre_m;
    let seen = |pixel: &Option<Hit>| {
        let from_centre = |hit: &Hit| shot.stage.geometry.point(hit.triangle as usize, hit.barycentric) - centre_m;
        pixel.as_ref().is_some_and(|hit| from_centre(hit).dot(towards) > 0.0)
    };
    shot.hits().iter().map(|pixel| f32::from(u8::from(seen(pixel)))).collect()
}

/// Root of the mean square of the difference, over pixels of both.
fn rms(some: &[Option<f32>], others: &[Option<f32>]) -> f64 {
    let both = || some.iter().zip(others).filter_map(|(a, b)| Some(f64::from((*a)? - (*b)?).powi(2)));
    assert!(both().count() > 1000);
    (both().sum::<f64>() / both().count() as f64).sqrt()
}

fn faceted(mut stage: Stage) -> Stage {
    stage.geometry = Geometry::faceted(&stage.scene);
    stage
}

/// The error of a technique against the sphere, over all suns, on a stage made for each.
fn error(make: impl Fn(DVec3) -> Stage, draw: impl Fn(&Shot) -> Vec<f32>) -> f64 {
    let of_sun = |sun: &[f64; 3]| {
        let towards = DVec3::from_array(*sun);
        let stage = make(towards);
        let shot = shot(&stage);
        let off = rms(&on_ball(&shot, &draw(&shot)), &on_ball(&shot, &on_sphere(&shot, towards)));
        println!("    {sun:?}: {off:.3}");
        off
    };
    let squares: f64 = SUNS.iter().map(|sun| of_sun(sun).powi(2)).sum();
    (squares / SUNS.len() as f64).sqrt()
}

fn live(towards: DVec3) -> Stage {
    under_sun(scene(12, 8), towards)
}

fn seen_by(technique: &mut dyn Technique, shot: &Shot) -> Vec<f32> {
    technique.visibility(shot, &shot.stage.moment(0.5)).unwrap().pixels
}

fn truth_of(shot: &Shot) -> Vec<f32> {
    seen_by(&mut Truth::Hard, shot)
}

fn map_of(gpu: &Gpu, shot: &Shot, variant: Variant) -> Vec<f32> {
    let settings = MapSettings { size_texels: 512, ..MapSettings::new(variant) };
    seen_by(&mut ShadowMaps::new(gpu, shot.stage, settings).unwrap(), shot)
}

fn volumes_of(gpu: &Gpu, shot: &Shot) -> Vec<f32> {
    seen_by(&mut Volumes::new(gpu, shot.stage, VolumeSettings::default()).unwrap(), shot)
}

#[test]
fn b19_truth_ends_light_as_on_the_ball_of_many_faces() {
    let many = error(|sun| under_sun(scene(96, 64), sun), truth_of);
    assert!(many < 0.03, "the reference is off: {many}");
    let (before, after) = (error(|sun| faceted(live(sun)), truth_of), error(live, truth_of));
    println!("truth: {before:.3} faceted, {after:.3} smooth");
    assert!(after < 0.05 * before, "{before} {after}");
}

#[test]
fn b19_shadow_maps_end_light_as_on_the_ball_of_many_faces() {
    let gpu = gpu();
    for variant in [Variant::Plain, Variant::Pcf16, Variant::Pcf4, Variant::Cascades] {
        let draw = |shot: &Shot| map_of(&gpu, shot, variant);
        let (before, after) = (error(|sun| faceted(live(sun)), draw), error(live, draw));
        println!("{variant}: {before:.3} faceted, {after:.3} smooth");
        // The plain variant has one bias for all, and acne where the sun grazes faces.
        let most = if variant == Variant::Plain { 0.6 } else { 0.2 };
        assert!(after < most * before, "{variant}: {before} {after}");
    }
}

#[test]
fn b19_shadow_volumes_end_light_as_on_the_ball_of_many_faces() {
    let gpu = gpu();
    let draw = |shot: &Shot| volumes_of(&gpu, shot);
    let (before, after) = (error(|sun| faceted(live(sun)), draw), error(live, draw));
    println!("volumes: {before:.3} faceted, {after:.3} smooth");
    assert!(after < 0.2 * before, "{before} {after}");
}

#[test]
fn b19_playback_ends_light_as_on_the_ball_of_many_faces() {
    let gpu = gpu();
    let baked = |mesh_is_smooth: bool, sun: DVec3| {
        let mut scene = scene(12, 8);
        separate_vertices(&mut scene.meshes[0]);
        if !mesh_is_smooth {
            scene.meshes[0].normals = None;
        }
        bake(scene, Some(standing_sun(sun, 0.0)), 12, Bits::Sixteen)
    };
    let draw = |shot: &Shot| seen_by(&mut BakedGpu::new(&gpu, shot.stage, Filter::Bilinear).unwrap(), shot);
    let (before, after) = (error(|sun| baked(false, sun), draw), error(|sun| baked(true, sun), draw));
    println!("baked: {before:.3} faceted, {after:.3} smooth");
    assert!(after < 0.3 * before, "{before} {after}");
    let stage = baked(true, DVec3::from_array(SUNS[1]));
    let shot = shot(&stage);
    let (mut on_gpu, mut on_cpu) =
        (BakedGpu::new(&gpu, &stage, Filter::Bilinear).unwrap(), BakedCpu::new(&stage, Filter::Bilinear));
    let agree = twins(&mut on_gpu, &mut on_cpu, &shot, 0.5).unwrap();
    assert!(agree.iter().all(|(_, agreement)| agreement.unexplained == 0), "{agree:?}");
}

/// Triangles that share no vertices, as the set made by code needs them.
fn separate_vertices(mesh: &mut Mesh) {
    let of = |all: &[Vec3]| mesh.indices.iter().map(|&i| all[i as usize]).collect::<Vec<_>>();
    let (positions, normals) = (of(&mesh.positions), mesh.normals.as_ref().map(|normals| of(normals)));
    mesh.indices = (0..positions.len() as u32).collect();
    (mesh.positions, mesh.normals) = (positions, normals);
}

/// Every way of counting volumes shows the same mask, of the sun and of a lamp, and near truth.
#[test]
fn b19_every_way_of_drawing_volumes_gives_one_mask() {
    let gpu = gpu();
    let lamp = under_lamp(scene(12, 8), DVec3::new(2.0, 2.6, 0.7));
    let sun = under_sun(scene(12, 8), DVec3::from_array(SUNS[1]));
    for (name, stage, light) in [("sun", &sun, LightKind::Sun), ("lamp", &lamp, LightKind::Lamp)] {
        let views = [
            shot(stage).view,
            view(stage, DVec3::new(-3.0, 1.0, -2.0), DVec3::new(0.0, 1.0, 0.0), [EDGE; 2]),
            // In the ball's shadow.
            view(stage, DVec3::new(-1.0, 0.1, 0.3), DVec3::new(0.0, 1.3, 0.0), [EDGE; 2]),
        ];
        let moment = stage.moment(if light == LightKind::Sun { 0.5 } else { 0.0 });
        let (agreement, differ) = compare_ways(&gpu, name, stage, &views, &moment, light);
        assert!(differ.is_empty(), "{name}: {differ:?}");
        println!("{name}: {}", agreement.sentence());
        assert!(
            agreement.unexplained.is_empty() && agreement.on_turned_facets < 12,
            "{name}: {}",
            agreement.sentence()
        );
    }
    assert!(all_ways().len() > 4);
}

/// What the ground sees of the sun is the same whether the ball above it is smooth or not.
#[test]
fn b19_shadows_on_flat_ground_do_not_change() {
    let gpu = gpu();
    let towards = DVec3::from_array(SUNS[1]);
    let [smooth, flat] = [live(towards), faceted(live(towards))];
    for draw in
        [&truth_of as &dyn Fn(&Shot) -> Vec<f32>, &|shot: &Shot| map_of(&gpu, shot, Variant::Pcf16), &|shot: &Shot| {
            volumes_of(&gpu, shot)
        }]
    {
        let [a, b] = [&smooth, &flat].map(|stage| {
            let shot = shot(stage);
            let on_ground =
                |i: usize| shot.hits()[i].is_none_or(|hit| hit.triangle >= stage.geometry.first_triangle[1]);
            let seen = draw(&shot);
            (0..seen.len()).filter(|&i| on_ground(i)).map(|i| seen[i]).collect::<Vec<_>>()
        });
        assert!(a.contains(&0.0) && a.contains(&1.0));
        assert_eq!(a, b);
    }
}

/// A sheet that is bent and seen from both sides: its hollow side, turned away, is as dark as that of its faces. (A map
/// blurs the shadow of its rim.)
#[test]
fn b19_bent_sheets_are_dark_behind() {
    let gpu = gpu();
    let mut half = ball(12, 8, Vec3::ZERO, 1.0);
    let is_right = |triangle: &&[u32]| triangle.iter().all(|&i| half.positions[i as usize].x > -0.1);
    half.indices = half.indices.chunks_exact(3).filter(is_right).flatten().copied().collect();
    let both = Material { is_double_sided: true, ..opaque() };
    let scene = SceneBuilder::new().mesh_of(half, both, &[DMat4::IDENTITY]).build();
    let smooth = under_sun(scene, DVec3::new(1.0, 0.4, 0.0));
    assert!(smooth.geometry.smooth_count() > 0);
    let flat = faceted(under_sun(smooth.scene.clone(), DVec3::new(1.0, 0.4, 0.0)));
    // From the hollow side, away from the sun.
    let lit = |stage: &Stage, draw: &dyn Fn(&Shot) -> Vec<f32>| {
        let eye = DVec3::new(-4.0, 0.2, 0.3);
        let shot = Shot::new(stage, view(stage, eye, DVec3::ZERO, [EDGE; 2]));
        let seen = draw(&shot);
        (0..seen.len()).filter(|&i| shot.hits()[i].is_some() && seen[i] > 0.0).count()
    };
    for (name, draw) in [
        ("truth", &truth_of as &dyn Fn(&Shot) -> Vec<f32>),
        ("map", &|shot: &Shot| map_of(&gpu, shot, Variant::Pcf16)),
        ("volumes", &|shot: &Shot| volumes_of(&gpu, shot)),
    ] {
        let [smooth, flat] = [lit(&smooth, draw), lit(&flat, draw)];
        assert!(smooth <= flat + 4 && (smooth <= 4 || name == "map"), "{name}: {smooth} pixels, {flat} of faces");
    }
}
