//! Bad input, case by case: one line that names the cause and the next step, the right exit code, and no files left.

use super::tools::{Desk, Run, floor, floor_bytes, gas_station, glb};
use serde_json::{Value, json};
use std::time::{Duration, Instant};

/// The longest time that a refusal may take.
const PATIENCE: Duration = Duration::from_secs(20);

/// The floor with something changed.
fn changed(pointer: &str, value: Value) -> Vec<u8> {
    let mut json = floor();
    let (parent, key) = pointer.rsplit_once('/').expect("a pointer");
    match json.pointer_mut(parent).expect("its parent") {
        Value::Array(list) => list[key.parse::<usize>().expect("an index")] = value,
        other => other[key] = value,
    }
    glb(&json, &floor_bytes())
}

fn with_positions(bad: f32, vertices: usize) -> Vec<u8> {
    let mut bytes = floor_bytes();
    (0..vertices).for_each(|v| bytes[v * 12..v * 12 + 4].copy_from_slice(&bad.to_le_bytes()));
    glb(&floor(), &bytes)
}

/// The floor with its buffer elsewhere.
fn with_buffer(uri: &str) -> Vec<u8> {
    let mut json = floor();
    json["buffers"][0]["uri"] = uri.into();
    json.to_string().into_bytes()
}

/// The floor with a material whose image is this.
fn with_image(alpha_mode: &str, image: &[u8]) -> Vec<u8> {
    let (mut json, mut bytes) = (floor(), floor_bytes());
    let at = bytes.len();
    bytes.extend(image);
    json["buffers"][0]["byteLength"] = bytes.len().into();
    let view = json!({ "buffer": 0, "byteOffset": at, "byteLength": image.len() });
    json["bufferViews"].as_array_mut().unwrap().push(view);
    json["images"] = json!([{ "bufferView": 2, "mimeType": "image/png" }]);
    json["textures"] = json!([{ "source": 0 }]);
    let color = json!({ "baseColorTexture": { "index": 0 } });
    json["materials"] = json!([{ "alphaMode": alpha_mode, "pbrMetallicRoughness": color }]);
    json["meshes"][0]["primitives"][0]["material"] = 0.into();
    json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = 2.into();
    let coordinates = json!({ "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC2" });
    json["accessors"].as_array_mut().unwrap().push(coordinates);
    glb(&json, &bytes)
}

