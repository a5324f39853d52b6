//! Days against answers that do not come from the ephemeris crate: a published case, almanacs, closed forms.

use glam::DVec3;

use super::super::{Compass, DayOutcome, DayRequest, SunPath, day, ephemeris::Ephemeris};
use super::days_follow_the_ephemeris::request;

/// Declination of the sun at a June solstice of these years: the obliquity of the ecliptic.
const OBLIQUITY_DEG: f64 = 23.436;

pub(super) fn path(request: &DayRequest) -> SunPath {
    match day(request).expect("a day") {
        DayOutcome::Path(path) => path,
        DayOutcome::NoSun { highest_elevation_deg, .. } => panic!("no sun, {highest_elevation_deg} degrees at most"),
    }
}

#[test]
fn the_published_case_of_the_solar_position_algorithm_comes_out() {
    // I. Reda and A. Andreas, "Solar Position Algorithm for Solar Radiation Applications", NREL/TP-560-34302, table
    // A5.1: 12:30:30 at UTC-7; azimuth 194.34024, elevation without refraction 39.872046. (There at 1,830 m.)
    let place = [39.742476, -105.1786];
    let ephemeris = Ephemeris::new(place, "2003-10-17".parse().expect("a date"), -7.0, Compass::new(0.0)).expect("one");
    let [azimuth, elevation] = ephemeris.azimuth_elevation_deg(12.0 * 60.0 + 30.5).expect("a position");
    assert!((azimuth - 194.34024).abs() < 1e-4, "{azimuth}");
    assert!((elevation - 39.872046).abs() < 1e-4, "{elevation}");
}

#[test]
fn almanac_sunrises_have_the_centre_50_arc_minutes_below_the_horizon() {
    // Rounded to the minute, in which the sun moves by up to 0.25 degrees.
    for (place, offset, date, rise, set) in [
        ([51.5074, -0.1278], 1.0, "2026-06-21", [4.0, 43.0], [21.0, 21.0]),
        ([40.7128, -74.0060], -4.0, "2026-06-21", [5.0, 25.0], [20.0, 31.0]),
        ([-33.8688, 151.2093], 11.0, "2026-12-21", [5.0, 41.0], [20.0, 5.0]),
    ] {
        let ephemeris = Ephemeris::new(place, date.parse().expect("a date"), offset, Compass::new(0.0)).expect("one");
        for [hour, minute] in [rise, set] {
            let elevation = ephemeris.elevation_deg(hour * 60.0 + minute).expect("a position");
            assert!((elevation + 50.0 / 60.0).abs() < 0.2, "{place:?} {date} {hour}:{minute}: {elevation}");
        }
    }
}

#[test]
fn daylight_at_the_solstice_has_the_closed_forms_length() {
    for latitude in [-60.0f64, -33.0, 0.0, 20.0, 51.5, 64.0] {
        let path = path(&request(latitude, 0.0, "2026-06-21"));
        let cos_h = -latitude.to_radians().tan() * OBLIQUITY_DEG.to_radians().tan();
        let expected_min = 2.0 * cos_h.acos().to_degrees() * 4.0;
        assert!((path.duration_min - expected_min).abs() < 0.5, "{latitude}: {} {expected_min}", path.duration_min);
        let [first, last] = [0.0, 1.0].map(|t| path.elevation_rad(t).to_degrees());
        assert!(first.abs() < 0.02 && last.abs() < 0.02, "{latitude}: ends at {first} and {last} degrees");
    }
}

#[test]
fn a_poles_shadow_at_solstice_noon_is_trigonometry() {
    let path = path(&request(40.0, 0.0, "2026-06-21"));
    let noon = path.direction(0.5);
    let shadow_m = -DVec3::new(noon.x, 0.0, noon.z) * (10.0 / noon.y);
    // North of the pole, that is at -Z, and as long as the sun's zenith distance says.
    let expected_m = 10.0 * (40.0 - OBLIQUITY_DEG).to_radians().tan();
    assert!((shadow_m.z + expected_m).abs() < 0.01 && shadow_m.x.abs() < 0.02, "{shadow_m} {expected_m}");
}

#[test]
fn a_poles_shadow_at_an_equinox_moves_along_a_straight_line() {
    let path = path(&request(45.0, 10.0, "2026-03-20"));
    for i in 3..=17 {
        let direction = path.direction(f64::from(i) / 20.0);
        let shadow = -direction / direction.y;
        assert!((shadow.z + 1.0).abs() < 0.02, "t {}: {shadow}", f64::from(i) / 20.0);
        assert!(i == 10 || (shadow.x < 0.0) == (i < 10), "west of the pole before noon, east after");
    }
}

#[test]
fn the_equator_has_the_sun_overhead_at_an_equinox() {
    let path = path(&request(0.0, 0.0, "2026-03-20"));
    let highest = (0..=1000).map(|i| path.elevation_rad(f64::from(i) / 1000.0).to_degrees()).fold(0.0, f64::max);
    assert!(highest > 89.5, "{highest}");
    assert!(path.direction(0.0).x > 0.999 && path.direction(1.0).x < -0.999, "from east to west");
}

#[test]
fn the_sun_rises_in_the_east_culminates_south_and_follows_the_scenes_north() {
    let mut request = request(51.5, 0.0, "2026-09-23");
    let straight = path(&request);
    assert!(straight.direction(0.0).x > 0.99 && straight.direction(0.5).z > 0.7 && straight.direction(1.0).x < -0.99);
    for north_deg in [90.0, -37.5, 180.0, 725.0] {
        request.north_deg = north_deg;
        let turned = path(&request);
        // Clockwise seen from above is a negative turn about +Y.
        let turn = glam::DQuat::from_rotation_y(-f64::to_radians(north_deg));
        for i in 0..=10 {
            let t = f64::from(i) / 10.0;
            assert!((turn * straight.direction(t)).distance(turned.direction(t)) < 1e-6, "north {north_deg}, t {t}");
        }
    }
    request.north_deg = 90.0;
    assert!(path(&request).direction(0.5).x < -0.7, "north is +X, so the noon sun is at -X");
}
