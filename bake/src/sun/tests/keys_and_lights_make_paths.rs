//! Keyed paths and fixed lights; with them hard case B1, suns at the horizon, the zenith and along the axes.

use glam::DVec3;

use super::super::{KeyError, KeyedError, LightError, SunPath, fixed_light, parse_keyed};

fn keyed(keys: &str) -> Result<SunPath, KeyedError> {
    parse_keyed(&format!(r#"{{"keys": [{keys}]}}"#), 0.0)
}

#[test]
fn keys_are_passed_at_their_times() {
    let json = r#"{"angular_radius_deg": 0.5, "duration_min": 90, "keys": [
        {"t": 0, "azimuth_deg": 90, "elevation_deg": 10},
        {"t": 0.25, "direction": [0, 2, 0]},
        {"t": 1, "azimuth_deg": 270, "elevation_deg": 10}]}"#;
    let path = parse_keyed(json, 0.0).expect("a path");
    let (sin, cos) = 10f64.to_radians().sin_cos();
    for (t, expected) in [(0.0, DVec3::new(cos, sin, 0.0)), (0.25, DVec3::Y), (1.0, DVec3::new(-cos, sin, 0.0))] {
        assert!(path.direction(t).distance(expected) < 1e-12, "t {t}: {}", path.direction(t));
    }
    assert!((path.elevation_rad(0.125).to_degrees() - 50.0).abs() < 1e-9, "constant speed");
    assert_eq!((path.duration_min, path.angular_radius_rad), (90.0, 0.5f64.to_radians()));
    let turned = parse_keyed(json, 90.0).expect("a path");
    assert!(turned.direction(0.0).distance(DVec3::new(0.0, sin, cos)) < 1e-12, "east is +Z where north is +X");
}

