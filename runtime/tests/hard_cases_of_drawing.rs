//! A1 to A4: hard cases that every drawing technique must stand. They need a GPU adapter, and fail without one.

use glam::{DMat4, DVec3, Mat3, Vec2, Vec3};
use sunbake::maps::Bits;
use sunbake::scene::{Mesh, Scene, TextureRef, Wrap};
use sunbake::sun::SunPath;
use sunbake::testing::{SceneBuilder, alpha_masked, block, floor, opaque};
use sunbake_runtime::compare::{Agreement, visibility_difference};
use sunbake_runtime::gpu::{Gpu, VolumeSettings};
use sunbake_runtime::shadow_maps::{MapSettings, Variant};
use sunbake_runtime::technique::{BakedCpu, BakedGpu, ShadowMaps, Technique, Truth, Volumes};
use sunbake_runtime::testing::masks::gpu;
use sunbake_runtime::testing::{bake, equinox, standing_sun, view};
use sunbake_runtime::{Filter, Moment, Raster, Shot, Stage};

const SIZE: [u32; 2] = [96, 96];
const RADIUS_RAD: f64 = 0.0047;

fn techniques<'a>(gpu: &'a Gpu, stage: &'a Stage) -> Vec<Box<dyn Technique + 'a>> {
    let map = |variant| Box::new(ShadowMaps::new(gpu, stage, MapSettings::new(variant)).unwrap()) as Box<dyn Technique>;
    let mut all: Vec<Box<dyn Technique>> = vec![
        Box::new(BakedGpu::new(gpu, stage, Filter::Bilinear).unwrap()),
        Box::new(BakedGpu::new(gpu, stage, Filter::Nearest).unwrap()),
        Box::new(BakedCpu::new(stage, Filter::Bilinear)),
        Box::new(Volumes::new(gpu, stage, VolumeSettings::default()).unwrap()),
        Box::new(Volumes::new(gpu, stage, VolumeSettings { sun_samples: 4, ..VolumeSettings::default() }).unwrap()),
        Box::new(Truth::Hard),
        Box::new(Truth::Soft { rays: 16 }),
    ];
    all.extend(Variant::ALL.map(map));
    all
}

/// Each technique's visibility at a moment; its colour must be finite.
fn seen_by_all(gpu: &Gpu, shot: &Shot, t: f64) -> Vec<(String, Raster<f32>)> {
    let moment = Moment::new(shot.stage.path.as_ref(), t);
    let draw = |mut technique: Box<dyn Technique + '_>| {
        let color = technique.color(shot, &moment).unwrap();
        assert!(color.pixels.iter().all(|c| c.is_finite()), "{} draws what is not a number", technique.name());
        let seen = technique.visibility(shot, &moment).unwrap();
        assert!(seen.pixels.iter().all(|v| (0.0..=1.0).contains(v)), "{}", technique.name());
        (technique.name(), seen)
    };
    techniques(gpu, shot.stage).into_iter().map(draw).collect()
}

fn noon() -> Option<SunPath> {
    Some(standing_sun(DVec3::Y, RADIUS_RAD))
}

fn ground() -> SceneBuilder {
    SceneBuilder::new().soup(&floor(Vec2::splat(-4.0), Vec2::splat(4.0), 0.0))
}

fn from_above(stage: &Stage) -> Shot<'_> {
    Shot::new(stage, view(stage, DVec3::new(0.3, 6.0, 0.2), DVec3::new(0.3, 0.0, 0.2), SIZE))
}

/// A1.
#[test]
fn an_empty_scene_is_all_sky() {
    let gpu = gpu();
    let stage = bake(SceneBuilder::new().build(), noon(), 8, Bits::Sixteen);
    for (name, seen) in seen_by_all(&gpu, &from_above(&stage), 0.5) {
        assert!(seen.pixels.iter().all(|&v| v == 1.0), "{name}");
    }
}

/// A1.
#[test]
fn a_scene_without_casters_is_all_lit_and_one_without_a_sun_is_not() {
    let gpu = gpu();
    for (path, expected) in [(noon(), 1.0), (None, 0.0)] {
        let stage = bake(ground().build(), path, 24, Bits::Sixteen);
        let shot = from_above(&stage);
        assert!(shot.hits().iter().all(Option::is_some));
        for (name, seen) in seen_by_all(&gpu, &shot, 0.5) {
            assert!(seen.pixels.iter().all(|&v| (v - expected).abs() < 1e-6), "{name}");
        }
    }
}

