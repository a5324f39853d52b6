//! Hard case B2: polar day and night, poles, the date line, leap days, clocks far from the sun, windows.

use super::super::{Compass, DayError, DayOutcome, DayRequest, day, ephemeris::Ephemeris, parse_utc_offset};
use super::Random;
use super::days_follow_the_ephemeris::request;
use super::days_follow_trigonometry::path;

fn assert_follows_ephemeris(request: &DayRequest) {
    let path = path(request);
    let day = path.day.as_ref().expect("a day");
    let place = [request.latitude_deg, request.longitude_deg];
    let ephemeris =
        Ephemeris::new(place, request.date, day.utc_offset_h, Compass::new(request.north_deg)).expect("one");
    for i in 0..=300 {
        let t = f64::from(i) / 300.0;
        let truth = ephemeris.direction(day.start_min + t * path.duration_min).expect("a direction");
        let error = path.direction(t).angle_between(truth).to_degrees();
        assert!(truth.y < 0.0 || error < 0.02, "{request:?}: {error} degrees at t {t}");
    }
}

/// B2.
#[test]
fn polar_day_runs_from_midnight_to_midnight() {
    for latitude in [70.0, 78.2, 89.9, 90.0] {
        let path = path(&request(latitude, 20.0, "2026-06-21"));
        assert_eq!([path.clock_min(0.0), path.clock_min(1.0)], [Some(0.0), Some(1440.0)], "latitude {latitude}");
        assert_eq!(path.above_horizon(glam::DVec3::Y).as_slice(), [[0.0, 1.0]], "latitude {latitude}");
        assert_eq!([path.t_at_clock_min(0.0), path.t_at_clock_min(1440.0)], [Some(0.0), Some(1.0)]);
    }
    let pole = path(&request(-90.0, 0.0, "2026-12-21"));
    for i in 0..=24 {
        assert!((pole.elevation_rad(f64::from(i) / 24.0).to_degrees() - 23.436).abs() < 0.02);
    }
}

/// B2.
#[test]
fn polar_night_says_how_high_the_sun_came() {
    for (latitude, date) in [(70.0, "2026-12-21"), (90.0, "2026-12-21"), (-80.0, "2026-06-21"), (-90.0, "2026-06-21")] {
        for window in [None, Some([600.0, 840.0])] {
            let request = DayRequest { window, ..request(latitude, 0.0, date) };
            let DayOutcome::NoSun { highest_elevation_deg, highest_min } = day(&request).expect("no failure") else {
                panic!("latitude {latitude} has sun on {date}")
            };
            let expected = 90.0 - latitude.abs() - 23.436;
            assert!((highest_elevation_deg - expected).abs() < 0.01, "{latitude}: {highest_elevation_deg} {expected}");
            assert!(latitude.abs() == 90.0 || (highest_min - 720.0).abs() < 30.0, "{highest_min}");
        }
    }
}

#[test]
fn days_around_the_end_of_the_polar_night_and_day_never_fail() {
    let mut outcomes = [0; 2];
    for latitude in [65.8, 66.2, 66.6, 67.0, 67.4, -66.8, 84.0, 89.9, 90.0, -90.0] {
        for date in ["2026-06-19", "2026-12-19", "2026-03-18", "2026-03-20", "2026-03-21", "2026-09-22", "2026-09-24"] {
            for utc_offset_h in [None, Some(-12.0), Some(14.0)] {
                let request = DayRequest { utc_offset_h, ..request(latitude, 25.0, date) };
                let DayOutcome::Path(path) = day(&request).expect("no failure") else {
                    outcomes[0] += 1;
                    continue;
                };
                outcomes[1] += 1;
                assert!(path.duration_min > 0.0 && path.duration_min <= 1440.0 + 1e-6, "{request:?}");
                assert!(!path.above_horizon(glam::DVec3::Y).as_slice().is_empty(), "{request:?}");
                assert_follows_ephemeris(&request);
            }
        }
    }
    assert!(outcomes.iter().all(|count| *count > 10), "{outcomes:?}");
}

