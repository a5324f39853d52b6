//! Ambient occlusion, bent normals and the sky against closed forms.

mod directions_of_the_sky;
mod errors_and_rays;
mod solids_and_rooms;

use glam::{DVec3, Quat, Vec2, Vec3};
use sunbake::ambient::{AmbientPoint, AmbientSettings};
use sunbake::testing::{SceneBuilder, block, floor, icosphere};
use sunbake_tests::Traced;
use sunbake_tests::ambient::{ambient_visibility, flat, share_of_polygon};

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
        let to_sphere = DVec3::Y - p;
        1.0 - 0.49 * to_sphere.y / to_sphere.length().powi(3)
    };
    cases.push(Case::new("under a sphere", ground().soup(&ball), at, shaded));
    cases
}