/// A1.
#[test]
fn a_caster_outside_the_picture_shades_it() {
    let gpu = gpu();
    let roof = block(Vec3::new(-4.0, 9.0, -4.0), Vec3::new(4.0, 9.5, 4.0));
    let stage = bake(ground().soup(&roof).build(), noon(), 24, Bits::Sixteen);
    for (name, seen) in seen_by_all(&gpu, &from_above(&stage), 0.5) {
        assert!(seen.pixels.iter().all(|&v| v == 0.0), "{name}");
    }
}

/// A1.
#[test]
fn casters_alone_leave_the_sky_alone() {
    let gpu = gpu();
    let stage = bake(SceneBuilder::new().block(Vec3::splat(20.0), Vec3::splat(21.0)).build(), noon(), 8, Bits::Eight);
    for (name, seen) in seen_by_all(&gpu, &from_above(&stage), 0.5) {
        assert!(seen.pixels.iter().all(|&v| v == 1.0), "{name}");
    }
}

/// A2.
#[test]
fn suns_at_the_horizon_overhead_and_along_axes_give_numbers_and_light_nothing_from_below() {
    let gpu = gpu();
    let scene = || ground().block(Vec3::new(-0.5, 0.0, -0.5), Vec3::new(0.5, 1.0, 0.5)).build();
    let grazing = |deg: f64| DVec3::new(deg.to_radians().cos(), deg.to_radians().sin(), 0.0);
    let axes = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
    for direction in axes.into_iter().chain([grazing(0.01), grazing(-0.01), grazing(-1.0)]) {
        let stage = bake(scene(), Some(standing_sun(direction, RADIUS_RAD)), 10, Bits::Sixteen);
        let shot = Shot::new(&stage, view(&stage, DVec3::new(3.0, 3.0, 4.0), DVec3::ZERO, SIZE));
        for (name, seen) in seen_by_all(&gpu, &shot, 0.5) {
            let surfaces = shot.hits().iter().zip(&seen.pixels).filter(|(hit, _)| hit.is_some());
            let most = surfaces.map(|(_, &v)| v).fold(0.0, f32::max);
            assert!(direction.y > -RADIUS_RAD || most == 0.0, "{name} is lit from below by {direction}: {most}");
        }
    }
}

/// A3.
#[test]
fn a_scene_a_million_metres_away_looks_the_same() {
    let gpu = gpu();
    let away = DVec3::new(1e6, 2e5, -1e6);
    let scene = |offset: DVec3| -> Scene {
        let soup = |triangles: Vec<[Vec3; 3]>| {
            let positions: Vec<Vec3> = triangles.iter().flatten().copied().collect();
            let indices = (0..positions.len() as u32).collect();
            Mesh { positions, indices, ..Mesh::default() }
        };
        SceneBuilder::new()
            .mesh_of(
                soup(floor(Vec2::splat(-4.0), Vec2::splat(4.0), 0.0)),
                opaque(),
                &[DMat4::from_translation(offset)],
            )
            .mesh_of(soup(block(Vec3::ZERO, Vec3::ONE)), opaque(), &[DMat4::from_translation(offset)])
            .build()
    };
    let shots = |offset: DVec3| bake(scene(offset), Some(equinox(40.0)), 24, Bits::Sixteen);
    let (here, there) = (shots(DVec3::ZERO), shots(away));
    let eye = DVec3::new(4.0, 3.0, 5.0);
    let shot_here = Shot::new(&here, view(&here, eye, DVec3::ZERO, SIZE));
    let shot_there = Shot::new(&there, view(&there, away + eye, away, SIZE));
    let pairs = seen_by_all(&gpu, &shot_here, 0.3).into_iter().zip(seen_by_all(&gpu, &shot_there, 0.3));
    for ((name, a), (_, b)) in pairs {
        let found = Agreement::new(&visibility_difference(&a, &b), &[false; 96 * 96], 4.0 / 255.0);
        assert!(found.share_within() > 0.995, "{name}: {found:?}");
    }
}

/// A card one metre above the ground whose texture is opaque in two quarters of four and below the cutoff in the
/// others.
fn leaf() -> Scene {
    let texel = |i: u32| [40, 160, 40, if i == 0 || i == 3 { 255 } else { 100 }];
    let (builder, image) = SceneBuilder::new().image(2, 2, (0..4).map(texel).collect());
    let texture = TextureRef { image, texcoord: 0, image_from_texcoord: Mat3::IDENTITY, wrap: [Wrap::Clamp; 2] };
    let triangles = floor(Vec2::splat(-1.0), Vec2::splat(1.0), 1.0);
    let positions: Vec<Vec3> = triangles.iter().flatten().copied().collect();
    let uvs = positions.iter().map(|p| Vec2::new(p.x + 1.0, p.z + 1.0) / 2.0).collect();
    let card = Mesh { indices: (0..6).collect(), positions, texcoords: vec![Some(uvs)], ..Mesh::default() };
    builder
        .soup(&floor(Vec2::splat(-2.0), Vec2::splat(2.0), 0.0))
        .mesh_of(card, alpha_masked(texture), &[DMat4::IDENTITY])
        .build()
}