/// B2.
#[test]
fn both_sides_of_the_date_line_share_one_sun() {
    let east = path(&DayRequest { utc_offset_h: Some(12.0), ..request(-17.0, 180.0, "2028-02-29") });
    let west = path(&DayRequest { utc_offset_h: Some(-12.0), ..request(-17.0, -180.0, "2028-02-28") });
    assert_eq!(east.utc_text(0.0), west.utc_text(0.0));
    assert_eq!(east.local_text(0.5).map(|text| text[..10].to_owned()).as_deref(), Some("2028-02-29"));
    for i in 0..=20 {
        let t = f64::from(i) / 20.0;
        assert!(east.direction(t).distance(west.direction(t)) < 1e-6, "t {t}");
    }
    let default = path(&request(-17.0, 179.9, "2028-02-29"));
    assert_eq!(default.day.expect("a day").utc_offset_h, 12.0);
}

#[test]
fn a_sun_that_sets_after_midnight_belongs_to_the_date_of_its_noon() {
    // Fairbanks on summer time: the almanac's sunset is at 00:47 on the 22nd, the centre's some minutes earlier.
    let fairbanks = DayRequest { utc_offset_h: Some(-8.0), ..request(64.84, -147.72, "2026-06-21") };
    let path = path(&fairbanks);
    let end = path.clock_min(1.0).expect("a clock");
    assert!((1440.0..1487.0).contains(&end), "{end}");
    assert_eq!(path.local_text(1.0).map(|text| text[..10].to_owned()).as_deref(), Some("2026-06-22"));
    assert_eq!(path.t_at_clock_min(15.0), path.t_at_clock_min(1455.0), "00:15 is in the evening of this day");
    assert!(path.t_at_clock_min(120.0).is_none(), "the sun is down at 02:00");
    assert_follows_ephemeris(&fairbanks);
}

#[test]
fn clocks_far_from_the_suns_own_still_give_one_whole_day() {
    for utc_offset_h in [-12.0, -5.75, 0.0, 5.75, 11.9, 12.0, 12.1, 14.0] {
        let request = DayRequest { utc_offset_h: Some(utc_offset_h), ..request(40.0, 0.0, "2026-03-20") };
        let path = path(&request);
        assert!((path.duration_min - 722.0).abs() < 12.0, "UTC{utc_offset_h:+}: {} minutes", path.duration_min);
        let noon = path.clock_min(0.5).expect("a clock");
        assert!((-6.0..1446.0).contains(&noon), "UTC{utc_offset_h:+}: noon at {noon}");
        assert_follows_ephemeris(&request);
    }
}

/// B2.
#[test]
fn a_window_across_midnight_is_one_path() {
    let request = DayRequest { window: Some([1320.0, 120.0]), ..request(70.0, 25.0, "2028-02-29") };
    let Err(DayError::DarkWindow { window, .. }) = day(&request) else { panic!("the sun is down in February") };
    assert_eq!(window, "22:00 to 02:00");
    let request = DayRequest { date: "2026-06-30".parse().expect("a date"), ..request };
    let path = path(&request);
    assert_eq!(path.duration_min, 240.0);
    assert_eq!(path.local_text(0.0).as_deref(), Some("2026-06-30T22:00:00"));
    assert_eq!(path.local_text(1.0).as_deref(), Some("2026-07-01T02:00:00"));
    assert_eq!(path.utc_text(1.0).as_deref(), Some("2026-07-01T00:00:00"));
    assert_eq!(path.clock_text(0.75).as_deref(), Some("01:00"));
    assert_eq!(path.t_at_clock_min(60.0), Some(0.75));
    assert!(path.t_at_clock_min(720.0).is_none());
    assert_follows_ephemeris(&request);
}

#[test]
fn windows_of_a_whole_turn_at_an_equinox_follow_the_ephemeris() {
    let mut worst = 0.0f64;
    for latitude in [-80.0, -45.0, 0.0, 30.0, 60.0] {
        for start in [0.0, 400.0, 720.0, 1100.0] {
            for date in ["2026-03-20", "2026-09-23"] {
                let request = DayRequest { window: Some([start, start]), ..request(latitude, 0.0, date) };
                assert_follows_ephemeris(&request);
                worst = worst.max(path(&request).day.expect("a day").ephemeris_error_deg);
            }
        }
    }
    println!("worst {worst} degrees");
}

