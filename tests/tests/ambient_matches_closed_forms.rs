//! Ambient occlusion, bent normals and the sky against closed forms, with 256 rays; and how fast errors fall with more.

use glam::{DVec2, DVec3, Quat, Vec2, Vec3};
use std::f64::consts::{FRAC_PI_2, TAU};
use sunbake::ambient::{AmbientPoint, AmbientSettings, harmonics};
use sunbake::testing::{SceneBuilder, block, floor, icosphere};
use sunbake_tests::Traced;
use sunbake_tests::ambient::{ambient_at, ambient_visibility, flat, rays, rms, share_of_polygon};

/// Half the edge of what stands for an endless plane, in metres; what is looked at is a metre or so from it.
const ENDLESS: f32 = 4000.0;
/// Points that are asked in each case.
const POINTS: usize = 256;
/// What 256 rays may be off at the worst of these points, and in the root of the mean square.
const BOUND: [f64; 2] = [0.03, 0.009];

/// A closed form: a scene, a stretch of points on its first triangle, and what each should read.
struct Case {
    name: &'static str,
    traced: Traced,
    points: Vec<AmbientPoint>,
    expected: Vec<f64>,
}

impl Case {
    fn new(name: &'static str, builder: SceneBuilder, at: impl Fn(f64) -> DVec3, open: impl Fn(DVec3) -> f64) -> Self {
        let traced = Traced::new(builder.build());
        let places: Vec<DVec3> = (0..POINTS).map(|i| at(i as f64 / (POINTS - 1) as f64)).collect();
        let points = places.iter().map(|&place| flat(traced.point_at(place, 0))).collect();
        Self { name, traced, points, expected: places.iter().map(|&place| open(place)).collect() }
    }

    fn errors(&self, settings: AmbientSettings) -> Vec<f64> {
        let found = ambient_visibility(&self.traced, &self.points, settings);
        found.iter().zip(&self.expected).map(|(found, expected)| found - expected).collect()
    }
}

fn ground() -> SceneBuilder {
    SceneBuilder::new().soup(&floor(Vec2::splat(-ENDLESS), Vec2::splat(ENDLESS), 0.0))
}

/// How far folds are turned about the vertical: along an axis, cells of the square would end just where they do.
const TURN: f32 = 0.35;

fn turned(v: Vec3) -> Vec3 {
    Quat::from_rotation_y(TURN) * v
}

/// The half of the ground beyond x = 0 (but for a turn), and another half that rises from there by an angle.
fn fold(angle: f64) -> SceneBuilder {
    let end = Vec3::new(-(angle.cos() as f32), angle.sin() as f32, 0.0) * ENDLESS;
    let [near, far] = [-ENDLESS, ENDLESS].map(|z| Vec3::new(0.0, 0.0, z));
    let half = floor(Vec2::new(0.0, -ENDLESS), Vec2::splat(ENDLESS), 0.0);
    let in_turn = |triangles: &[[Vec3; 3]]| triangles.iter().map(|t| t.map(turned)).collect::<Vec<_>>();
    SceneBuilder::new().soup(&in_turn(&half)).soup(&in_turn(&[[near, far, end + far], [near, end + far, end + near]]))
}

/// A disc of many corners, level, about a point.
fn disc(centre: Vec3, radius: f32) -> (Vec<[Vec3; 3]>, Vec<DVec3>) {
    let corner = |i: u32| {
        let (sin, cos) = (i as f32 / 96.0 * std::f32::consts::TAU).sin_cos();
        centre + Vec3::new(cos, 0.0, sin) * radius
    };
    let triangles = (0..96).map(|i| [centre, corner(i), corner((i + 1) % 96)]).collect();
    (triangles, (0..96).map(|i| corner(i).as_dvec3()).collect())
}