/// A4.
#[test]
fn a_leaf_casts_and_shows_its_cut_out_and_not_its_card() {
    let gpu = gpu();
    let stage = bake(leaf(), noon(), 96, Bits::Sixteen);
    // From below the card, looking down: the ground, with the shadow of the two opaque quarters.
    let shot = Shot::new(&stage, view(&stage, DVec3::new(0.0, 0.95, 0.0), DVec3::ZERO, SIZE));
    for (name, seen) in seen_by_all(&gpu, &shot, 0.5) {
        for (pixel, hit) in shot.hits().iter().enumerate() {
            let hit = hit.expect("the ground fills the picture");
            let place = stage.geometry.point(hit.triangle as usize, hit.barycentric);
            let is_near_an_edge = place.x.abs().min(place.z.abs()) < 0.06 || place.x.abs().max(place.z.abs()) > 0.9;
            // Volumes do not see holes, and say so: their leaf casts its card.
            let is_dark = name == "volumes" || (place.x < 0.0) == (place.z < 0.0);
            let expected = if is_dark { 0.0 } else { 1.0 };
            assert!(is_near_an_edge || (seen.pixels[pixel] - expected).abs() < 0.01, "{name} at {place}");
        }
    }
    let mut volumes = Volumes::new(&gpu, &stage, VolumeSettings::default()).unwrap();
    volumes.visibility(&shot, &stage.moment(0.5)).unwrap();
    assert!(volumes.notes().iter().any(|line| line.contains("the whole triangles cast")));
    // From above: the card hides the ground only where it is solid.
    let shot = Shot::new(&stage, view(&stage, DVec3::new(0.0, 3.0, 0.0), DVec3::new(0.0, 1.0, 0.0), SIZE));
    let on_card = |hit: &sunbake::trace::Hit| stage.geometry.instance[hit.triangle as usize] == 1;
    let share = shot.hits().iter().flatten().filter(|hit| on_card(hit)).count() as f64 / 96.0 / 96.0;
    let side = 1.0 / (2.0 * 0.4f64.tan());
    assert!((share - (2.0 * side * side).min(0.5)).abs() < 0.5 && share > 0.1, "{share}");
}

#[test]
fn the_far_side_of_a_two_sided_surface_is_dark() {
    let gpu = gpu();
    let wall = floor(Vec2::splat(-1.0), Vec2::splat(1.0), 2.0);
    let material = sunbake::scene::Material { is_double_sided: true, ..opaque() };
    let stage = bake(SceneBuilder::new().soup_of(&wall, material).build(), noon(), 16, Bits::Sixteen);
    for (eye_y, expected) in [(5.0, 1.0), (-1.0, 0.0)] {
        let shot = Shot::new(&stage, view(&stage, DVec3::new(0.0, eye_y, 0.0), DVec3::new(0.0, 2.0, 0.0), SIZE));
        let middle = 48 * 96 + 48;
        assert!(shot.hits()[middle].is_some());
        for (name, seen) in seen_by_all(&gpu, &shot, 0.5) {
            assert_eq!(seen.pixels[middle], expected, "{name} from {eye_y}");
        }
    }
}

#[test]
fn the_back_of_a_one_sided_surface_is_not_drawn_and_still_casts() {
    let gpu = gpu();
    let ceiling: Vec<_> =
        floor(Vec2::splat(-4.0), Vec2::splat(4.0), 1.0).iter().map(|[a, b, c]| [*a, *c, *b]).collect();
    let stage = bake(ground().soup(&ceiling).build(), noon(), 24, Bits::Sixteen);
    // Seen from above, the ceiling turns its back: the ground shows through it, in its shadow.
    let shot = from_above(&stage);
    assert!(shot.hits().iter().flatten().all(|hit| stage.geometry.instance[hit.triangle as usize] == 0));
    for (name, seen) in seen_by_all(&gpu, &shot, 0.5) {
        assert!(seen.pixels.iter().all(|&v| v == 0.0), "{name}");
    }
}
