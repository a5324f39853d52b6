//! Bad input: one clear message each, naming the place and the next step.

use super::{
    Builder,
    builder::{load_bytes, load_limited, png},
};
use crate::error::{ErrorClass, Explain};
use crate::scene::{LoadError, LoadLimits, load};
use serde_json::{Value, json};
use std::{path::Path, time::Instant};

fn text_of(name: &str, bytes: &[u8]) -> String {
    load_bytes(name, bytes).map(|_| "it was loaded".to_owned()).unwrap_or_else(|error| error.to_string())
}

#[test]
fn files_that_are_no_gltf_are_told_apart() {
    let glb = Builder::triangle(json!({})).glb();
    let mut version_1 = glb.clone();
    version_1[4] = 1;
    let mut long_chunk = glb.clone();
    long_chunk[12] = 0xFF;
    long_chunk[13] = 0xFF;
    for (bytes, expected) in [
        (b"".as_slice(), "it is empty"),
        (b"solid cube", "begins neither with the letters glTF"),
        (b"glTF\x02", "it ends within its header, after 5 bytes"),
        (&glb[..20], "its header declares"),
        (&glb[..glb.len() - 1], "is damaged: its header declares"),
        (&version_1, "is glTF 1, and only glTF 2 is supported; convert it: npx gltf-pipeline"),
        (&long_chunk, "a chunk declares 65"),
        (b"{\"asset\": {\"version\": \"1.0\"}}", "is glTF 1.0, and only glTF 2"),
        (b"{\"asset\": {\"version\": \"2.0\", \"minVersion\": \"2.9\"}}", "is glTF 2.9"),
        (b"{\n \"nodes\": [1,]}", "its JSON is wrong at line 2, column 14: trailing comma"),
        (
            b"{\"asset\": {\"version\": \"2.0\"}}",
            "draws no triangles, so there is nothing to bake or to shade: no node of its default scene draws a mesh",
        ),
    ] {
        let message = text_of("bad.glb", bytes);
        assert!(message.contains(expected), "{message}\n  lacks: {expected}");
    }
    let deep = "[".repeat(100_000);
    assert!(text_of("deep.gltf", format!("{{\"a\":{deep}").as_bytes()).contains("recursion limit"));
}

#[test]
fn a_missing_file_and_a_folder_are_read_errors() {
    for path in ["no/such/file.glb", "."] {
        let error = load(Path::new(path), &LoadLimits::default()).expect_err("nothing there");
        assert_eq!(error.class(), ErrorClass::Io, "{error}");
        assert!(error.to_string().contains("cannot read") && error.to_string().contains("check the path"), "{error}");
    }
}

/// What each change to a good scene must be refused with.
fn broken_scenes() -> Vec<(&'static str, Value, &'static str)> {
    vec![
        ("/nodes/0/mesh", json!(5), "meshes[5] (mesh of nodes[0]): it is referred to, but there are only 1"),
        ("/nodes/0/children", json!([7]), "nodes[0]: it has the node 7, and there are only 1"),
        ("/nodes/0/children", json!([0]), "nodes[0] is its own ancestor"),
        ("/nodes/0/matrix", json!([1, 2]), "nodes[0]: invalid length 2"),
        ("/scene", json!(3), "scenes[3] (default scene of the file): it is referred to, but there are only 1"),
        (
            "/accessors/0/count",
            json!(4),
            "(POSITION of meshes[0] primitive 0): its 4 elements need 48 bytes of bufferViews[0], which has 36",
        ),
        ("/accessors/0/count", json!(u64::MAX), "accessors[0]"),
        ("/accessors/0/byteOffset", json!(u64::MAX), "accessors[0]"),
        ("/accessors/0/componentType", json!(5130), ": unknown component type 5130"),
        ("/accessors/0/type", json!("VEC9"), ": unknown type VEC9"),
        ("/accessors/0/type", json!("VEC2"), ": type VEC2 where 3 numbers an element are needed"),
        ("/accessors/1/componentType", json!(5126), "accessors[1]"),
        (
            "/bufferViews/0/byteLength",
            json!(9000),
            "bufferViews[0] (POSITION of meshes[0] primitive 0): it ends at byte 9008 of buffers[0], which has 44",
        ),
        ("/bufferViews/0/byteOffset", json!(u64::MAX), "bufferViews[0]"),
        ("/bufferViews/0/byteStride", json!(u64::MAX), "accessors[0]"),
        ("/bufferViews/0/buffer", json!(4), ": it lies in buffers[4], which does not exist"),
        (
            "/meshes/0/primitives/0/indices",
            json!(9),
            "accessors[9] (indices of meshes[0] primitive 0): it is referred to",
        ),
        ("/meshes/0/primitives/0/attributes", json!({}), "it has no positions"),
        ("/meshes/0/primitives/0/mode", json!(77), "draws no triangles"),
        (
            "/meshes/0/primitives/0/mode",
            json!(1),
            "nothing to bake or to shade: meshes[0] primitive 0: points and lines",
        ),
    ]
}

