//! B19: light ends on smooth-shaded shapes of few faces where it ends on the shapes themselves, and nothing else
//! changes: no light comes through walls or round sharp edges, and flat faces keep every bit.

use glam::{DMat4, DVec3, Vec2, Vec3};
use std::f64::consts::PI;
use sunbake::lamp::{LampKey, LampPath};
use sunbake::progress::Silent;
use sunbake::scene::{Geometry, Material, Mesh, Scene};
use sunbake::settings::BakeSettings;
use sunbake::sun::SunPath;
use sunbake::testing::{SceneBuilder, ball, block, floor, icosphere, opaque, turned_over};
use sunbake::visibility::{Engine, ExactEngine, Intervals, LampEngine, LampRays, lit_at};
use sunbake_tests::{Traced, over_the_top, quick};

/// Points of a triangle at which light is looked for: weights of its second and third corner.
const INSIDE: [[f64; 2]; 6] = [[0.33, 0.33], [0.05, 0.05], [0.9, 0.05], [0.05, 0.9], [0.48, 0.04], [0.3, 0.6]];

fn one(mesh: Mesh, material: Material) -> SceneBuilder {
    SceneBuilder::new().mesh_of(mesh, material, &[DMat4::IDENTITY])
}

/// When each point of some triangles sees the sun.
fn lit_on(here: &Traced, path: &SunPath, triangles: impl Iterator<Item = usize>) -> Vec<([usize; 2], Intervals)> {
    let engine = ExactEngine::new(&here.tracer, std::slice::from_ref(path));
    let lit = |triangle: usize, i: usize| lit_at(&engine, &here.point(triangle, INSIDE[i])).swap_remove(0);
    triangles.flat_map(|triangle| (0..INSIDE.len()).map(move |i| ([triangle, i], lit(triangle, i)))).collect()
}

fn minutes(lit: &Intervals) -> f64 {
    lit.as_slice().iter().map(|[start, end]| end - start).sum()
}

/// Root of the mean square of how far, in degrees of the sun's way, the ends of light on a ball are from those on a
/// true sphere.
fn error_deg(here: &Traced, path: &SunPath, towards: impl Fn(f64) -> DVec3) -> f64 {
    let (mut sum, mut count) = (0.0, 0);
    for ([triangle, i], lit) in lit_on(here, path, 0..here.geometry.triangles.len()) {
        // The bake's centre is the ball's.
        let normal = here.geometry.point(triangle, INSIDE[i]).normalize();
        let steps = 720;
        for step in 0..steps {
            let t = (step as f64 + 0.5) / f64::from(steps);
            let is_lit = lit.as_slice().iter().any(|[start, end]| (*start..=*end).contains(&t));
            let sun = towards(t);
            if is_lit != (normal.dot(sun) > 0.0) {
                sum += normal.dot(sun).asin().to_degrees().powi(2);
                count += 1;
            }
        }
    }
    if count == 0 { 0.0 } else { (sum / f64::from(count)).sqrt() }
}

/// The reference is a sphere in closed form. The sun goes over the top in two directions, so that its light ends at
/// every latitude of the ball.
#[test]
fn b19_the_terminator_of_few_faces_is_that_of_the_sphere() {
    for (columns, rows) in [(12, 8), (8, 5), (24, 16)] {
        for from in [DVec3::X, DVec3::new(0.6, 0.0, 0.8)] {
            let path = over_the_top(from);
            let sun = |t: f64| from * (PI * t).cos() + DVec3::Y * (PI * t).sin();
            let scene = || one(ball(columns, rows, Vec3::ZERO, 1.0), opaque()).build();
            let smooth = error_deg(&Traced::new(scene()), &path, sun);
            let faceted = error_deg(&Traced::faceted(scene()), &path, sun);
            println!("{columns} x {rows}: off by {faceted:.2} degrees faceted, {smooth:.2} smooth");
            assert!(smooth < 0.25 * faceted, "{columns} x {rows}: {smooth} of {faceted} degrees");
        }
    }
}