fn cases() -> Vec<Case> {
    let along = |t: f64| DVec3::new(0.5 + t, 0.0, 0.3 * t);
    let mut cases = vec![Case::new("open plane", ground(), along, |_| 1.0)];
    for (name, degrees) in
        [("flat fold", 0.0), ("fold of 30", 30.0), ("fold of 60", 60.0), ("right fold", 90.0), ("fold of 135", 135.0)]
    {
        let angle = f64::to_radians(degrees);
        let along = |t: f64| turned(along(t).as_vec3()).as_dvec3();
        cases.push(Case::new(name, fold(angle), along, move |_| (1.0 + angle.cos()) / 2.0));
    }
    let (triangles, polygon) = disc(Vec3::new(0.2, 1.0, 0.1), 0.8);
    let under = ground().soup(&triangles);
    let at = |t: f64| DVec3::new(2.0 * t - 1.0, 0.0, 0.2);
    cases.push(Case::new("under a disc", under, at, move |p| 1.0 - share_of_polygon(p, DVec3::Y, &polygon)));
    let wall = block(Vec3::new(-0.2, 0.0, -ENDLESS), Vec3::new(0.0, 1.5, ENDLESS));
    let beside = |p: DVec3| 1.0 - (1.0 - (1.5f64.atan2(p.x)).cos()) / 2.0;
    cases.push(Case::new("beside an endless wall", ground().soup(&wall), along, beside));
    let ball: Vec<[Vec3; 3]> = icosphere(5).iter().map(|t| t.map(|v| v * 0.7 + Vec3::Y)).collect();
    let shaded = |p: DVec3| {
        let way = DVec3::Y - p;
        1.0 - 0.49 * way.y / way.length().powi(3)
    };
    cases.push(Case::new("under a sphere", ground().soup(&ball), at, shaded));
    cases
}

#[test]
fn ambient_visibility_matches_geometry() {
    for case in cases() {
        let errors = case.errors(rays(256));
        let worst = errors.iter().fold(0.0f64, |worst, error| worst.max(error.abs()));
        let typical = rms(errors.iter().copied());
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        println!("{:<24} worst {worst:.4}  rms {typical:.4}  mean {mean:+.5}", case.name);
        assert!(worst <= BOUND[0] && typical <= BOUND[1], "{}: {worst}, {typical}", case.name);
        // Over 256 points errors cancel: what is left would be a bias.
        assert!(mean.abs() <= 4.0 * BOUND[1] / (POINTS as f64).sqrt(), "{}: biased by {mean}", case.name);
        if matches!(case.name, "open plane" | "flat fold") {
            assert_eq!(worst, 0.0, "{}: nothing hides anything", case.name);
        }
    }
}

#[test]
fn errors_fall_at_least_as_the_power_of_rays_of_seven_tenths() {
    for case in cases().into_iter().filter(|case| case.expected.iter().any(|&open| open < 1.0)) {
        let at = |bits: u32| (f64::from(bits), rms(case.errors(rays(1 << bits)).into_iter()).log2());
        let power = slope(&(2..=12).map(at).collect::<Vec<_>>());
        println!("{:<24} rms falls as N^{power:.2}", case.name);
        assert!(power <= -0.7, "{}: N^{power}", case.name);
    }
}

/// Of the line nearest to points, by least squares.
fn slope(points: &[(f64, f64)]) -> f64 {
    let count = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum::<f64>() / points.iter().map(|p| (p.0 - x).powi(2)).sum::<f64>()
}

#[test]
fn a_requested_error_is_met_with_few_rays_where_few_suffice() {
    for error in [0.05, 0.02, 0.01] {
        let (mut within, mut all) = (0, 0);
        for case in cases() {
            let settings = AmbientSettings { error: Some(error), ..rays(4096) };
            let errors = case.errors(settings);
            let of_case = errors.iter().filter(|e| e.abs() <= error).count();
            assert!(of_case * 100 >= 95 * errors.len(), "{}: {of_case} of {} within {error}", case.name, errors.len());
            (within, all) = (within + of_case, all + errors.len());
            if case.name == "open plane" {
                let (_, traced) = ambient_at(&case.traced, &case.points, settings);
                assert!(traced <= 64 * POINTS as u64, "{traced} rays for an open plane");
            }
        }
        let share = within as f64 / all as f64;
        println!("to {error}: {share:.4} of the points are within");
        assert!(share >= 0.95, "{share} within {error}");
    }
}