fn set(root: &mut Value, pointer: &str, value: Value) {
    let (parent, key) = pointer.rsplit_once('/').expect("a pointer");
    match root.pointer_mut(parent).expect("its parent") {
        Value::Array(list) => list[key.parse::<usize>().expect("an index")] = value,
        other => other[key] = value,
    }
}

#[test]
fn contradictions_are_refused_by_their_place() {
    let mut good = Builder::new();
    let indices = good.indices(&[0, 1, 2]);
    let mesh = good.triangle_mesh_of(json!({}), json!({ "indices": indices }));
    good.node(json!({ "mesh": mesh }));
    // So that accessor 0 is the positions and 1 the indices, as the table says.
    good.root["accessors"].as_array_mut().expect("accessors").swap(0, 1);
    good.root["bufferViews"].as_array_mut().expect("views").swap(0, 1);
    for (accessor, view) in [(0, 0), (1, 1)] {
        good.root["accessors"][accessor]["bufferView"] = json!(view);
    }
    good.root["meshes"][0]["primitives"][0]["indices"] = json!(1);
    good.root["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(0);
    good.scene();
    for (pointer, value, expected) in broken_scenes() {
        let mut bad = good.clone();
        bad.root = bad.json();
        set(&mut bad.root, pointer, value.clone());
        let message = bad.refusal();
        assert!(message.contains(expected), "{pointer} = {value}: {message}\n  lacks: {expected}");
    }
}

#[test]
fn an_index_out_of_range_names_its_mesh_and_primitive() {
    let mut b = Builder::new();
    let indices = b.indices(&[0, 1, 3]);
    let mesh = b.triangle_mesh_of(json!({}), json!({ "indices": indices }));
    b.root["meshes"][mesh]["name"] = json!("Wall");
    b.node(json!({ "mesh": mesh }));
    let expected = "meshes[0] \"Wall\" primitive 0: its index 2 is 3, and it has only 3 vertices";
    assert!(b.refusal().starts_with(expected), "{}", b.refusal());
}

#[test]
fn rings_of_nodes_are_refused_with_or_without_a_scene() {
    let mut b = Builder::triangle(json!({ "children": [1] }));
    b.child(json!({ "children": [2] }));
    b.child(json!({ "children": [0] }));
    assert!(b.refusal().contains("nodes[0] is its own ancestor; remove it from the children of nodes[2]"));
    b.root.as_object_mut().expect("root").remove("scenes");
    assert!(b.refusal().contains("nodes[0] is its own ancestor; remove it from the children of nodes[2]"));
}

#[test]
fn a_node_with_two_parents_is_drawn_once() {
    let mut b = Builder::triangle(json!({}));
    b.node(json!({ "children": [2] }));
    b.child(json!({ "mesh": 0 }));
    b.node(json!({ "children": [2] }));
    let scene = b.scene();
    assert_eq!(scene.instances.len(), 2);
    assert!(scene.warnings[0].to_string().contains("nodes[2]: it has more than one parent"), "{:?}", scene.warnings);
}

#[test]
fn a_thousand_million_vertices_in_a_small_file_are_refused_at_once() {
    let start = Instant::now();
    let mut b = Builder::triangle(json!({}));
    let accessor = b.root["accessors"][0].as_object_mut().expect("accessor");
    accessor.insert("count".into(), json!(1_000_000_000));
    assert!(b.refusal().contains("its 1000000000 elements need 12000000000 bytes"), "{}", b.refusal());
    b.root["accessors"][0].as_object_mut().expect("accessor").remove("bufferView");
    let message = b.refusal();
    assert!(message.contains("needs 11444.1 MiB more"), "{message}");
    assert!(start.elapsed().as_secs() < 1);
}

#[test]
fn a_mesh_drawn_more_often_than_memory_allows_is_refused() {
    let mut b = Builder::triangle(json!({}));
    for _ in 0..3000 {
        b.child(json!({ "mesh": 0 }));
    }
    b.root.as_object_mut().expect("root").remove("scenes");
    let with = |max_memory_bytes| load_limited("many.glb", &b.glb(), &LoadLimits { max_memory_bytes });
    let message = with(1_500_000).expect_err("too much").to_string();
    assert!(message.contains("placing 3001 triangles needs 375.1 KiB more"), "{message}");
    assert_eq!(with(4_000_000).expect("enough").instances.len(), 3001);
    assert!(load_limited("tiny.glb", &b.glb(), &LoadLimits { max_memory_bytes: 0 }).is_err());
}

#[test]
fn a_huge_image_in_a_small_file_is_refused_before_it_is_decoded() {
    let mut bytes = png(&[[0; 4]]);
    bytes[16..24].copy_from_slice(&[0, 1, 0, 0, 0, 1, 0, 0]);
    let checksum = crc32(&bytes[12..29]);
    bytes[29..33].copy_from_slice(&checksum.to_be_bytes());
    let mut b = Builder::new();
    let texture = b.texture(&bytes);
    b.push("materials", json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": texture } } }));
    let mesh = b.triangle_mesh_of(json!({}), json!({ "material": 0 }));
    b.node(json!({ "mesh": mesh }));
    assert!(b.refusal().contains("images[0], of 65536 by 65536 texels, needs 16384.0 MiB"), "{}", b.refusal());
}

fn crc32(bytes: &[u8]) -> u32 {
    let step = |crc: u32, _| if crc & 1 == 1 { crc >> 1 ^ 0xEDB8_8320 } else { crc >> 1 };
    !bytes.iter().fold(!0, |crc, &byte| (0..8).fold(crc ^ u32::from(byte), step))
}

#[test]
fn extensions_that_change_geometry_are_refused_by_name_with_the_command_that_removes_them() {
    for (name, advice) in [
        ("KHR_draco_mesh_compression", "npx @gltf-transform/cli copy IN OUT.glb"),
        ("EXT_meshopt_compression", "npx @gltf-transform/cli copy IN OUT.glb"),
        ("KHR_texture_basisu", "npx @gltf-transform/cli ktxdecompress IN OUT.glb"),
        ("EXT_texture_webp", "npx @gltf-transform/cli png IN OUT.glb"),
        ("VENDOR_new_idea", "export the scene without it"),
    ] {
        let mut b = Builder::triangle(json!({}));
        b.root["extensionsRequired"] = json!(["KHR_materials_clearcoat", name]);
        let error = b.load().expect_err("not supported");
        assert_eq!(error.class(), ErrorClass::UnsupportedInput);
        let message = error.to_string();
        assert!(message.contains(name) && message.contains(advice), "{message}");
    }
    let mut b = Builder::triangle(json!({}));
    b.root["extensionsRequired"] = json!([
        "KHR_materials_unlit",
        "KHR_lights_punctual",
        "KHR_texture_transform",
        "KHR_mesh_quantization",
        "KHR_materials_variants",
        "KHR_animation_pointer",
        "KHR_xmp_json_ld",
    ]);
    b.scene();
}

#[test]
fn compressed_geometry_without_a_plain_copy_is_refused_even_if_it_is_called_optional() {
    let mut b = Builder::triangle(json!({}));
    b.root["meshes"][0]["primitives"][0]["extensions"] = json!({ "KHR_draco_mesh_compression": {} });
    b.scene();
    b.root["accessors"][0].as_object_mut().expect("accessor").remove("bufferView");
    assert!(b.refusal().contains("KHR_draco_mesh_compression"), "{}", b.refusal());
    let mut b = Builder::triangle(json!({}));
    b.root["buffers"] = json!([{ "byteLength": 36 }, { "byteLength": 36 }]);
    b.root["bufferViews"][0] =
        json!({ "buffer": 1, "byteLength": 36, "extensions": { "EXT_meshopt_compression": {} } });
    assert!(b.refusal().contains("EXT_meshopt_compression"), "{}", b.refusal());
}

#[test]
fn copies_of_a_mesh_need_attributes_of_one_length() {
    let mut b = Builder::triangle(json!({}));
    let (three, two) = (b.floats(&[[0.0; 3]; 3]), b.floats(&[[1.0; 3]; 2]));
    b.root["nodes"][0]["extensions"] =
        json!({ "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": three, "SCALE": two } } });
    let message = b.refusal();
    assert!(message.contains("nodes[0]") && message.contains("3 and 2 entries"), "{message}");
}

