//! `--lamp`, and `--path` with positions: what they add to a set, and which values are refused.

use super::tools::{Desk, names};
use serde_json::{Value, json};

/// Rises through the floor at t = 0.25.
const RISING: &str = r#"{"radius_m": 0.1, "duration_min": 8, "keys": [
    {"t": 0, "position": [0.5, -1, 0.5]}, {"t": 0.5, "position": [0.5, 1, 0.5]},
    {"t": 1, "position": [0.5, 2, 0.5]}]}"#;

const EXACT: [&str; 6] = ["bake", "floor.glb", "-o", "out/set", "--preset=draft", "--size=64"];

fn desk() -> Desk {
    let desk = Desk::new();
    desk.write("lamp.json", RISING.as_bytes());
    desk.write("sun.json", br#"{"keys": [{"azimuth_deg": 90, "elevation_deg": 5}, {"direction": [0, 1, 0]}]}"#);
    desk
}

fn effect<'a>(manifest: &'a Value, name: &str) -> &'a Value {
    let effects = manifest.as_array().or(manifest["effects"].as_array()).expect("a list");
    effects.iter().find(|e| e["effect"] == name).expect("in every plan")
}

#[test]
fn a_set_may_hold_a_lamp_and_no_sun() {
    let desk = desk();
    for engine in ["--engine=exact", "--engine=rays:64"] {
        let arguments = [&EXACT[..], &["--path=lamp.json", "--bits=16", "--json", "--force", engine]].concat();
        let manifest = desk.run(&arguments).ok().json();
        assert_eq!((&manifest["path"], &manifest["atlases"][0]["lanes"]), (&json!(null), &json!([])));
        assert_eq!(manifest["lamp"]["duration_min"], 8.0);
        assert_eq!(manifest["lamp"]["keys"][1], json!({"t": 0.5, "position": [0.5, 1.0, 0.5]}));
        assert_eq!(manifest["lamp"]["stats"]["most_intervals"], 1);
        assert_eq!(
            (&effect(&manifest, "sun-intervals")["on"], &effect(&manifest, "lamp-intervals")["on"]),
            (&json!(false), &json!(true))
        );
        let files =
            ["page0_ao.png", "page0_lamp_layer0_fall.png", "page0_lamp_layer0_rise.png", "scene.glb", "sunbake.json"];
        assert_eq!(names(&desk.path("out/set")), files);
        let texel = desk.run(&["texels", "out/set", "--count=1"]).ok().json();
        assert_eq!((&texel["lit"], texel["lamp"].as_array().map(Vec::len)), (&json!([]), Some(1)));
        let [start, end] = [0, 1].map(|k| texel["lamp"][0][k].as_f64().expect("a time"));
        assert!((start - 0.25).abs() <= 0.5 / 65_535.0 && end == 1.0, "{start} {end}");
    }
    let told = desk.run(&["inspect", "out/set"]).ok().stdout;
    assert!(told.contains("3 keys, 3.00 m in 8 minutes, a sphere of radius 0.1 m"), "{told}");
    assert!(told.contains("1 layer; 1.00 intervals a texel, 1 at most; found by rays:64"), "{told}");
    assert!(!told.contains("it does not rise"), "{told}");
}

#[test]
fn a_lamp_beside_the_sun_leaves_the_suns_maps_unchanged() {
    let desk = desk();
    let alone = desk.run(&[&EXACT[..], &["--place=40,0", "--json"]].concat()).ok().json();
    let rise = std::fs::read(desk.path("out/set/page0_lane0_layer0_rise.png")).expect("a texture");
    let manifest = desk
        .run(&[&EXACT[..], &["--place=40,0", "--lamp=lamp.json", "--loss-map", "--json", "--force"]].concat())
        .ok()
        .json();
    assert_eq!(manifest["lamp"]["duration_min"], manifest["path"]["duration_min"]);
    assert_eq!(manifest["stats"]["intervals"], alone["stats"]["intervals"]);
    assert_eq!(std::fs::read(desk.path("out/set/page0_lane0_layer0_rise.png")).expect("a texture"), rise);
    let lamp_files = names(&desk.path("out/set")).into_iter().filter(|name| name.contains("lamp")).count();
    assert_eq!(lamp_files, 2);
    assert!(alone.get("lamp").is_none() && alone["atlases"][0].get("lamp").is_none(), "nothing of a lamp");
    assert_eq!(effect(&alone, "lamp-intervals")["on"], false);
    let texel = desk.run(&["texels", "out/set", "--count=1"]).ok().json();
    assert!(texel["lit"].as_array().is_some_and(|lit| lit.len() == 1) && texel["lamp"].is_array());
}

#[test]
fn a_plan_says_what_a_lamp_adds() {
    let desk = desk();
    let plan = |more: &[&str]| desk.run(&[&["bake", "floor.glb", "--explain"], more].concat()).ok();
    let with = plan(&["--lamp=lamp.json", "--json"]).json();
    assert!(effect(&with, "lamp-intervals")["why"].as_str().is_some_and(|why| why.contains("2 straight segments")));
    let without = plan(&["--json"]).json();
    assert!(effect(&without, "lamp-intervals")["why"].as_str().is_some_and(|why| why.contains("--lamp")));
    assert!(plan(&["--path=lamp.json"]).stdout.contains("3 keys"));
    assert!(!plan(&[]).stdout.contains("keys,"));
}

#[test]
fn invalid_lamps_are_refused() {
    let desk = desk();
    desk.write("one.json", br#"{"keys": [{"position": [0, 1, 0]}]}"#);
    desk.write("still.json", br#"{"keys": [{"position": [0, 1, 0]}, {"position": [0, 1, 0]}]}"#);
    desk.write("mixed.json", br#"{"keys": [{"position": [0, 1, 0]}, {"direction": [0, 1, 0]}]}"#);
    desk.write("list.json", br#"{"positions": [[0, 1, 0], [1, 1, 0]]}"#);
    let run = |more: &[&str]| desk.run(&[&EXACT[..], more].concat());
    run(&["--path=one.json"]).fails("one key", 3, &["one.json: ", "1 key: give 2 to"]);
    run(&["--lamp=still.json"]).fails("no motion", 3, &["still.json: ", "keys 0 and 1", "does not move"]);
    run(&["--path=mixed.json"]).fails("mixed", 3, &["mixed.json: ", "key 1", "give every key a 'position'"]);
    run(&["--path=list.json"]).fails("a list", 3, &["'position' in every key"]);
    run(&["--lamp=sun.json"]).fails("a sun", 3, &["sun.json: ", "key 0", "'position'"]);
    run(&["--lamp=none.json"]).fails("no file", 2, &["none.json", "--lamp"]);
    run(&["--path=lamp.json", "--lamp=lamp.json"]).fails("two lamps", 1, &["both bring a lamp", "--lamp or --path"]);
    run(&["--lamp=lamp.json", "--engine=bisect:64"]).fails("bisection", 1, &["bisect:64", "rays:N"]);
    assert!(desk.left().is_empty());
}

#[test]
fn a_lamp_counts_against_the_memory_limit() {
    let desk = desk();
    let arguments = ["bake", "floor.glb", "-o", "out/set", "--size=8192", "--max-memory=15G", "--lamp=lamp.json"];
    desk.run(&arguments).fails("a lamp", 3, &["with a lamp", "--size", "--max-memory"]);
}