#[test]
fn a_hard_texel_among_easy_ones_gets_its_rays() {
    // Fifteen points in the open, and one beside a wall and under bars, again and again.
    let wall = block(Vec3::new(-0.2, 0.0, -40.0), Vec3::new(0.0, 1.5, 40.0));
    let bars: Vec<[Vec3; 3]> = (0..40)
        .flat_map(|i| block(Vec3::new(0.1 * i as f32, 1.0, -40.0), Vec3::new(0.1 * i as f32 + 0.04, 1.05, 40.0)))
        .collect();
    let traced = Traced::new(ground().soup(&wall).soup(&bars).build());
    let place = |i: usize| match i % 16 {
        7 => DVec3::new(0.6, 0.0, 0.02 * (i / 16) as f64),
        _ => DVec3::new(900.0, 0.0, 0.1 * i as f64),
    };
    let points: Vec<AmbientPoint> = (0..4096).map(|i| flat(traced.point_at(place(i), 0))).collect();
    let truth = ambient_visibility(&traced, &points[7..8], rays(65_536))[0];
    for error in [0.05, 0.02] {
        let found = ambient_visibility(&traced, &points, AmbientSettings { error: Some(error), ..rays(4096) });
        let hard: Vec<f64> = found.iter().skip(7).step_by(16).map(|open| (open - truth).abs()).collect();
        let within = hard.iter().filter(|off| **off <= error).count() as f64 / hard.len() as f64;
        println!("to {error}: {within:.3} of the hard ones are within");
        // One draw of the error, or two, are all that tells a lone one: pooling over its neighbours alone kept 59 of 100.
        assert!(within >= 0.8, "{within} within {error}");
    }
}

#[test]
fn a_closed_box_is_dark_and_with_a_distance_only_its_corners_are() {
    let half = Vec3::new(1.0, 1.5, 2.0);
    // Turned inside out, as rooms are, and as they come.
    for is_room in [true, false] {
        let walls = block(-half, half);
        let walls = if is_room { sunbake_tests::flipped(&walls) } else { walls };
        let traced = Traced::new(SceneBuilder::new().soup(&walls).build());
        let normals: Vec<DVec3> =
            (0..12).map(|t| traced.geometry.normal(t) * if is_room { 1.0 } else { -1.0 }).collect();
        let inside = |i: usize| {
            let triangle = i % 12;
            let weights = [0.1 + 0.05 * (i % 7) as f64, 0.1 + 0.06 * (i % 5) as f64];
            let point = traced.point(triangle, weights);
            AmbientPoint {
                shading_normal: normals[triangle],
                surface: sunbake::atlas::SurfacePoint { normal: normals[triangle], ..point },
            }
        };
        let points: Vec<AmbientPoint> = (0..240).map(inside).collect();
        assert!(ambient_visibility(&traced, &points, rays(256)).iter().all(|&open| open == 0.0));
        let reach = 1.2;
        let found = ambient_visibility(&traced, &points, AmbientSettings { distance_m: Some(reach), ..rays(256) });
        for (point, found) in points.iter().zip(found) {
            let expected = visibility_in_box(point.surface.position_m, point.shading_normal, half.as_dvec3(), reach);
            assert!((found - expected).abs() < 0.02, "{found} for {expected}");
        }
    }
}