/// Loads a triangle whose buffer is named by a URI, from a folder that has these files.
fn load_with_uri(uri: &str, files: &[&str]) -> Result<crate::scene::Scene, LoadError> {
    let mut b = Builder::triangle(json!({}));
    b.root["buffers"] = json!([{ "byteLength": 36, "uri": uri }]);
    let outer = tempfile::tempdir().expect("a folder");
    let folder = outer.path().join("scene");
    std::fs::create_dir_all(folder.join("data files")).expect("made");
    std::fs::write(outer.path().join("outside.bin"), b.binary()).expect("written");
    files.iter().for_each(|name| std::fs::write(folder.join(name), b.binary()).expect("written"));
    #[cfg(unix)]
    std::os::unix::fs::symlink(outer.path().join("outside.bin"), folder.join("link.bin")).expect("linked");
    let path = folder.join("scene.gltf");
    std::fs::write(&path, b.root.to_string()).expect("written");
    load(&path, &LoadLimits::default())
}

#[test]
fn files_beside_the_scene_are_read_whatever_their_names_are_like() {
    for uri in
        ["data%20files/a%25b.bin", "./data files/a%25b.bin", "data%20files\\a%25b.bin", "data files/../plain.bin"]
    {
        load_with_uri(uri, &["data files/a%b.bin", "plain.bin"]).unwrap_or_else(|error| panic!("{uri}: {error}"));
    }
    let inline: String = Builder::triangle(json!({})).binary().iter().map(|byte| format!("%{byte:02x}")).collect();
    load_with_uri(&format!("data:application/octet-stream,{inline}"), &[]).expect("percent-encoded");
    let base64 = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    load_with_uri(&format!("data:application/gltf-buffer;base64,{base64}"), &[]).expect("base64");
    let wrong = load_with_uri("data:;base64,AA*A", &[]).expect_err("not base64").to_string();
    assert!(wrong.contains(": its data URI has a wrong base64 character at 2"), "{wrong}");
}

