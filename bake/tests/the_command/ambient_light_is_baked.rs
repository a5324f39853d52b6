//! Ambient occlusion, bent normals, the sky and vertices: which flag writes which file.

use super::tools::{Desk, Run, names};
use serde_json::{Value, json};
use std::path::Path;

/// The JSON chunk of a binary glTF file.
fn gltf(file: &Path) -> Value {
    let bytes = std::fs::read(file).expect("a file");
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    serde_json::from_slice(&bytes[20..20 + length]).expect("JSON")
}

/// A small bake of ambient light alone, with further arguments.
fn bake_ao(desk: &Desk, more: &[&str]) -> Run {
    let usual = ["bake", "floor.glb", "-o", "out/set", "--preset=draft", "--size=64", "--only=ao", "--threads", "1"];
    desk.run(&[&usual[..], more].concat())
}

fn effect(manifest: &Value, name: &str) -> Value {
    let all = manifest["effects"].as_array().expect("effects");
    all.iter().find(|e| e["effect"] == name).unwrap_or_else(|| panic!("no effect {name}"))["on"].clone()
}

#[test]
fn ao_alone_writes_a_glb_and_one_picture() {
    let desk = Desk::new();
    let manifest = bake_ao(&desk, &["--json"]).ok().json();
    assert_eq!(names(&desk.path("out/set")), ["page0_ao.png", "scene.glb", "sunbake.json"]);
    assert_eq!(manifest["atlases"][0]["lanes"], json!([]));
    assert!(manifest["path"].is_object(), "a sky needs to know where the sun stands");
    assert_eq!(
        (effect(&manifest, "ambient-occlusion"), effect(&manifest, "sun-intervals")),
        (json!(true), json!(false))
    );
    let scene = gltf(&desk.path("out/set/scene.glb"));
    let occlusion = &scene["materials"][0]["occlusionTexture"];
    assert_eq!(occlusion["texCoord"], 1);
    let image = &scene["images"]
        [scene["textures"][occlusion["index"].as_u64().unwrap() as usize]["source"].as_u64().unwrap() as usize];
    assert_eq!(image["mimeType"], "image/png");
    let instance = &manifest["instances"][0];
    assert_eq!((&instance["uv_scale"], &instance["uv_offset"]), (&json!([1.0, 1.0]), &json!([0.0, 0.0])));
    let told = desk.run(&["inspect", "out/set"]).ok().stdout;
    assert!(told.contains("64 rays a texel") && !told.contains("intervals a texel"), "{told}");
    // Nothing stands on the floor: every texel is open, and rays were traced for every one.
    let texel = desk.run(&["texels", "out/set", "--count=1"]).ok().json();
    assert_eq!((&texel["ao"], &texel["lit"]), (&json!(1.0), &json!([])));
    let rays = manifest["ambient"]["rays_traced"].as_u64().unwrap();
    assert!(rays >= 64 * manifest["stats"]["texels"].as_u64().unwrap());
}

#[test]
fn intervals_alone_bake_no_ambient_light() {
    let desk = Desk::new();
    let manifest = desk.bake(&["--only", "intervals", "--json"]).ok().json();
    assert!(manifest.get("ambient").is_none() && manifest["atlases"][0]["ao"].is_null());
    assert_eq!(manifest["stats"]["seconds"]["ambient"], 0.0);
    let scene = gltf(&desk.path("out/set/scene.glb"));
    assert!(scene["materials"][0].get("occlusionTexture").is_none() && scene.get("images").is_none());
}

#[test]
fn bent_normals_sky_and_vertices_are_written_on_request() {
    let desk = Desk::new();
    let flags = ["--bent", "--sky=sh2", "--exr", "--ao-vertices=COLOR_0", "--ao-bits=16", "--ao-supersample=2"];
    let manifest = bake_ao(&desk, &[&flags[..], &["--json"]].concat()).ok().json();
    let expected = [
        "page0_ambient.exr",
        "page0_ao.png",
        "page0_bent.png",
        "page0_sky0.png",
        "page0_sky1.png",
        "page0_sky2.png",
        "scene.glb",
        "sunbake.json",
        "vertices.glb",
    ];
    assert_eq!(names(&desk.path("out/set")), expected);
    for name in ["bent-normals", "sky-sh2", "vertex-ambient"] {
        assert_eq!(effect(&manifest, name), true, "{name}");
    }
    assert_eq!(manifest["ambient"]["vertices"], json!({ "file": "vertices.glb", "attribute": "COLOR_0" }));
    let texel = desk.run(&["texels", "out/set", "--count=1"]).ok().json();
    // A level floor in the open: two thirds of a unit straight up, and the sky's mean.
    let bent: Vec<f64> = texel["bent"].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
    assert!((bent[1] - 2.0 / 3.0).abs() < 0.01 && bent[0].abs() < 0.02 && bent[2].abs() < 0.02, "{bent:?}");
    assert!((texel["sky"][0].as_f64().unwrap() - 0.282_095).abs() < 1e-4);
    let vertices = gltf(&desk.path("out/set/vertices.glb"));
    let attributes = &vertices["meshes"][0]["primitives"][0]["attributes"];
    assert!(attributes["COLOR_0"].is_u64() && attributes.get("TEXCOORD_1").is_none(), "{attributes}");
    for (file, color) in [("page0_ao.png", png::ColorType::Grayscale), ("page0_bent.png", png::ColorType::Rgb)] {
        let file = std::io::BufReader::new(std::fs::File::open(desk.path("out/set").join(file)).unwrap());
        let reader = png::Decoder::new(file).read_info().unwrap();
        assert_eq!((reader.info().color_type, reader.info().bit_depth), (color, png::BitDepth::Sixteen));
    }
}

#[test]
fn an_error_and_a_distance_are_kept_in_the_manifest() {
    let desk = Desk::new();
    let manifest = bake_ao(&desk, &["--ao-error=0.02", "--ao-distance=1.5", "--json"]).ok().json();
    let ambient = &manifest["ambient"];
    assert_eq!(
        (&ambient["error"], &ambient["distance_m"], &ambient["rays"]),
        (&json!(0.02), &json!(1.5), &json!(4096))
    );
    // An open floor needs the fewest rays that are ever traced.
    let a_texel = ambient["rays_traced"].as_f64().unwrap() / manifest["stats"]["texels"].as_f64().unwrap();
    assert!(a_texel < 70.0, "{a_texel} rays a texel");
}