/// Ambient visibility inside a box within a distance, by a fine rule over the disc under the hemisphere.
fn visibility_in_box(from: DVec3, normal: DVec3, half: DVec3, reach: f64) -> f64 {
    let (across, up) = normal.any_orthonormal_pair();
    let (rings, spokes) = (200, 200);
    let mut hidden = 0.0;
    for ring in 0..rings {
        let radius = ((f64::from(ring) + 0.5) / f64::from(rings)).sqrt();
        for spoke in 0..spokes {
            let (sin, cos) = (f64::from(spoke) / f64::from(spokes) * TAU).sin_cos();
            let way = across * (radius * cos) + up * (radius * sin) + normal * (1.0 - radius * radius).sqrt();
            let to_wall = |k: usize| {
                if way[k].abs() < 1e-12 { f64::INFINITY } else { (half[k] * way[k].signum() - from[k]) / way[k] }
            };
            let distance = to_wall(0).min(to_wall(1)).min(to_wall(2)).max(0.0);
            hidden += (1.0 - (distance / reach).min(1.0).powi(2)).powi(2);
        }
    }
    1.0 - hidden / f64::from(rings * spokes)
}

#[test]
fn a_convex_solid_on_the_ground_sees_the_sky_by_its_slope() {
    // A wedge: its slope leans by 30, 45 and 70 degrees, its back stands upright.
    for degrees in [30.0f64, 45.0, 70.0] {
        let top = degrees.to_radians().tan() as f32;
        let [a, b] = [Vec3::ZERO, Vec3::X];
        let c = Vec3::new(1.0, top, 0.0);
        let deep = Vec3::Z * 3.0;
        let slope = [[a, a + deep, c + deep], [a, c + deep, c]];
        let back = [[b, c, c + deep], [b, c + deep, b + deep]];
        let ends = [[a, c, b], [a + deep, b + deep, c + deep]];
        let traced = Traced::new(ground().soup(&slope).soup(&back).soup(&ends).build());
        for (triangle, lean) in [(2, degrees), (4, 90.0)] {
            let points: Vec<AmbientPoint> =
                (0..POINTS).map(|i| flat(traced.point(triangle, [0.2 + 0.001 * i as f64, 0.3]))).collect();
            assert!(points[0].surface.normal.y >= -1e-6);
            let expected = (1.0 + lean.to_radians().cos()) / 2.0;
            let errors = ambient_visibility(&traced, &points, rays(256))
                .into_iter()
                .map(|open| open - expected)
                .collect::<Vec<_>>();
            assert!(rms(errors.iter().copied()) < BOUND[1], "{lean}: {}", rms(errors.iter().copied()));
        }
    }
}

#[test]
fn a_sphere_alone_reads_one_at_any_number_of_facets() {
    for level in [0, 1, 2] {
        let traced = Traced::new(SceneBuilder::new().soup(&icosphere(level)).build());
        let count = traced.geometry.triangles.len();
        let point = |i: usize| {
            let surface = traced.point(i % count, [0.1 + 0.013 * (i % 50) as f64, 0.1]);
            AmbientPoint { shading_normal: (surface.position_m + traced.scene.centre_m).normalize(), surface }
        };
        let points: Vec<AmbientPoint> = (0..1000).map(point).collect();
        assert!(ambient_visibility(&traced, &points, rays(64)).iter().all(|&open| open == 1.0), "level {level}");
    }
}

#[test]
fn bent_normals_point_to_the_unoccluded_directions() {
    let open = &cases()[0];
    let (found, _) = ambient_at(&open.traced, &open.points, rays(256));
    assert!(found.iter().all(|e| e.bent.as_dvec3().distance(DVec3::Y * (2.0 / 3.0)) < 0.01));
    // Before an endless wall half of the disc under the hemisphere is free, and its centroid lies 4/(3 pi) off.
    let traced = Traced::new(fold(FRAC_PI_2).build());
    let points: Vec<AmbientPoint> = open
        .points
        .iter()
        .map(|p| flat(traced.point_at(p.surface.position_m + open.traced.scene.centre_m, 0)))
        .collect();
    let (found, _) = ambient_at(&traced, &points, rays(256));
    let expected = turned(Vec3::new(4.0 / (3.0 * std::f32::consts::PI), 2.0 / 3.0, 0.0)).as_dvec3();
    let worst = found.iter().map(|e| e.bent.as_dvec3().distance(expected)).fold(0.0, f64::max);
    assert!(worst < 0.03, "{worst}");
}

