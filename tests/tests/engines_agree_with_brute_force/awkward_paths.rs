//! I4 and the paths around it: great circles and cones, poles, several arcs, more than a turn, several lanes.

use glam::{DVec3, Vec3};
use sunbake::sun::{SunArc, SunPath};
use sunbake::testing::SceneBuilder;
use sunbake::visibility::{Intervals, lit_at};
use sunbake_tests::engines::{ALL, EXACT, all_must_agree};
use sunbake_tests::paths::{Random, SOLSTICE_DEG, day_at, of_every_kind};
use sunbake_tests::{Traced, path_of};

/// Forty triangles of a metre or so, within six metres of a floor's middle.
fn clutter(seed: u64) -> Traced {
    let mut random = Random::new(seed);
    let floor = sunbake::testing::floor(glam::Vec2::splat(-8.0), glam::Vec2::splat(8.0), -3.0);
    let triangles: Vec<[Vec3; 3]> = (0..40)
        .map(|_| {
            let middle = random.cube() * DVec3::new(6.0, 3.0, 6.0) + DVec3::Y * 1.5;
            [0; 3].map(|_| (middle + random.cube()).as_vec3())
        })
        .collect();
    Traced::new(SceneBuilder::new().soup(&floor).soup(&triangles).build())
}

fn points(here: &Traced, random: &mut Random, count: usize) -> Vec<sunbake::atlas::SurfacePoint> {
    let mut point = || {
        let (u, v) = (random.unit(), random.unit());
        let mut point = here.point(random.index(here.geometry.triangles.len()), [u * (1.0 - v), v]);
        point.is_double_sided = random.index(2) == 0;
        point
    };
    (0..count).map(|_| point()).collect()
}

/// I4.
#[test]
fn days_keys_and_turns_of_every_kind_agree() {
    let mut random = Random::new(6);
    for (kind, path) in of_every_kind() {
        let here = clutter(7);
        all_must_agree(kind, &here, &path, &points(&here, &mut random, 60));
    }
}

/// I4: declination 0 and the solstices, at any tilt of the axis, the pole and the equator among them.
#[test]
fn cones_and_great_circles_at_every_latitude_agree() {
    let mut random = Random::new(8);
    let here = clutter(9);
    for latitude_deg in [-90.0, -66.0, -23.44, 0.0, 40.0, 66.56, 89.999, 90.0f64] {
        let (sin, cos) = latitude_deg.to_radians().sin_cos();
        let axis = -DVec3::new(0.0, sin, -cos);
        for declination_deg in [0.0, 1e-9, SOLSTICE_DEG, -SOLSTICE_DEG] {
            let arc = SunArc {
                axis,
                zero: DVec3::X,
                declination_rad: f64::to_radians(declination_deg),
                hour_angle_rad: [-4.0, 3.5],
                t: [0.0, 1.0],
            };
            // A sun that turns within rounding of the horizon is up or down as rounding goes.
            if latitude_deg.abs() > 89.9 && declination_deg.abs() < 0.01 {
                well_formed(&here, &path_of(arc), &points(&here, &mut random, 5));
            } else {
                let case = format!("latitude {latitude_deg}, declination {declination_deg}");
                all_must_agree(&case, &here, &path_of(arc), &points(&here, &mut random, 10));
            }
        }
    }
}

fn well_formed(here: &Traced, path: &SunPath, points: &[sunbake::atlas::SurfacePoint]) {
    for (engine, point) in ALL.iter().flat_map(|engine| points.iter().map(move |point| (engine, point))) {
        let found = engine.lit(here, path, point);
        assert!(found.as_slice().iter().flatten().all(|t| (0.0..=1.0).contains(t)), "{found:?}");
    }
}

/// A tower and a sun that turns twice: the same shadow, twice.
#[test]
fn a_sun_that_turns_twice_is_hidden_twice() {
    let wall = [Vec3::new(3.0, -1.0, -1.0), Vec3::new(3.0, -1.0, 1.0), Vec3::new(3.0, 9.0, 0.0)];
    let floor = sunbake::testing::floor(glam::Vec2::splat(-8.0), glam::Vec2::splat(8.0), -1.0);
    let here = Traced::new(SceneBuilder::new().soup(&floor).soup(&[wall]).build());
    let point = here.observer(DVec3::ZERO, DVec3::Y, 0);
    let turns = |count: f64| {
        let hour_angle_rad = [1.0, 1.0 + count * std::f64::consts::TAU];
        path_of(SunArc { axis: -DVec3::Y, zero: DVec3::X, declination_rad: -0.5, hour_angle_rad, t: [0.0, 1.0] })
    };
    for engine in ALL {
        let [once, twice] = [1.0, 2.0].map(|count| engine.lit(&here, &turns(count), &point));
        assert_eq!((once.as_slice().len(), twice.as_slice().len()), (2, 3));
        let off = (once.lit_length() - twice.lit_length()).abs();
        assert!(off <= 4.0 * (engine.edge_t)(&turns(1.0)), "{once:?} {twice:?}");
    }
    all_must_agree("two turns", &here, &turns(2.0), &[point]);
}

#[test]
fn lanes_are_answered_as_if_each_were_alone() {
    let here = clutter(10);
    let day = day_at(40.0, "2026-06-21");
    let lanes = [-0.003, 0.0, 0.003].map(|offset_rad| day.lane(offset_rad));
    let mut differ = 0;
    for point in points(&here, &mut Random::new(11), 40) {
        for engine in ALL {
            let together = lit_at((engine.make)(&here.tracer, &lanes).as_ref(), &point);
            let alone: Vec<Intervals> = lanes.iter().map(|lane| engine.lit(&here, lane, &point)).collect();
            assert_eq!(together, alone);
            differ += u32::from(together[0] != together[2]);
        }
    }
    assert!(differ > 20, "lanes hardly differ: {differ}");
}

/// A session may remember what it likes, so long as no answer depends on it.
#[test]
fn neighbours_change_no_answer() {
    let here = clutter(12);
    let path = day_at(40.0, "2026-03-20");
    let points = points(&here, &mut Random::new(13), 200);
    for engine in [ALL[0].make, ALL[1].make, EXACT.make] {
        let engine = engine(&here.tracer, std::slice::from_ref(&path));
        let mut together = sunbake::visibility::IntervalTable::default();
        engine.session().lit(&points, &mut together);
        let alone: Vec<Intervals> = points.iter().map(|point| lit_at(engine.as_ref(), point).swap_remove(0)).collect();
        assert_eq!(together.iter().collect::<Vec<_>>(), alone);
    }
}
