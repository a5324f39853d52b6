//! `--lanes` and `--loss-map`: the files that they add, and the plan that says so.

use super::tools::{Desk, floor, floor_bytes, glb, names};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::Path;

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
    let ao = std::iter::once("page0_ao.png".to_owned());
    let expected: Vec<String> = ao.chain(lane_files).chain(["scene.glb".into(), "sunbake.json".into()]).collect();
    assert_eq!(names(&desk.path("out/set")), expected);
    assert_eq!(disc_lanes(&manifest["effects"])["on"], true);
    let told = desk.run(&["inspect", "out/set"]).ok().stdout;
    assert!(told.contains("1 layer in each of 3 lanes; 1.00 intervals a texel and lane, 1 at most"), "{told}");
    let texel = desk.run(&["texels", "out/set", "--count=1"]).ok().json();
    assert_eq!((texel["lanes"].as_array().map(Vec::len), &texel["lit"]), (Some(3), &texel["lanes"][1]["lit"]));
    assert_eq!(texel["lanes"][1]["offset_deg"], 0.0);
}

#[test]
fn a_light_without_width_has_one_lane() {
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
fn the_plan_says_why_lanes_are_on_or_off() {
    let desk = Desk::new();
    for (lanes, on) in [("--lanes=1", false), ("--lanes=5", true)] {
        let plan = desk.run(&["bake", "floor.glb", "--explain", "--json", lanes]).ok().json();
        let verdict = disc_lanes(&plan);
        assert!(verdict["on"] == on && verdict["why"].as_str().is_some_and(|why| why.contains("--lanes")), "{plan}");
    }
}

#[test]
fn lanes_count_against_the_memory_limit() {
    let desk = Desk::new();
    let arguments = ["bake", "floor.glb", "-o", "out/set", "--size=4096", "--max-memory=4G", "--lanes=5"];
    desk.run(&arguments).fails("five lanes", 3, &["in 5 lanes", "--lanes", "--max-memory"]);
}

/// Five posts in front of a floor of half a metre: texels behind them are lit in more than four pieces.
fn fence() -> Vec<u8> {
    let mut json = floor();
    let mut positions = vec![];
    for x in 0..6 {
        let (x, width) = (x as f32 * 0.16, 0.08);
        positions.extend([[x, 0.0, 1.0], [x + width, 0.0, 1.0], [x, 2.0, 1.0], [x + width, 2.0, 1.0]]);
    }
    let posts = positions.len();
    let indices = (0..posts as u16 / 4).flat_map(|post| [0, 1, 2, 2, 1, 3].map(|corner| 4 * post + corner));
    let mut bytes = floor_bytes();
    let (first, count) = (bytes.len(), posts / 4 * 6);
    bytes.extend(positions.iter().flatten().flat_map(|x: &f32| x.to_le_bytes()));
    bytes.extend(indices.flat_map(u16::to_le_bytes));
    json["buffers"][0]["byteLength"] = bytes.len().into();
    let views = json["bufferViews"].as_array_mut().expect("a list");
    views.push(json!({ "buffer": 0, "byteOffset": first, "byteLength": 12 * posts }));
    views.push(json!({ "buffer": 0, "byteOffset": first + 12 * posts, "byteLength": 2 * count }));
    let accessors = json["accessors"].as_array_mut().expect("a list");
    let (min, max) = ([0.0, 0.0, 1.0], [0.88, 2.0, 1.0]);
    accessors.push(
        json!({ "bufferView": 2, "componentType": 5126, "count": posts, "type": "VEC3", "min": min, "max": max }),
    );
    accessors.push(json!({ "bufferView": 3, "componentType": 5123, "count": count, "type": "SCALAR" }));
    json["meshes"][0]["primitives"]
        .as_array_mut()
        .expect("a list")
        .push(json!({ "attributes": { "POSITION": 2 }, "indices": 3 }));
    glb(&json, &bytes)
}

#[test]
fn a_second_layer_is_written_where_texels_need_it() {
    let desk = Desk::new();
    desk.write("fence.glb", &fence());
    let usual =
        ["bake", "fence.glb", "-o", "out/set", "--place=40,0", "--date=2026-12-21", "--size=128", "--only=intervals"];
    for (cap, layers, says) in [("--layers=1", 1, "merged"), ("--layers=4", 2, "more than four intervals: 2 layers")] {
        let manifest = desk.run(&[&usual[..], &[cap, "--json", "--force"]].concat()).ok().json();
        let found = manifest["atlases"][0]["lanes"][0]["layers"].as_array().map(Vec::len);
        let effects = manifest["effects"].as_array().expect("a list");
        let effect = effects.iter().find(|e| e["effect"] == "several-layers").expect("in every plan");
        assert_eq!((found, &effect["on"]), (Some(layers), &json!(layers > 1)), "{effect}");
        assert!(effect["why"].as_str().is_some_and(|why| why.contains(says)), "{effect}");
    }
}

/// The channels of a loss map, by name.
fn minutes(file: &Path) -> BTreeMap<String, Vec<f32>> {
    let image = exr::prelude::read_first_flat_layer_from_file(file).expect("an OpenEXR file");
    let channel = |channel: &exr::prelude::AnyChannel<exr::prelude::FlatSamples>| {
        (channel.name.to_string(), channel.sample_data.values_as_f32().collect())
    };
    image.layer_data.channel_data.list.iter().map(channel).collect()
}

#[test]
fn a_loss_map_holds_the_minutes_that_the_manifest_counts() {
    let desk = Desk::new();
    desk.write("fence.glb", &fence());
    let winter = ["--place=40,0", "--date=2026-12-21"];
    let cost = ["--layers=1", "--bits=8", "--size=128", "--engine=rays:512", "--lanes=3", "--loss-map", "--json"];
    let arguments = [&["bake", "fence.glb", "-o", "out/set"][..], &winter, &cost].concat();
    let manifest = desk.run(&arguments).ok().json();
    let page = &manifest["atlases"][0];
    let width = page["width"].as_u64().expect("a number");
    let found = minutes(&desk.path("out/set/lost_minutes.0.exr"));
    assert_eq!(found.keys().collect::<Vec<_>>(), ["bits", "layers"]);
    for (channel, told) in [("layers", "merge_min"), ("bits", "quantisation_min")] {
        let (values, told) = (&found[channel], &manifest["error"][told]);
        let worst = values.iter().copied().fold(0.0, f32::max);
        assert!(worst > 0.0 && worst == told["worst"].as_f64().expect("a number") as f32, "{channel}: {worst}");
        let at: Vec<u64> = told["worst_at"].as_array().expect("a place").iter().filter_map(Value::as_u64).collect();
        assert_eq!((at[0], values[(at[2] * width + at[1]) as usize]), (0, worst), "{channel}");
        let texels = manifest["stats"]["texels"].as_f64().expect("a number");
        let mean = values.iter().map(|&v| f64::from(v)).sum::<f64>() / texels;
        assert!((mean / told["mean"].as_f64().expect("a number") - 1.0).abs() < 1e-6, "{channel}: {mean}");
    }
    let merged = found["layers"].iter().filter(|v| **v > 0.0).count() as u64;
    assert_eq!(manifest["error"]["merged_texels"], merged);
    let picture = image::open(desk.path("out/set/lost_minutes.0.png")).expect("a picture").into_rgba8();
    let covered = picture.pixels().filter(|pixel| pixel.0[3] == 255).count() as u64;
    assert_eq!(manifest["stats"]["texels"], covered);
    let worst = found["layers"].iter().zip(&found["bits"]).map(|(a, b)| a + b).fold(0.0, f32::max);
    let scale = page["loss_map"]["scale_max_min"].as_f64().expect("a number");
    assert!((0.4 * scale..=scale).contains(&f64::from(worst)), "{worst} of {scale}");
}

#[test]
fn a_loss_map_is_written_only_on_request() {
    let desk = Desk::new();
    let plain = desk.bake(&["--json"]).ok().json();
    assert_eq!(plain["atlases"][0].get("loss_map"), None);
    let maps =
        ["page0_ao.png", "page0_lane0_layer0_fall.png", "page0_lane0_layer0_rise.png", "scene.glb", "sunbake.json"];
    assert_eq!(names(&desk.path("out/set")), maps);
    let told = desk.bake(&["--loss-map", "--force"]).ok().stdout;
    assert!(told.contains("lost_minutes.0.png (brightest: "), "{told}");
    let lost = ["lost_minutes.0.exr", "lost_minutes.0.png"];
    assert_eq!(names(&desk.path("out/set")), [&lost[..], &maps].concat());
}