/// A lamp's light ends on a ball where it ends on a sphere too, and both of its engines say so.
#[test]
fn b19_a_lamps_light_ends_as_on_the_sphere() {
    let here = Traced::new(one(ball(12, 8, Vec3::ZERO, 1.0), opaque()).build());
    let key = |t, x| LampKey { t, position_m: DVec3::new(x, 2.0, 0.7) };
    let path = LampPath::new(vec![key(0.0, -4.0), key(1.0, 4.0)], 0.0, 60.0).expect("a path");
    let (exact, rays) = (LampEngine::new(&here.tracer, &path), LampRays::new(&here.tracer, &path, 512));
    let mut lit_below = 0;
    for triangle in 0..here.geometry.triangles.len() {
        for weights in INSIDE {
            let point = here.point(triangle, weights);
            let [exact, rays] = [&exact as &dyn Engine, &rays].map(|engine| lit_at(engine, &point).swap_remove(0));
            let smooth = point.smooth.expect("a ball is smooth");
            let (normal, rise) = (smooth.normal, smooth.lift_m[0].length());
            for step in 0..512 {
                let t = (f64::from(step) + 0.5) / 512.0;
                let is_lit = |lit: &Intervals| lit.as_slice().iter().any(|[start, end]| (*start..=*end).contains(&t));
                let to_lamp = path.position_m(t) - point.position_m;
                assert_eq!(is_lit(&exact), is_lit(&rays), "{triangle} {weights:?} at {t}");
                // A lamp is near, so that what rises above a facet sees less of it.
                let height = normal.dot(to_lamp);
                let is_unsure = height > 0.0 && height < rise;
                assert!(is_unsure || is_lit(&exact) == (height > 0.0), "{triangle} {weights:?} at {t}");
                lit_below += u32::from(is_lit(&exact) && point.normal.dot(to_lamp) < 0.0);
            }
        }
    }
    assert!(lit_below > 1000, "{lit_below}");
}

/// A bowl of few faces, of which the inside is seen, has no more error than it had.
#[test]
fn b19_the_inside_of_a_bowl_is_no_worse() {
    let half = |columns, rows| {
        let mut mesh = turned_over(ball(columns, rows, Vec3::ZERO, 1.0));
        let is_low = |triangle: &&[u32]| triangle.iter().all(|&i| mesh.positions[i as usize].y < 0.01);
        mesh.indices = mesh.indices.chunks_exact(3).filter(is_low).flatten().copied().collect();
        one(mesh, Material { is_double_sided: false, ..opaque() }).build()
    };
    let path = over_the_top(DVec3::X);
    let [smooth, faceted] = [Traced::new(half(12, 8)), Traced::faceted(half(12, 8))];
    // In closed form: the sun at d reaches p in a bowl of radius 1 unless the chord from p towards d ends below the
    // rim.
    let centre = DVec3::Y * smooth.scene.centre_m.y;
    let is_seen = |p: DVec3, d: DVec3| (p - d * (2.0 * p.dot(d))).y >= 0.0;
    let error = |here: &Traced| {
        let (mut wrong, mut all) = (0, 0);
        for ([triangle, i], lit) in lit_on(here, &path, 0..here.geometry.triangles.len()) {
            let p = (here.geometry.point(triangle, INSIDE[i]) + centre).normalize();
            for step in 0..360 {
                let t = (f64::from(step) + 0.5) / 360.0;
                let sun = DVec3::X * (PI * t).cos() + DVec3::Y * (PI * t).sin();
                let is_lit = lit.as_slice().iter().any(|[start, end]| (*start..=*end).contains(&t));
                wrong += u32::from(is_lit != is_seen(p, sun));
                all += 1;
            }
        }
        f64::from(wrong) / f64::from(all)
    };
    let [smooth, faceted] = [error(&smooth), error(&faceted)];
    println!("wrong: {smooth} of the day smooth, {faceted} faceted");
    assert!(smooth <= faceted + 1e-3, "{smooth} {faceted}");
}

