//! What is said of scenes and wishes that leave nothing, or less than asked, to work with.

use super::tools::{Desk, floor, floor_bytes, glb};
use serde_json::{Value, json};

/// A draft of a scene, with further arguments.
const DRAFT: [&str; 8] =
    ["bake", "scene.glb", "-o", "out/set", "--preset=draft", "--size=64", "--engine=rays:16", "--threads=1"];

/// A desk with the floor, changed, as `scene.glb`.
fn desk(change: impl FnOnce(&mut Value)) -> Desk {
    let desk = Desk::new();
    let mut json = floor();
    change(&mut json);
    desk.write("scene.glb", &glb(&json, &floor_bytes()));
    desk
}

#[test]
fn a_scene_that_is_left_out_whole_bakes_with_a_warning() {
    let desk = desk(|json| json["nodes"][0]["name"] = "ground".into());
    for (options, words) in [
        (["--leave-out", "*"], ["warning: everything is left out", "give fewer --leave-out"]),
        (["--no-receive", "ground"], ["warning: nothing takes shadows", "give fewer --no-receive or --leave-out"]),
    ] {
        let run = desk.run(&[&DRAFT[..], &["--force", "--json"], &options].concat()).ok();
        assert_eq!(run.json()["stats"]["texels"], 0, "{options:?}");
        assert!(words.iter().all(|word| run.stderr.contains(word)), "{options:?}: {}", run.stderr);
        assert_eq!(run.stderr.lines().count(), 1, "{options:?}: {}", run.stderr);
    }
}

#[test]
fn names_that_draw_nothing_are_told_from_names_that_are_not_there() {
    let desk = desk(|json| {
        let nodes = json["nodes"].as_array_mut().expect("nodes");
        nodes.push(json!({ "name": "empty" }));
        json["scenes"][0]["nodes"] = json!([0, 1]);
    });
    for (name, words) in [
        ("node:99", ["no node:99 to free of its shadow", "it has 2 nodes, node:0 to node:1"]),
        ("mesh:1", ["no mesh:1 to free of its shadow", "it has 1 mesh, mesh:0"]),
        ("material:0", ["no material:0 to free of its shadow", "it has no materials"]),
        ("node:1", ["nothing is drawn of \"node:1\"", "another --no-cast"]),
        ("empty", ["nothing is drawn of \"empty\"", "another --no-cast"]),
        ("ghost", ["no material, node or mesh named \"ghost\"", "another --no-cast"]),
    ] {
        let run = desk.run(&[&DRAFT[..], &["--no-cast", name]].concat());
        run.fails(name, 1, &words);
        run.fails(name, 1, &["list the names with `sunbake inspect SCENE`"]);
    }
}

#[test]
fn a_scene_without_triangles_has_nothing_to_bake() {
    for mode in [0, 1] {
        let desk = desk(|json| json["meshes"][0]["primitives"][0]["mode"] = mode.into());
        let words = ["draws no triangles, so there is nothing to bake", "points and lines cast no shadow"];
        desk.run(&DRAFT).fails("no triangles", 3, &words);
        assert!(desk.left().is_empty());
    }
}

#[test]
fn names_are_listed_where_a_picture_lies_elsewhere() {
    let desk = desk(|json| {
        json["nodes"][0]["name"] = "ground".into();
        json["images"] = json!([{ "uri": "../textures/brick.png" }]);
        json["textures"] = json!([{ "source": 0 }]);
        json["materials"] = json!([{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }]);
        json["meshes"][0]["primitives"][0]["material"] = 0.into();
    });
    desk.run(&DRAFT).fails("a bake", 3, &["images[0]", "../textures/brick.png"]);
    let run = desk.run(&["inspect", "scene.glb"]).ok();
    assert!(run.stdout.contains("ground") && run.stdout.contains("material:0"), "{}", run.stdout);
    assert!(run.stderr.starts_with("warning: images[0] names \"../textures/brick.png\""), "{}", run.stderr);
    assert_eq!(run.stderr.lines().count(), 1, "{}", run.stderr);
    assert_eq!(desk.run(&["inspect", "scene.glb", "--json"]).ok().json()["nodes"][0]["name"], "ground");
}

#[test]
fn north_is_told_to_do_nothing_where_the_scenes_own_light_is_the_sun() {
    let desk = desk(|json| {
        json["extensions"] = json!({ "KHR_lights_punctual": { "lights": [{ "type": "directional" }] } });
        let down = [-0.5f64.sqrt(), 0.0, 0.0, 0.5f64.sqrt()];
        let light = json!({ "rotation": down, "extensions": { "KHR_lights_punctual": { "light": 0 } } });
        json["nodes"].as_array_mut().expect("nodes").push(light);
        json["scenes"][0]["nodes"] = json!([0, 1]);
    });
    let said = |more: &[&str]| desk.run(&[&DRAFT[..], &["--force"], more].concat()).ok().stderr;
    let north = said(&["--north=30"]);
    assert!(north.contains("north turned by 30 degrees") && north.contains("give --place LAT,LON"), "{north}");
    assert_eq!((said(&[]), said(&["--north=30", "--place=40,0"])), (String::new(), String::new()));
}
