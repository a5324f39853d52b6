//! Blended surfaces against *over* in closed form, and pictures of visibility, which they leave alone.

use super::{SUN, middle, square, squares, towards_origin};
use glam::{DMat4, DVec3, Vec3};
use sunbake::scene::looks::Look;
use sunbake::scene::{Material, Mesh};
use sunbake_runtime::gpu::VolumeSettings;
use sunbake_runtime::shadow_maps::{MapSettings, Variant};
use sunbake_runtime::technique::{BakedCpu, BakedGpu, ShadowMaps, Technique, Truth, Volumes};
use sunbake_runtime::testing::looks::{named, with_looks};
use sunbake_runtime::testing::masks::gpu;
use sunbake_runtime::{Filter, Shot, Stage};

const BEHIND: Vec3 = Vec3::new(0.1, 0.2, 0.7);
const FIRST: Vec3 = Vec3::new(0.9, 0.1, 0.2);
const SECOND: Vec3 = Vec3::new(0.1, 0.8, 0.3);
const EYE: DVec3 = DVec3::new(0.3, 4.0, 0.4);

/// A colour that no light changes.
fn unlit(name: &str, color: Vec3, alpha: f32) -> Material {
    Material { base_color: color.extend(alpha), is_unlit: true, ..named(name) }
}

fn at_height(mesh: Mesh, material: Material, y: f64) -> (Mesh, Material, DMat4) {
    (mesh, material, DMat4::from_translation(DVec3::Y * y))
}

/// Two panes over a wall. The lower pane is listed last, so that the order of the file is not the order of drawing.
fn panes(alphas: [f32; 2]) -> Stage {
    let stage = squares(&[
        at_height(square(), unlit("pane", FIRST, alphas[0]), 1.0),
        at_height(square(), unlit("wall", BEHIND, 1.0), 0.0),
        at_height(square(), unlit("pane", SECOND, alphas[1]), 0.5),
    ]);
    with_looks(stage, Vec::new(), |name| Look { says_blend: name == "pane", ..Look::PLAIN })
}

fn over(behind: Vec3, color: Vec3, alpha: f32) -> Vec3 {
    behind * (1.0 - alpha) + color * alpha
}

/// A6: each pane lies over what is behind it, whatever the order of the file.
#[test]
fn panes_lie_over_one_another_from_the_farthest_to_the_nearest() {
    let gpu = gpu();
    for alphas in [[0.25, 0.75], [0.6, 0.1], [0.2, 0.3], [0.8, 0.9]] {
        let stage = panes(alphas);
        let expected = over(over(BEHIND, SECOND, alphas[1]), FIRST, alphas[0]);
        let found = middle(&gpu, &stage, EYE, &stage.moment(0.5));
        assert!((found - expected).abs().max_element() < 1e-5, "{alphas:?}: {found}, not {expected}");
        let from_below = middle(&gpu, &stage, EYE * DVec3::new(1.0, -1.0, 1.0), &stage.moment(0.5));
        let sky = Shot::new(&stage, towards_origin(&stage, EYE * DVec3::new(1.0, -1.0, 1.0)));
        let sky = stage.moment(0.5).sky_color(sky.ray(40).normalize());
        assert!((from_below - sky).abs().max_element() < 1e-5, "one side is drawn of each: {from_below}");
    }
}

#[test]
fn every_technique_blends_alike() {
    let gpu = gpu();
    let stage = panes([0.25, 0.75]);
    let shot = Shot::new(&stage, towards_origin(&stage, EYE));
    let moment = stage.moment(0.5);
    let maps = MapSettings { size_texels: 64, ..MapSettings::new(Variant::Pcf16) };
    let planar = MapSettings { size_texels: 64, ..MapSettings::new(Variant::Planar) };
    let mut all: Vec<Box<dyn Technique + '_>> = vec![
        Box::new(BakedGpu::new(&gpu, &stage, Filter::Bilinear).unwrap()),
        Box::new(Volumes::new(&gpu, &stage, VolumeSettings::default()).unwrap()),
        Box::new(ShadowMaps::new(&gpu, &stage, maps).unwrap()),
        Box::new(ShadowMaps::new(&gpu, &stage, planar).unwrap()),
        Box::new(Truth::Hard),
    ];
    let expected = over(over(BEHIND, SECOND, 0.75), FIRST, 0.25);
    for technique in &mut all {
        let found = technique.color(&shot, &moment).unwrap().pixels[40];
        assert!((found - expected).abs().max_element() < 1e-5, "{}: {found}, not {expected}", technique.name());
    }
}