/// A box whose normals were averaged has edges all the same: every bit of its light is that of its faces.
#[test]
fn b19_averaged_normals_of_a_box_change_nothing() {
    let corners: Vec<Vec3> =
        (0..8).map(|i| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2 & 1) as f32)).collect();
    let at = |v: Vec3| corners.iter().position(|&corner| corner == v).expect("a corner") as u32;
    let indices = block(Vec3::ZERO, Vec3::ONE).iter().flatten().map(|&v| at(v)).collect();
    let normals = corners.iter().map(|v| (*v - 0.5).normalize()).collect();
    let mesh = Mesh { positions: corners, normals: Some(normals), indices, ..Mesh::default() };
    let here = Traced::new(one(mesh, opaque()).soup(&floor(Vec2::splat(-3.0), Vec2::splat(3.0), 0.0)).build());
    assert_eq!(here.geometry.smooth_count(), 0);
}

/// A ball in a closed room touches its walls: what rises above its facets stays inside, and everything is dark. The
/// walls are sheets, and the ball's own faces reach through some of them.
#[test]
fn b19_no_light_comes_into_a_room_through_what_rises_above_facets() {
    let room = block(Vec3::splat(-1.0), Vec3::ONE);
    for radius in [0.9, 0.995, 1.0, 1.02] {
        let centre = Vec3::splat(0.05);
        let both = Material { is_double_sided: true, ..opaque() };
        let builder = one(ball(8, 5, centre, radius), opaque()).soup_of(&room, both);
        let here = Traced::new(builder.build());
        let path = over_the_top(DVec3::new(0.8, 0.0, 0.6));
        let inside = |([triangle, i], lit): &([usize; 2], Intervals)| {
            let point = here.geometry.point(*triangle, INSIDE[*i]) + here.scene.centre_m;
            (point.abs().max_element() < 0.999).then(|| minutes(lit))
        };
        let balls = here.geometry.first_triangle[1] as usize;
        let lit: Vec<f64> = lit_on(&here, &path, 0..balls).iter().filter_map(inside).collect();
        assert!(lit.len() > 100 && lit.iter().all(|&t| t == 0.0), "radius {radius}: {lit:?}");
    }
}

/// Thin walls: the inner of two balls, seen from inside, is dark, however thin what parts them.
#[test]
fn b19_thin_smooth_walls_let_no_light_in() {
    for gap in [0.2, 0.05, 0.002] {
        let inner = turned_over(ball(12, 8, Vec3::ZERO, 1.0));
        let outer = ball(12, 8, Vec3::ZERO, 1.0 + gap);
        let here = Traced::new(one(inner, opaque()).mesh_of(outer, opaque(), &[DMat4::IDENTITY]).build());
        let inside = here.geometry.first_triangle[1] as usize;
        let path = over_the_top(DVec3::X);
        assert!(lit_on(&here, &path, 0..inside).iter().all(|(_, lit)| minutes(lit) == 0.0), "{gap}");
    }
}

/// A bent sheet, closed all round: light is on its outside alone, though both of its sides are seen.
#[test]
fn b19_a_double_sided_shell_is_dark_inside() {
    let both = Material { is_double_sided: true, ..opaque() };
    let here = Traced::new(one(ball(10, 6, Vec3::ZERO, 1.0), both).build());
    let path = over_the_top(DVec3::X);
    let engine = ExactEngine::new(&here.tracer, std::slice::from_ref(&path));
    for triangle in 0..here.geometry.triangles.len() {
        for weights in INSIDE {
            let front = here.point(triangle, weights);
            let inside = sunbake::atlas::SurfacePoint {
                normal: -front.normal,
                smooth: front.smooth.map(|smooth| smooth.turned()),
                is_double_sided: false,
                ..front
            };
            assert_eq!(minutes(&lit_at(&engine, &inside)[0]), 0.0);
        }
    }
}