#[test]
fn sky_harmonics_are_the_integral_over_the_unoccluded_directions() {
    // In the open, degree by degree: 1, 2/3 and 1/4 of the functions at the normal (Ramamoorthi and Hanrahan, 2001).
    let open = &cases()[0];
    let (found, _) = ambient_at(&open.traced, &open.points, rays(1024));
    let at_normal = harmonics::basis(DVec3::Y);
    let shares = [1.0, 2.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0, 0.25, 0.25, 0.25, 0.25, 0.25];
    for estimate in &found {
        for k in 0..harmonics::COUNT {
            assert!((f64::from(estimate.sky[k]) - shares[k] * at_normal[k]).abs() < 0.01, "{k}");
        }
    }
    // Before a wall: by a fine rule over the free half of the disc.
    let traced = Traced::new(fold(FRAC_PI_2).build());
    let points: Vec<AmbientPoint> =
        (0..64).map(|i| flat(traced.point_at(turned(Vec3::new(1.0, 0.0, 0.1 * i as f32)).as_dvec3(), 0))).collect();
    let (found, _) = ambient_at(&traced, &points, rays(1024));
    let mut expected = [0.0; harmonics::COUNT];
    let steps = 400;
    let mut inside = 0;
    for i in 0..steps {
        for j in 0..steps {
            let disc = (DVec2::new(f64::from(i) + 0.5, f64::from(j) + 0.5) / f64::from(steps)) * 2.0 - 1.0;
            if disc.length_squared() < 1.0 {
                inside += 1;
                if disc.x > 0.0 {
                    let direction =
                        Vec3::new(disc.x as f32, (1.0 - disc.length_squared()).sqrt() as f32, disc.y as f32);
                    let direction = turned(direction).as_dvec3();
                    expected.iter_mut().zip(harmonics::basis(direction)).for_each(|(sum, value)| *sum += value);
                }
            }
        }
    }
    for (k, expected) in expected.map(|sum| sum / f64::from(inside)).into_iter().enumerate() {
        let mean = found.iter().map(|e| f64::from(e.sky[k])).sum::<f64>() / found.len() as f64;
        assert!((mean - expected).abs() < 0.003, "{k}: {mean} for {expected}");
    }
}

#[test]
fn symmetric_scenes_read_alike_on_both_sides() {
    let post = block(Vec3::new(-0.3, 0.0, -0.3), Vec3::new(0.3, 2.0, 0.3));
    let traced = Traced::new(ground().soup(&post).build());
    let read = |sign_x: f64, sign_z: f64, swap: bool| {
        let place = |i: usize| {
            let (x, z) = (0.4 + 0.01 * (i % 64) as f64, 0.05 * (i / 64) as f64);
            let (x, z) = if swap { (z, x) } else { (x, z) };
            flat(traced.point_at(DVec3::new(sign_x * x, 0.0, sign_z * z), 0))
        };
        ambient_visibility(&traced, &(0..512).map(place).collect::<Vec<_>>(), rays(256))
    };
    let one = read(1.0, 1.0, false);
    for (sign_x, sign_z, swap) in [(-1.0, 1.0, false), (1.0, -1.0, false), (1.0, 1.0, true), (-1.0, -1.0, true)] {
        let other = read(sign_x, sign_z, swap);
        let differences = one.iter().zip(&other).map(|(a, b)| a - b);
        let mean = differences.clone().sum::<f64>() / 512.0;
        assert!(rms(differences.clone()) < 0.014 && mean.abs() < 0.002, "{} {mean}", rms(differences));
    }
}