/// `KHR_materials_transmission` is drawn as a blend of one less the factor.
#[test]
fn what_transmits_light_is_seen_through() {
    let gpu = gpu();
    let stage = squares(&[
        at_height(square(), unlit("glass", FIRST, 1.0), 1.0),
        at_height(square(), unlit("wall", BEHIND, 1.0), 0.0),
    ]);
    let glass = Look { transmission: 0.9, ..Look::PLAIN };
    let stage = with_looks(stage, Vec::new(), |name| if name == "glass" { glass } else { Look::PLAIN });
    let found = middle(&gpu, &stage, EYE, &stage.moment(0.5));
    assert!((found - over(BEHIND, FIRST, 0.1)).abs().max_element() < 1e-5, "{found}");
}

/// A6: a faint pane has no texels, and nothing shades it; a half opaque one has texels, and is shaded.
#[test]
fn panes_are_lit_as_the_others_are() {
    let gpu = gpu();
    let of = |alpha: f32| Material { is_unlit: false, ..unlit("pane", FIRST, alpha) };
    let roof = Mesh { positions: square().positions.iter().map(|p| *p * 3.0).collect(), ..square() };
    let lit = |alpha: f32, is_roofed: bool| {
        let mut all = vec![at_height(square(), of(alpha), 0.0)];
        // Between the pane and the sun, and above the eye.
        let towards_sun = DMat4::from_translation(SUN * 8.0);
        all.extend(is_roofed.then(|| (roof.clone(), named("roof"), towards_sun)));
        let stage = with_looks(squares(&all), Vec::new(), |name| Look { says_blend: name == "pane", ..Look::PLAIN });
        let moment = stage.moment(0.5).without_sky();
        let shot = Shot::new(&stage, towards_origin(&stage, EYE));
        let sky = moment.sky_color(shot.ray(40).normalize());
        let share = FIRST * moment.daylight.sun_light * moment.sun_direction.y;
        (middle(&gpu, &stage, EYE, &moment), over(sky, share, alpha), sky * (1.0 - alpha))
    };
    for (alpha, is_roofed) in [(0.3, false), (0.3, true), (0.7, false)] {
        let (found, open, _) = lit(alpha, is_roofed);
        assert!((found - open).abs().max_element() < 1e-3, "{alpha} {is_roofed}: {found}, not {open}");
    }
    let (found, _, shaded) = lit(0.7, true);
    assert!((found - shaded).abs().max_element() < 1e-3, "{found}, not {shaded}");
}

/// A6: visibility is that of what casts, whatever a surface looks like: not a bit of it depends on looks.
#[test]
fn looks_change_no_picture_of_visibility() {
    let gpu = gpu();
    let stage = panes([0.25, 0.75]);
    let plain = panes([0.25, 0.75]).without_looks();
    let seen = |stage: &Stage| {
        let shot = Shot::new(stage, towards_origin(stage, EYE));
        let moment = stage.moment(0.5);
        let maps = MapSettings { size_texels: 64, ..MapSettings::new(Variant::Pcf16) };
        let mut all: Vec<Box<dyn Technique + '_>> = vec![
            Box::new(BakedGpu::new(&gpu, stage, Filter::Bilinear).unwrap()),
            Box::new(BakedCpu::new(stage, Filter::Bilinear)),
            Box::new(Volumes::new(&gpu, stage, VolumeSettings::default()).unwrap()),
            Box::new(ShadowMaps::new(&gpu, stage, maps).unwrap()),
            Box::new(Truth::Hard),
        ];
        all.iter_mut().map(|technique| technique.visibility(&shot, &moment).unwrap().pixels).collect::<Vec<_>>()
    };
    assert_eq!(seen(&stage), seen(&plain));
    // And without looks every pane is solid.
    let found = middle(&gpu, &plain, EYE, &plain.moment(0.5));
    assert!((found - FIRST).abs().max_element() < 1e-6, "{found}");
}