/// A ball that stands on the ground, or is sunk into it, has no light below the ground, and the ground's own shadow is
/// the one it had.
#[test]
fn b19_a_ball_on_the_ground_lets_no_light_under_it() {
    let path = over_the_top(DVec3::new(0.3, 0.0, 0.95).normalize());
    for height in [1.0, 0.97, 0.4] {
        let scene = || {
            let low = ball(12, 8, Vec3::Y * height, 1.0);
            one(low, opaque()).soup(&floor(Vec2::splat(-900.0), Vec2::splat(900.0), 0.0)).build()
        };
        let [smooth, faceted] = [Traced::new(scene()), Traced::faceted(scene())];
        let ground = smooth.geometry.first_triangle[1] as usize;
        let all = smooth.geometry.triangles.len();
        assert_eq!(lit_on(&smooth, &path, ground..all), lit_on(&faceted, &path, ground..all));
        for ([triangle, i], lit) in lit_on(&smooth, &path, 0..ground) {
            let height = (smooth.geometry.point(triangle, INSIDE[i]) + smooth.scene.centre_m).y;
            // A sun on the horizon looks under the ground's edge.
            assert!(height > 0.0 || minutes(&lit) < 1e-3, "{height}");
        }
    }
}

/// Grass on a hill of few faces is lower than the smooth hill rises above them: its shadow stays, where the hill's
/// faces see the sun.
#[test]
fn b19_small_things_on_large_facets_keep_their_shadows() {
    let hill = ball(12, 8, Vec3::ZERO, 10.0);
    let (triangle, weights) = (70, [0.4, 0.3]);
    let plain = Traced::new(one(hill.clone(), opaque()).build());
    let point = plain.point(triangle, weights);
    let foot = point.position_m + plain.scene.centre_m;
    let rise = point.smooth.expect("smooth").lift_m[0].length();
    assert!(rise > 0.2, "{rise}");
    // A blade to the east, an eighth as high as the rise.
    let across = point.normal.cross(DVec3::Y).normalize();
    let top = point.normal * (0.25 * rise);
    let beside = foot + across * 0.05;
    let along = point.normal.cross(across) * 0.05;
    let blade = [beside - along, beside + along, beside + top].map(|v| v.as_vec3());
    let path = over_the_top(DVec3::new(across.x, 0.0, across.z).normalize());
    let with = Traced::new(one(hill, opaque()).soup(&[blade]).build());
    let engine = |here: &Traced| {
        let mut at = here.point(triangle, weights);
        at.position_m = foot - here.scene.centre_m;
        minutes(&lit_at(&ExactEngine::new(&here.tracer, std::slice::from_ref(&path)), &at)[0])
    };
    let (bare, shaded) = (engine(&plain), engine(&with));
    assert!(shaded < bare - 0.02, "{bare} {shaded}");
}

/// B11: a mirrored ball is lit as the mirror image of a ball.
#[test]
fn b19_a_mirrored_ball_is_lit_in_the_mirror() {
    let at = |scale: DVec3| {
        let builder = SceneBuilder::new().mesh_of(ball(12, 8, Vec3::ZERO, 1.0), opaque(), &[DMat4::from_scale(scale)]);
        Traced::new(builder.build())
    };
    let [plain, mirrored] = [at(DVec3::ONE), at(DVec3::new(-1.0, 1.0, 1.0))];
    let count = plain.geometry.triangles.len();
    let a = lit_on(&plain, &over_the_top(DVec3::new(0.6, 0.0, 0.8)), 0..count);
    let b = lit_on(&mirrored, &over_the_top(DVec3::new(-0.6, 0.0, 0.8)), 0..count);
    for ((at, a), (_, b)) in a.iter().zip(&b) {
        assert!((minutes(a) - minutes(b)).abs() < 1e-5, "{at:?}: {a:?} {b:?}");
    }
}

/// B3: map coordinates of a million metres change the light by no more than their rounding.
#[test]
fn b19_far_from_the_origin_light_ends_at_the_same_place() {
    let path = over_the_top(DVec3::new(0.6, 0.0, 0.8));
    let at = |offset: DVec3| {
        let matrix = DMat4::from_translation(offset);
        Traced::new(SceneBuilder::new().mesh_of(ball(12, 8, Vec3::ZERO, 1.0), opaque(), &[matrix]).build())
    };
    let [near, far] = [at(DVec3::ZERO), at(DVec3::new(1e6, 200.0, -3e6))];
    let count = near.geometry.triangles.len();
    assert_eq!(far.geometry.smooth_count(), count);
    for ((_, a), (_, b)) in lit_on(&near, &path, 0..count).iter().zip(&lit_on(&far, &path, 0..count)) {
        assert!((minutes(a) - minutes(b)).abs() < 1e-4);
    }
}