fn refused_scenes() -> Vec<(&'static str, Vec<u8>, &'static [&'static str])> {
    let whole = glb(&floor(), &floor_bytes());
    let huge = json!({ "componentType": 5126, "count": 1_000_000_000, "type": "VEC3" });
    vec![
        ("an empty file", Vec::new(), &["not a glTF scene", "it is empty", "export"]),
        ("a text", b"hello".to_vec(), &["not a glTF scene", "export"]),
        ("broken JSON", b"{\"asset\": }".to_vec(), &["line 1", "column"]),
        ("a GLB cut in its header", whole[..9].to_vec(), &["damaged", "again"]),
        ("a GLB cut in its data", whole[..whole.len() - 8].to_vec(), &["damaged", "declares", "again"]),
        ("glTF 1", changed("/asset/version", json!("1.0")), &["glTF 1.0", "convert"]),
        ("a short buffer", changed("/accessors/0/count", json!(5)), &["accessors[0]", "which has 48"]),
        ("an index out of range", changed("/accessors/0/count", json!(3)), &["it has only 3 vertices"]),
        ("a mesh that is not there", changed("/nodes/0/mesh", json!(7)), &["7"]),
        ("nothing finite", with_positions(f32::NAN, 4), &["draws no triangles", "2 of its triangles are not finite"]),
        ("nothing near", with_positions(f32::INFINITY, 4), &["draws no triangles", "not finite"]),
        ("no nodes", changed("/scenes/0/nodes", json!([])), &["draws no triangles", "put its meshes under nodes"]),
        ("a node above itself", changed("/nodes/0/children", json!([0])), &["its own ancestor", "remove it"]),
        ("a flat matrix", changed("/nodes/0/scale", json!([0, 1, 1])), &["draws no triangles"]),
        ("1e9 vertices, stored", changed("/accessors/0/count", json!(1_000_000_000)), &["accessors[0]"]),
        ("1e9 vertices, all zero", changed("/accessors/0", huge), &["--max-memory"]),
        ("a leaf's image that is none", with_image("MASK", b"no image"), &["alpha", "replace the image"]),
        (
            "an extension",
            changed("/extensionsRequired", json!(["EXT_meshopt_compression"])),
            &["EXT_meshopt_compression"],
        ),
        ("an extension of nobody", changed("/extensionsRequired", json!(["ACME_x"])), &["ACME_x"]),
    ]
}

#[test]
fn a_scene_that_cannot_be_baked_is_refused() {
    for (name, bytes, words) in refused_scenes() {
        let desk = Desk::new();
        desk.write("bad.glb", &bytes);
        let started = Instant::now();
        desk.run(&["bake", "bad.glb", "-o", "out/set"]).fails(name, 3, words);
        assert!(started.elapsed() < PATIENCE, "{name} took {:?}", started.elapsed());
        assert!(desk.left().is_empty(), "{name} left {:?}", desk.left());
    }
}

#[test]
fn a_scene_opens_nothing_outside_its_own_folder() {
    for uri in ["../secret.bin", "/etc/passwd", "http://example.org/x.bin", "file:///etc/passwd", "a/../../x.bin"] {
        let desk = Desk::new();
        desk.write("bad.gltf", &with_buffer(uri));
        desk.run(&["bake", "bad.gltf", "-o", "out/set"]).fails(uri, 3, &[uri, "own folder", "relative path"]);
        assert!(desk.left().is_empty());
    }
}

#[test]
fn missing_files_are_named() {
    let desk = Desk::new();
    desk.write("gone.gltf", &with_buffer("gone.bin"));
    desk.write("keys.json", b"[");
    let cases: [(&[&str], i32, &[&str]); 9] = [
        (&["bake", "nowhere.glb", "-o", "out/set"], 2, &["cannot read nowhere.glb", "check the path"]),
        (&["bake", "out", "-o", "out/set"], 2, &["cannot read out", "it is a folder"]),
        (&["bake", "gone.gltf", "-o", "out/set"], 2, &["gone.bin", "put it back"]),
        (&["bake", "floor.glb", "-o", "out/set", "--path", "no.json"], 2, &["no.json", "--path"]),
        (&["bake", "floor.glb", "-o", "out/set", "--path", "keys.json"], 3, &["keys.json: ", "line 1 column 1"]),
        (&["inspect", "nowhere"], 2, &["nowhere is not there", "check its name"]),
        (&["inspect", "nowhere.glb"], 2, &["nowhere.glb is not there", "check its name"]),
        (&["inspect", "out"], 2, &["out holds no sunbake.json", "check its name", "sunbake bake"]),
        (&["texels", "floor.glb"], 2, &["floor.glb is a file", "folder"]),
    ];
    for (arguments, code, words) in cases {
        desk.run(arguments).fails(&arguments.join(" "), code, words);
        assert!(desk.left().is_empty());
    }
}

#[test]
fn invalid_options_are_refused() {
    let cases: [(&[&str], i32, &[&str]); 36] = [
        (&["--place", "91,0"], 1, &["latitude 91", "-90..=90"]),
        (&["--place", "0,181"], 1, &["longitude 181", "-180..=180"]),
        (&["--place", "nan,0"], 1, &["not a place", "48.2,16.4"]),
        (&["--place", "Vienna"], 1, &["not a place", "48.2,16.4"]),
        (&["--date", "2026-02-29"], 1, &["2026-02-29 does not exist", "days 01 to 28"]),
        (&["--date", "2026-13-01"], 1, &["does not exist", "months"]),
        (&["--date", "tomorrow"], 1, &["YYYY-MM-DD"]),
        (&["--utc-offset", "15"], 1, &["UTC offset of 15", "-12..=14"]),
        (&["--utc-offset", "Vienna"], 1, &["`Vienna`", "5:45"]),
        (&["--window", "25:00-26:00"], 1, &["HH:MM"]),
        (&["--window", "22:00-23:00"], 1, &["below the horizon", "it is up from 04:36", "window"]),
        (&["--only", "sun"], 1, &["nothing to bake", "intervals", "ao"]),
        (&["--ao-rays", "100"], 1, &["no power of two", "64 or 128"]),
        (&["--ao-error", "2"], 1, &["0.001 to 0.5"]),
        (&["--ao-distance=-1"], 1, &["metres"]),
        (&["--ao-vertices", "NORMAL"], 1, &["COLOR_0 or _AO"]),
        (&["--only", "ao", "--loss-map"], 1, &["add intervals to --only"]),
        (&["--only", "intervals", "--bent"], 1, &["--bent", "add ao to --only"]),
        (&["--bits", "9"], 1, &["8 or 16"]),
        (&["--engine", "rays:1"], 1, &["2 to 65536"]),
        (&["--engine", "bisect:1"], 1, &["2 to 65536"]),
        (&["--edge-seconds", "2"], 1, &["--edge-seconds", "exact", "leave it out", "bisect:N"]),
        (&["--engine", "bisect:9", "--edge-seconds", "0"], 1, &["0.001 to 3600"]),
        (&["--padding", "16", "--size", "64"], 1, &["padding is 16", "eighth of the page"]),
        (&["--size", "16384"], 3, &["16384 x 16384", "smaller --size", "larger --max-memory"]),
        (&["--texels-per-metre", "1e6"], 3, &["for meshes[0]", "smaller --texels-per-metre", "larger --max-memory"]),
        (&["--density", "node:0=1e6"], 3, &["for meshes[0]", "smaller --density", "larger --max-memory"]),
        (&["--tracks", "--only", "ao"], 1, &["--tracks is about times", "add intervals to --only"]),
        (&["--leave-out", "ghost"], 1, &["\"ghost\" to leave out", "another --leave-out"]),
        (&["--no-cast", "ghost"], 1, &["\"ghost\" to free of its shadow", "another --no-cast"]),
        (&["--no-receive", "node:9"], 1, &["node:9", "it has 1 node, node:0", "another --no-receive"]),
        (&["--density", "floor"], 1, &["`floor` is no name with texels per metre", "NAME=X"]),
        (&["--leave-out", "node:0", "--no-cast", "node:0"], 1, &["is left out", "take one of the two wishes back"]),
        (&["--no-receive", "node:0", "--density", "node:0=4"], 1, &["no texels to give a density"]),
        (&["--density", "node:0=4", "--density", "node:0=5"], 1, &["4 and 5 texels a metre"]),
        (&["--max-memory", "1K"], 3, &["--max-memory"]),
    ];
    let desk = Desk::new();
    for (options, code, words) in cases {
        let run = desk.run(&[&["bake", "floor.glb", "-o", "out/set"], options].concat());
        run.fails(&options.join(" "), code, words);
        assert!(desk.left().is_empty());
    }
}

#[test]
fn a_folder_that_cannot_be_written_is_refused_before_the_scene_is_read() {
    let desk = Desk::new();
    desk.write("out/letter.txt", b"dear");
    let cases: [(&str, &[&str], &[&str]); 6] = [
        ("out/letter.txt/set", &[], &["cannot write in out/letter.txt", "-o"]),
        ("out/letter.txt/a/b", &[], &["cannot write in out/letter.txt/a", "-o"]),
        ("out/letter.txt", &[], &["out/letter.txt exists", "is not a baked set", "another folder with -o"]),
        ("out/letter.txt", &["--force"], &["is not a baked set", "-o"]),
        ("out", &[], &["out exists", "is not a baked set", "another folder with -o"]),
        ("out", &["--force"], &["is not a baked set", "never replaced"]),
    ];
    for (target, options, words) in cases {
        let arguments = [&["bake", "nowhere.glb", "-o", target], options].concat();
        let run = desk.run(&arguments);
        run.fails(target, 2, words);
        assert!(!run.stderr.contains("--force"), "it would not help: {}", run.stderr);
        assert_eq!(desk.left(), ["letter.txt"]);
    }
    desk.run(&["bake", "nowhere.glb", "-o", "out/new/deep/set"]).fails("no scene", 2, &["nowhere.glb"]);
    assert_eq!(desk.left(), ["letter.txt"], "folders made on the way stay only if they hold a set");
}

/// O1.
#[cfg(unix)]
#[test]
fn a_disk_that_fills_up_leaves_nothing() {
    let desk = Desk::new();
    // Blocks of 512 bytes, or of 1024: either way our scene does not fit.
    let script =
        "trap '' XFSZ; ulimit -f 40; exec \"$0\" bake \"$1\" -o out/set --preset draft --size 64 --engine rays:2";
    let mut command = std::process::Command::new("sh");
    command.current_dir(desk.path("")).args(["-c", script, super::tools::SUNBAKE]).arg(gas_station());
    Run::of(&mut command).fails("a full disk", 2, &["cannot write", "nothing was left behind", "make room"]);
    assert!(desk.left().is_empty(), "{:?}", desk.left());
}

#[test]
fn a_scene_with_some_bad_parts_bakes_with_a_warning() {
    let cases: [(&str, Vec<u8>, u64, &str); 3] = [
        ("one position is not a number", with_positions(f32::NAN, 2), 1, ""),
        ("a wall's image is none", with_image("OPAQUE", b"no image"), 0, "warning: "),
        (
            "a node is flat",
            {
                let mut json = floor();
                json["nodes"] = json!([{ "mesh": 0 }, { "mesh": 0, "scale": [1, 0, 0] }]);
                json["scenes"][0]["nodes"] = json!([0, 1]);
                glb(&json, &floor_bytes())
            },
            0,
            "warning: ",
        ),
    ];
    for (name, bytes, dropped, warning) in cases {
        let desk = Desk::new();
        let mut bytes = bytes;
        if dropped == 1 {
            // The second triangle keeps its corners: 0, 2 and 3 are whole, 1 is not.
            let good = floor_bytes();
            let at = bytes.len() - good.len();
            bytes[at..at + 12].copy_from_slice(&good[..12]);
        }
        desk.write("floor.glb", &bytes);
        let run = desk.bake(&["--json"]).ok();
        assert_eq!(run.json()["stats"]["dropped_triangles"], dropped, "{name}");
        assert!(run.stderr.starts_with(warning), "{name}: {}", run.stderr);
    }
}

#[test]
fn a_damaged_set_is_refused() {
    let desk = Desk::new();
    desk.bake(&[]).ok();
    let manifest = desk.path("out/set/sunbake.json");
    let whole = std::fs::read_to_string(&manifest).unwrap();
    for name in ["../floor.glb", "/etc/passwd", "http://example.org/scene.glb"] {
        let mut json: Value = serde_json::from_str(&whole).unwrap();
        json["scene"]["file"] = name.into();
        std::fs::write(&manifest, json.to_string()).unwrap();
        for command in ["inspect", "texels"] {
            desk.run(&[command, "out/set"]).fails(name, 3, &[name, "own folder", "bake the scene again"]);
        }
    }
    for (text, word) in [("{", "EOF"), ("{\"format\": \"x\"}", "format"), (&whole[..whole.len() / 2], "sunbake.json")] {
        std::fs::write(&manifest, text).unwrap();
        desk.run(&["inspect", "out/set"]).fails(text, 3, &[word]);
        desk.run(&["inspect", "out/set", "--json"]).fails(text, 3, &[word]);
    }
    std::fs::write(&manifest, &whole).unwrap();
    let texture = "out/set/page0_lane0_layer0_rise.png";
    std::fs::write(desk.path(texture), b"no image").unwrap();
    desk.run(&["inspect", "out/set"]).fails("a broken texture", 3, &["rise.png", "bake the scene again"]);
    std::fs::remove_file(desk.path(texture)).unwrap();
    desk.run(&["texels", "out/set"]).fails("a missing texture", 2, &["rise.png"]);
}