#[test]
fn a_dark_window_says_when_the_sun_is_up() {
    let request =
        DayRequest { window: Some([60.0, 120.0]), utc_offset_h: Some(1.0), ..request(51.5, 0.0, "2026-06-21") };
    let message = day(&request).expect_err("it is night").to_string();
    assert!(message.contains("01:00 to 02:00") && message.contains("from 04:50 to 21:14"), "{message}");
}

#[test]
fn random_places_dates_and_windows_follow_the_ephemeris() {
    let mut random = Random::new(7);
    let mut followed = 0;
    for _ in 0..150 {
        let date = format!(
            "{:04}-{:02}-{:02}",
            random.range(1900.0, 2100.0) as u32,
            random.range(1.0, 13.0) as u32,
            random.range(1.0, 29.0) as u32
        );
        let start = random.range(0.0, 1440.0);
        let length = [0.02, 1.0, 45.0, 600.0, 1440.0][random.range(0.0, 5.0) as usize];
        let request = DayRequest {
            north_deg: random.range(-360.0, 360.0),
            window: Some([start, if length == 1440.0 { start } else { (start + length) % 1440.0 }]),
            ..request(random.range(-90.0, 90.0), random.range(-180.0, 180.0), &date)
        };
        match day(&request) {
            Ok(DayOutcome::Path(_)) => {
                assert_follows_ephemeris(&request);
                followed += 1;
            }
            Ok(DayOutcome::NoSun { .. }) | Err(DayError::DarkWindow { .. }) => {}
            Err(error) => panic!("{request:?}: {error}"),
        }
    }
    assert!(followed > 80, "only {followed} had sun");
}

#[test]
fn requests_off_the_globe_are_refused_with_what_to_give() {
    let good = request(0.0, 0.0, "2026-06-21");
    let bad = [f64::NAN, f64::INFINITY, -1e9];
    for value in bad.into_iter().chain([95.0]) {
        let message = day(&DayRequest { latitude_deg: value, ..good.clone() }).expect_err("off the globe").to_string();
        assert!(message.contains("-90..=90") && message.contains(&value.to_string()), "{message}");
    }
    for value in bad.into_iter().chain([181.0]) {
        assert!(matches!(day(&DayRequest { longitude_deg: value, ..good.clone() }), Err(DayError::Longitude(_))));
        assert!(matches!(day(&DayRequest { utc_offset_h: Some(value), ..good.clone() }), Err(DayError::UtcOffset(_))));
        let window = Some([0.0, if value > 0.0 { 1441.0 } else { value }]);
        assert!(matches!(day(&DayRequest { window, ..good.clone() }), Err(DayError::Window(..))));
    }
    let window = Some([700.0, 700.0 + 1e-12]);
    let message = day(&DayRequest { window, ..good }).expect_err("too short").to_string();
    assert!(message.contains("at least a second apart"), "{message}");
    for value in [f64::NAN, f64::INFINITY] {
        assert!(matches!(day(&DayRequest { north_deg: value, ..good.clone() }), Err(DayError::North(_))));
    }
}

#[test]
fn offsets_from_utc_are_hours_or_hours_and_minutes() {
    let good =
        [("5:45", 5.75), ("+05:30", 5.5), ("-3:30", -3.5), ("-0:30", -0.5), ("5.75", 5.75), ("-8", -8.0), ("0", 0.0)];
    for (text, hours) in good {
        assert_eq!(parse_utc_offset(text), Ok(hours), "{text}");
    }
    for text in ["", ":", "5:", ":45", "5:60", "5:4x", "5:-45", "--5:45", "005:45", "NaN", "inf", "CET", "5:45:00"] {
        let message = parse_utc_offset(text).expect_err(text);
        assert!(message.contains(&format!("`{text}`")) && message.contains("5:45"), "{message}");
    }
}