/// Normals that are zero, not of unit length, turned over or not numbers: what cannot be smooth is flat, and its
/// neighbours are lit.
#[test]
fn b19_broken_normals_make_flat_faces() {
    let broken = |change: fn(Vec3) -> Vec3| {
        let mut mesh = ball(12, 8, Vec3::ZERO, 1.0);
        mesh.normals.iter_mut().flatten().step_by(3).for_each(|normal| *normal = change(*normal));
        Traced::new(one(mesh, opaque()).build())
    };
    let path = over_the_top(DVec3::X);
    let whole = broken(|normal| normal);
    let count = whole.geometry.triangles.len();
    let changes: [fn(Vec3) -> Vec3; 4] = [|_| Vec3::ZERO, |n| -n, |_| Vec3::NAN, |n| n * 100.0];
    for (kind, change) in changes.into_iter().enumerate() {
        let here = broken(change);
        let smooth = here.geometry.smooth_count();
        // The length of a normal does not matter.
        assert!(if kind == 3 { smooth == count } else { smooth > 0 && smooth < count }, "{kind}: {smooth}");
        let flat = Traced::faceted(here.scene.clone());
        let all = lit_on(&here, &path, 0..count).into_iter().zip(lit_on(&flat, &path, 0..count));
        for (([triangle, _], lit), (_, faceted)) in all {
            let is_well_formed = lit.as_slice().as_flattened().iter().all(|t| (0.0..=1.0).contains(t));
            assert!(is_well_formed && (here.geometry.is_smooth(triangle) || lit == faceted), "{kind}");
        }
    }
}

/// Flat-shaded things are baked to the same bytes whether or not smooth ones are looked for: with flat normals, without
/// any, and where normals are all alike but lean.
#[test]
fn b19_flat_scenes_keep_every_bit() {
    let flat = |lean: f32| {
        let triangles: Vec<[Vec3; 3]> = icosphere(1).iter().map(|t| t.map(|v| v + Vec3::Y * 1.2)).collect();
        let normal = |[a, b, c]: &[Vec3; 3]| ((*b - *a).cross(*c - *a).normalize() + Vec3::X * lean).normalize();
        let normals = triangles.iter().flat_map(|t| [normal(t); 3]).collect();
        let positions: Vec<Vec3> = triangles.iter().flatten().copied().collect();
        let indices = (0..positions.len() as u32).collect();
        let mesh = Mesh { positions, normals: Some(normals), indices, ..Mesh::default() };
        one(mesh, opaque()).soup(&floor(Vec2::splat(-3.0), Vec2::splat(3.0), 0.0)).build()
    };
    for lean in [0.0, 0.3] {
        let scene = flat(lean);
        assert_eq!(Geometry::new(&scene).smooth_count(), 0);
        let [on, off] = [true, false].map(|smooth_terminator| {
            let settings = BakeSettings { smooth_terminator, ambient: None, ..quick() };
            sunbake::bake_scene(&scene, &settings, &Silent).expect("a small scene")
        });
        assert!(on.pages.iter().zip(&off.pages).all(|(a, b)| a.maps == b.maps), "{lean}");
        assert!(!on.manifest.has_effect("smooth-terminator"));
    }
}

/// The same for a scene with a smooth thing in it: what is flat keeps its texels, and the set says what was done.
#[test]
fn b19_a_set_says_whether_light_ends_smoothly() {
    let scene = one(ball(12, 8, Vec3::Y * 1.2, 1.0), opaque()).soup(&floor(Vec2::splat(-3.0), Vec2::splat(3.0), 0.0));
    let scene: Scene = scene.build();
    let bake = |smooth_terminator| {
        let settings = BakeSettings { smooth_terminator, ambient: None, ..quick() };
        sunbake::bake_scene(&scene, &settings, &Silent).expect("a small scene")
    };
    let [on, off] = [bake(true), bake(false)];
    assert!(on.manifest.has_effect("smooth-terminator") && !off.manifest.has_effect("smooth-terminator"));
    assert!(on.pages.iter().zip(&off.pages).any(|(a, b)| a.maps != b.maps));
}