#[test]
fn keys_without_times_are_evenly_spaced_and_last_as_the_sun_would() {
    let path = keyed(r#"{"direction": [1,0,0]}, {"direction": [0,1,0]}, {"direction": [-1,0,0]}"#).expect("a path");
    assert_eq!(path.arcs()[1].t, [0.5, 1.0]);
    assert!((path.duration_min - 720.0).abs() < 1e-9);
}

#[test]
fn bad_files_say_what_and_where() {
    let up = r#"{"direction": [0,1,0]}"#;
    for (keys, expected) in [
        (r#"{"t": 0, "direction": [1,0,0]}"#.to_owned(), "1 key: give 2 to 1000"),
        (format!("{up}, {up}"), "keys 0 and 1 of the path (counted from 0) point in the same direction"),
        (format!(r#"{up}, {{"direction": [0,-1,0]}}"#), "opposite directions"),
        (format!(r#"{up}, {{"direction": [0,0,0]}}"#), "key 1 of the path (counted from 0) has a direction without"),
        (format!(r#"{up}, {{"azimuth_deg": 3}}"#), "needs either 'direction' or both"),
        (format!(r#"{up}, {{"azimuth_deg": 3, "elevation_deg": 91}}"#), "91 degrees: give -90..=90"),
        (format!(r#"{up}, {{"t": 1, "direction": [1,1,0]}}"#), "key 0 of the path (counted from 0) has no 't'"),
        (r#"{"t": 0, "direction": [0,1,0]}, {"t": 12, "direction": [1,1,0]}"#.to_owned(), "t = 12: the first is at 0"),
        (r#"{"direction": [1,-1,0]}, {"direction": [-1,-1,0]}"#.to_owned(), "below the horizon"),
        (format!(r#"{up}, {{"direction": [1,0,0], "colour": 3}}"#), "unknown field `colour`"),
        (format!(r#"{up}, {{"direction": [1,0]}}"#), "line 1"),
        (format!(r#"{up}, {{"position": [1,0,0]}}"#), "a lamp's has a 'position' in every key"),
        (format!(r#"{up}, {{"direction": [1e999,0,0]}}"#), "number out of range"),
    ] {
        let message = keyed(&keys).expect_err("refused").to_string();
        assert!(message.contains(expected), "{keys}: {message}");
    }
    let order = r#"{"t": 0, "direction": [0,1,0]}, {"t": 0.6, "direction": [1,1,0]}, {"t": 0.5, "direction": [1,0,0]},
        {"t": 1, "direction": [1,0,1]}"#;
    assert!(keyed(order).expect_err("refused").to_string().contains("keys 1 and 2"));
}

#[test]
fn bad_sizes_and_positions_are_refused_by_name() {
    let keys = r#""keys": [{"direction": [0,1,0]}, {"direction": [1,1,0]}]"#;
    for (field, expected) in [
        (r#""angular_radius_deg": -1"#, "angular_radius_deg is -1"),
        (r#""angular_radius_deg": 90"#, "angular_radius_deg is 90"),
        (r#""duration_min": 0"#, "duration_min is 0"),
        (r#""positions": [[0,1,0]]"#, "a lamp's has a 'position' in every key"),
    ] {
        let message = parse_keyed(&format!("{{{field}, {keys}}}"), 0.0).expect_err("refused").to_string();
        assert!(message.contains(expected), "{message}");
    }
    assert!(matches!(parse_keyed(r#"{"positions": []}"#, 0.0), Err(KeyedError::Positions(_))));
    assert!(matches!(parse_keyed("", 0.0), Err(KeyedError::Keys(KeyError::Json(_)))));
    assert!(matches!(parse_keyed(&format!("{{{keys}}}"), f64::NAN), Err(KeyedError::North(_))));
}

#[test]
fn a_light_is_at_the_middle_of_a_way_from_horizon_to_horizon() {
    for light in [DVec3::new(0.3, 0.4, 2.0), DVec3::new(-5.0, 1e-3, 0.0), DVec3::new(0.0, 3.0, -1e-9)] {
        let path = fixed_light(light, 0.005).expect("a path");
        assert!(path.direction(0.5).distance(light.normalize()) < 1e-12);
        assert!(path.elevation_rad(0.0).abs() < 1e-12 && path.elevation_rad(1.0).abs() < 1e-12);
        assert!(path.elevation_rad(0.5) >= path.elevation_rad(0.4).max(path.elevation_rad(0.6)));
        let lit = path.above_horizon(DVec3::Y).lit_length();
        assert!(lit > 1.0 - 1e-9, "{light}: {lit}");
    }
    let south = fixed_light(DVec3::new(0.0, 1.0, 1.0), 0.0).expect("a path");
    assert!(south.direction(0.0).distance(DVec3::X) < 1e-12, "it rises in the east");
    assert!(fixed_light(DVec3::Y, 0.0).expect("a path").direction(0.0).distance(DVec3::X) < 1e-12);
}

#[test]
fn lights_that_are_no_sun_are_refused() {
    assert!(matches!(fixed_light(DVec3::ZERO, 0.0), Err(LightError::Direction(_))));
    assert!(matches!(fixed_light(DVec3::NAN, 0.0), Err(LightError::Direction(_))));
    assert!(matches!(fixed_light(DVec3::X, 0.0), Err(LightError::BelowHorizon { .. })));
    assert!(matches!(fixed_light(DVec3::NEG_Y, 0.0), Err(LightError::BelowHorizon { .. })));
    assert!(matches!(fixed_light(DVec3::Y, f64::NAN), Err(LightError::Path(_))));
}

/// B1.
#[test]
fn suns_at_the_horizon_the_zenith_and_along_the_axes_are_finite_and_none_is_lit_below() {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z];
    for elevation_deg in [-0.01, 0.0, 0.01, 89.99, 90.0] {
        let keys = format!(
            r#"{{"azimuth_deg": 0, "elevation_deg": {elevation_deg}}}, {{"azimuth_deg": 90, "elevation_deg": 45}},
               {{"azimuth_deg": 180, "elevation_deg": {elevation_deg}}}"#
        );
        let path = keyed(&keys).expect("a path");
        for i in 0..=1000 {
            let t = f64::from(i) / 1000.0;
            assert!(path.direction(t).is_finite() && path.width_t(t).is_finite());
            let height = path.direction(t).y;
            let lit = path.above_horizon(DVec3::Y).contains(t);
            assert!(
                height.abs() < 1e-12 || lit == (height > 0.0),
                "{elevation_deg}, t {t}: height {height}, lit {lit}"
            );
        }
        for normal in axes {
            assert!(path.above_plane(normal).as_slice().iter().flatten().all(|t| t.is_finite()));
        }
    }
    let level = r#"{"direction": [1,-1e-4,0]}, {"direction": [0,-1e-4,1]}"#;
    assert_eq!(keyed(level), Err(KeyedError::BelowHorizon));
}