#[test]
fn a_scene_opens_nothing_outside_its_own_folder() {
    for uri in [
        "http://example.com/a.bin",
        "file:///etc/passwd",
        "/etc/passwd",
        "C:\\a.bin",
        "../outside.bin",
        "a/../../outside.bin",
        "%2e%2e/outside.bin",
        "..%5Coutside.bin",
        "link.bin",
        "\\\\server\\share",
        "a\u{0}b",
    ] {
        let error = load_with_uri(uri, &[]).map(|_| ()).expect_err(uri);
        assert!(matches!(error, LoadError::Outside { .. }), "{uri}: {error}");
        assert!(error.to_string().contains("buffers[0] names"), "{error}");
    }
}

#[test]
fn missing_and_short_buffers_are_named() {
    let missing = load_with_uri("gone.bin", &[]).map(|_| ()).expect_err("no file");
    assert_eq!(missing.class(), ErrorClass::Io);
    assert!(missing.to_string().contains("gone.bin") && missing.to_string().contains("put it back"), "{missing}");
    let mut b = Builder::triangle(json!({}));
    b.root["buffers"] = json!([{ "byteLength": 36 }]);
    let short = Builder::glb_of(b.root.to_string().as_bytes(), &b.binary()[..20]);
    let message = text_of("short.glb", &short);
    assert!(message.contains(": it ends at byte 36 of buffers[0], which has 20"), "{message}");
}

#[test]
fn buffers_and_pictures_that_nothing_drawn_needs_stop_no_bake() {
    for uri in ["animation.bin", "../shared/animation.bin", "https://example.com/animation.bin", "data:;base64,*"] {
        let mut b = Builder::triangle(json!({}));
        b.root["buffers"] = json!([{ "byteLength": 36 }, { "byteLength": 9, "uri": uri }]);
        b.push("bufferViews", json!({ "buffer": 1, "byteLength": 9 }));
        b.push("accessors", json!("this is no accessor"));
        b.root["images"] = json!([{ "uri": uri }]);
        b.push("textures", json!({ "source": 0 }));
        b.root["materials"] = json!([{ "normalTexture": { "index": 0 } }]);
        b.root["meshes"][0]["primitives"][0]["material"] = json!(0);
        let scene = b.scene();
        assert!(scene.images.is_empty() && scene.warnings.is_empty(), "{uri}: {:?}", scene.warnings);
    }
}

#[test]
fn a_picture_that_is_drawn_is_not_fetched_from_elsewhere() {
    for uri in ["../textures/brick.png", "https://example.com/brick.png"] {
        let mut b = Builder::triangle(json!({}));
        b.root["meshes"][0]["primitives"][0]["material"] = json!(0);
        b.root["images"] = json!([{ "uri": uri }]);
        b.push("textures", json!({ "source": 0 }));
        b.root["materials"] = json!([{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }]);
        let message = b.refusal();
        assert!(message.contains("images[0]") && message.contains(uri), "{message}");
    }
}

#[test]
fn coordinates_that_overflow_are_left_out() {
    let mut b = Builder::triangle(json!({}));
    b.node(json!({ "name": "far", "mesh": 0, "translation": [1e300, 0, 0] }));
    let scene = b.scene();
    assert_eq!(scene.instances.len(), 1);
    assert!(scene.warnings[0].to_string().contains("beyond 1e15 m"), "{:?}", scene.warnings);
}
