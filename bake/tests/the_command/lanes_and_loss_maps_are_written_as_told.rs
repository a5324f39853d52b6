//! `--lanes` and `--loss-map`: the files that they add, and the plan that says so.

use super::tools::{Desk, names};
use serde_json::Value;

fn disc_lanes(effects: &Value) -> &Value {
    effects.as_array().expect("a list").iter().find(|e| e["effect"] == "disc-lanes").expect("in every plan")
}

#[test]
fn three_lanes_write_three_times_the_textures() {
    let desk = Desk::new();
    let manifest = desk.bake(&["--place=40,0", "--lanes=3", "--json"]).ok().json();
    let lanes = manifest["atlases"][0]["lanes"].as_array().expect("lanes");
    let weights: Vec<f64> = lanes.iter().map(|lane| lane["weight"].as_f64().expect("a number")).collect();
    assert_eq!((lanes.len(), weights.iter().sum::<f64>()), (3, 1.0));
    // The floor is lit all day, so each lane has one layer: a rise and a fall.
    let lane_files = (0..3).flat_map(|k| ["fall", "rise"].map(|what| format!("page0_lane{k}_layer0_{what}.png")));
    let expected: Vec<String> = lane_files.chain(["scene.glb".into(), "sunbake.json".into()]).collect();
    assert_eq!(names(&desk.path("out/set")), expected);
    assert_eq!(disc_lanes(&manifest["effects"])["on"], true);
    let told = desk.run(&["inspect", "out/set"]).ok().stdout;
    assert!(told.contains("1 layer in each of 3 lanes; 1.00 intervals a texel and lane, 1 at most"), "{told}");
    let texel = desk.run(&["texels", "out/set", "--count=1"]).ok().json();
    assert_eq!((texel["lanes"].as_array().map(Vec::len), &texel["lit"]), (Some(3), &texel["lanes"][1]["lit"]));
    assert_eq!(texel["lanes"][1]["offset_deg"], 0.0);
}

#[test]
fn a_light_without_width_has_one_lane_whatever_is_asked() {
    let desk = Desk::new();
    let keys =
        r#"{"keys": [{"azimuth_deg": 90, "elevation_deg": 5}, {"direction": [0, 1, 0]}], "angular_radius_deg": 0}"#;
    desk.write("path.json", keys.as_bytes());
    let manifest = desk.bake(&["--path=path.json", "--lanes=5", "--json"]).ok().json();
    assert_eq!(manifest["atlases"][0]["lanes"].as_array().map(Vec::len), Some(1));
    let verdict = disc_lanes(&manifest["effects"]);
    assert!(verdict["on"] == false && verdict["why"].as_str().is_some_and(|why| why.contains("without width")));
}

#[test]
fn the_plan_says_why_there_are_lanes_or_are_not() {
    let desk = Desk::new();
    for (lanes, on) in [("--lanes=1", false), ("--lanes=5", true)] {
        let plan = desk.run(&["bake", "floor.glb", "--explain", "--json", lanes]).ok().json();
        let verdict = disc_lanes(&plan);
        assert!(verdict["on"] == on && verdict["why"].as_str().is_some_and(|why| why.contains("--lanes")), "{plan}");
    }
}

#[test]
fn lanes_count_against_the_memory_that_is_allowed() {
    let desk = Desk::new();
    let arguments = ["bake", "floor.glb", "-o", "out/set", "--size=4096", "--max-memory=4G", "--lanes=5"];
    desk.run(&arguments).fails("five lanes", 3, &["in 5 lanes", "--lanes", "--max-memory"]);
}
