//! B2: polar day and night, the poles, the equator at equinox, the date line, a leap day, a window across midnight.

use super::tools::Desk;
use serde_json::{Value, json};

/// Bakes the floor for a day, and gives the manifest.
fn day(options: &[&str]) -> Value {
    let run = Desk::new().bake(&[options, &["--json"]].concat()).ok();
    assert!(run.stderr.is_empty(), "{options:?}: {}", run.stderr);
    run.json()
}

fn minutes(manifest: &Value) -> f64 {
    manifest["path"]["duration_min"].as_f64().expect("a path")
}

/// B2.
#[test]
fn days_without_sunset_last_24_hours() {
    for (place, date) in [("80,20", "2026-06-21"), ("90,0", "2026-06-21"), ("-90,0", "2026-12-21")] {
        let manifest = day(&["--place", place, "--date", date]);
        assert_eq!(minutes(&manifest), 1440.0, "{place}");
        let error_deg = manifest["path"]["ephemeris_error_deg"].as_f64().expect("an error");
        assert!(error_deg < 0.02, "{place}: {error_deg}");
    }
}

/// B2.
#[test]
fn days_without_sunrise_bake_without_a_sun() {
    for (place, date) in [("80,20", "2026-12-21"), ("90,0", "2026-12-21"), ("-90,0", "2026-06-21")] {
        let desk = Desk::new();
        let run = desk.bake(&["--place", place, "--date", date]).ok();
        assert!(run.stderr.starts_with("warning: the sun does not rise at latitude"), "{}", run.stderr);
        assert!(run.stderr.contains("another --date") && run.stderr.lines().count() == 1, "{}", run.stderr);
        let manifest = desk.run(&["inspect", "out/set", "--json"]).ok().json();
        assert_eq!((&manifest["path"], &manifest["atlases"][0]["lanes"]), (&Value::Null, &json!([])));
        assert_eq!(manifest["effects"][0]["on"], false);
        assert!(desk.run(&["inspect", "out/set"]).ok().stdout.contains("does not rise"));
        let texels = desk.run(&["texels", "out/set", "--count", "3"]).ok().stdout;
        assert_eq!(texels.lines().count(), 3);
        assert!(texels.lines().all(|line| line.contains("\"lit\":[]")), "{texels}");
    }
}

/// B2.
#[test]
fn the_equator_at_equinox_has_twelve_hours() {
    let manifest = day(&["--place", "0,0", "--date", "2026-03-20"]);
    assert!((minutes(&manifest) - 720.0).abs() < 1.0, "{}", minutes(&manifest));
}

/// B2.
#[test]
fn both_sides_of_the_date_line_are_a_day_apart() {
    let start = |place| day(&["--place", place, "--date", "2026-06-21"])["path"]["utc"][0].as_str().unwrap().to_owned();
    let [west, east] = [start("0,180"), start("0,-180")];
    assert!(west.starts_with("2026-06-20T18:") && east.starts_with("2026-06-21T18:"), "{west} {east}");
}

/// B2.
#[test]
fn a_leap_day_is_a_day() {
    let manifest = day(&["--place", "48,16", "--date", "2028-02-29", "--utc-offset", "1"]);
    assert_eq!(manifest["path"]["date"], "2028-02-29");
    assert!((600.0..700.0).contains(&minutes(&manifest)));
}

/// B2.
#[test]
fn a_window_may_cross_midnight() {
    let manifest =
        day(&["--place", "69.65,18.96", "--date", "2026-06-21", "--utc-offset", "2", "--window", "22:00-02:00"]);
    assert_eq!(minutes(&manifest), 240.0);
    assert_eq!(manifest["path"]["local"], json!(["2026-06-21T22:00:00", "2026-06-22T02:00:00"]));
    let manifest = day(&["--window", "23:00-06:00"]);
    let whole = day(&["--window", "08:00-08:00"]);
    assert_eq!(minutes(&whole), 1440.0, "equal times are a whole day");
    assert_eq!(minutes(&manifest), 420.0, "dark until the next day's sunrise, and no failure");
}
