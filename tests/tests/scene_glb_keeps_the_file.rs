//! `scene.glb` says all that the scene's own file says, whatever is in it; and the judge of that is not blind.

use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use sunbake::progress::Silent;
use sunbake::settings::{AmbientRequest, BakeSettings, SunRequest, VertexAttribute};
use sunbake_tests::gltf_diff::{Allowed, lost};
use sunbake_tests::june_day;

/// A file under construction, of two buffers: numbers in the first, all else in the second.
#[derive(Default)]
struct Made {
    buffers: [Vec<u8>; 2],
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Made {
    fn view(&mut self, buffer: usize, bytes: &[u8], more: &Value) -> usize {
        let data = &mut self.buffers[buffer];
        data.resize(data.len().next_multiple_of(4), 0xEE);
        let mut view = json!({ "buffer": buffer, "byteOffset": data.len(), "byteLength": bytes.len() });
        more.as_object().unwrap().iter().for_each(|(key, value)| view[key] = value.clone());
        data.extend(bytes);
        self.views.push(view);
        self.views.len() - 1
    }

    fn accessor(&mut self, component: u32, shape: &str, count: usize, bytes: &[u8], stride: usize) -> usize {
        let buffer = usize::from(component != 5126);
        let view = self.view(buffer, bytes, &if stride == 0 { json!({}) } else { json!({ "byteStride": stride }) });
        self.accessors.push(json!({ "bufferView": view, "componentType": component, "type": shape, "count": count }));
        self.accessors.len() - 1
    }

    fn floats<const N: usize>(&mut self, values: &[[f32; N]]) -> usize {
        let bytes: Vec<u8> = values.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
        let shape = ["", "SCALAR", "VEC2", "VEC3", "VEC4"].get(N).copied().unwrap_or("MAT4");
        let accessor = self.accessor(5126, shape, values.len(), &bytes, 0);
        if N == 3 {
            let fold = |pick: fn(f32, f32) -> f32| (0..N).map(|k| values.iter().map(|v| v[k]).reduce(pick)).collect();
            let [low, high]: [Vec<Option<f32>>; 2] = [fold(f32::min), fold(f32::max)];
            self.accessors[accessor]["min"] = json!(low);
            self.accessors[accessor]["max"] = json!(high);
        }
        accessor
    }

    fn indices(&mut self, values: &[u16]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|x| x.to_le_bytes()).collect();
        self.accessor(5123, "SCALAR", values.len(), &bytes, 0)
    }
}

/// The corners of a cube that share vertices, so that unwrapping has to cut it.
fn cube(size: f32) -> (Vec<[f32; 3]>, Vec<u16>) {
    let corner = |i: u16| [0, 1, 2].map(|k| if i >> k & 1 == 1 { size } else { 0.0 });
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let indices = faces.iter().flat_map(|&[a, b, c, d]| [a, b, c, a, c, d]).collect();
    ((0..8).map(corner).collect(), indices)
}

/// One file with nearly everything that could be lost: cut cubes with quantised colours, joints, morph targets (one of
/// them sparse) and attributes of their own; primitives that share their vertices; a strip; points; degenerate
/// triangles; a second scene; instances; a skin; an animation; lights; unknown extensions; pictures in files beside
/// it.
fn write_rich(folder: &Path) -> PathBuf {
    let mut made = Made::default();
    let (corners, faces) = cube(1.0);
    let position = made.floats(&corners);
    let colors: Vec<u8> = (0..8u8).flat_map(|i| [i * 30, 255, 9 * i, 255]).collect();
    let color = made.accessor(5121, "VEC4", 8, &colors, 4);
    made.accessors[color]["normalized"] = json!(true);
    let id: Vec<u8> = (0..8u16).flat_map(|i| [(i * 257).to_le_bytes(), [7, 7]].concat()).collect();
    let id = made.accessor(5123, "SCALAR", 8, &id, 4);
    let joints = made.accessor(5121, "VEC4", 8, &[0; 32], 4);
    let weights = made.floats(&[[1.0, 0.0, 0.0, 0.0]; 8]);
    let bend = made.floats(&(0..8).map(|i| [0.0, i as f32 * 0.01, 0.0]).collect::<Vec<_>>());
    let sparse = made.floats(&[[0.0f32; 3]; 8]);
    let places = made.view(1, &[2, 5], &json!({}));
    let moved: Vec<u8> =
        [[0.5f32, 0.0, 0.0], [0.0, 0.25, 0.0]].as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
    let moved = made.view(0, &moved, &json!({}));
    made.accessors[sparse]["sparse"] = json!({
        "count": 2, "indices": { "bufferView": places, "componentType": 5121 }, "values": { "bufferView": moved },
    });
    for end in ["min", "max"] {
        made.accessors[sparse][end] = if end == "min" { json!([0, 0, 0]) } else { json!([0.5, 0.25, 0]) };
    }
    let uv = made.floats(&(0..8).map(|i| [i as f32 / 8.0, 0.5]).collect::<Vec<_>>());
    let with_bad: Vec<u16> = [&faces[..], &[0, 0, 1, 0, 1, 1]].concat();
    let cube_indices = made.indices(&with_bad);
    let [lower, upper] = [&faces[..18], &faces[18..]].map(|half| made.indices(half));
    let shared = made.floats(&corners.iter().map(|c| c.map(|x| x * 2.0)).collect::<Vec<_>>());
    let strip = made.indices(&[0, 1, 2, 3, 3, 7, 7, 3, 6, 2]);
    let inputs = made.floats(&[[0.0f32], [1.0]]);
    let outputs = made.floats(&[[0.0f32, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    let shifts = made.floats(&[[0.0f32, 0.0, 0.0], [3.0, 0.0, 0.0], [0.0, 0.0, 3.0]]);
    let bind = made.floats(&[[1.0f32, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]]);
    let picture = image::RgbaImage::from_pixel(2, 2, image::Rgba([200, 90, 40, 255]));
    picture.save(folder.join("brick %1.png")).unwrap();
    image::RgbaImage::from_pixel(3, 1, image::Rgba([128, 128, 255, 255])).save(folder.join("bumps.png")).unwrap();
    let ground = made.floats(&[[-20.0, -0.1, -20.0], [20.0, -0.1, -20.0], [20.0, -0.1, 20.0], [-20.0, -0.1, 20.0]]);
    let ground_indices = made.indices(&[0, 2, 1, 0, 3, 2]);
    let ground_uv = made.floats(&[[0.0f32, 0.0], [9.0, 0.0], [9.0, 9.0], [0.0, 9.0]]);
    let cube_attributes = json!({
        "POSITION": position, "COLOR_0": color, "_ID": id, "JOINTS_0": joints, "WEIGHTS_0": weights, "TEXCOORD_0": uv,
    });
    let variants = json!({ "KHR_materials_variants": { "mappings": [{ "material": 2, "variants": [0] }] } });
    let root = json!({
        "asset": { "version": "2.0", "generator": "by hand", "extras": { "a": [1, 2.5, null] } },
        "scene": 0,
        "scenes": [{ "nodes": [0, 1, 2, 3, 7, 8], "name": "day" }, { "nodes": [9], "extras": 3 }],
        "nodes": [
            { "mesh": 0, "skin": 0, "name": "bent", "extras": { "hit points": 30 } },
            { "mesh": 1, "translation": [4, 0, 0], "children": [4, 5] },
            { "mesh": 1, "translation": [8, 0, 0], "extensions": { "ACME_pick": { "id": 7 } } },
            { "mesh": 3, "translation": [0, 0, 4],
              "extensions": { "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": shifts } } },
              "children": [6] },
            { "mesh": 2, "translation": [0, 3, 0], "weights": [0.5, 0] },
            { "camera": 0, "translation": [0, 2, 9] },
            { "name": "joint" },
            { "mesh": 4 },
            { "extensions": { "KHR_lights_punctual": { "light": 0 } }, "rotation": [-0.5, 0, 0, 0.866025403] },
            { "mesh": 1, "translation": [0, -9, 0] },
        ],
        "meshes": [
            { "primitives": [{ "attributes": cube_attributes, "indices": cube_indices, "material": 0,
                "targets": [{ "POSITION": bend }, { "POSITION": sparse }], "extensions": variants }],
              "weights": [0, 0], "extras": { "targetNames": ["bend", "pull"] } },
            { "name": "halves", "primitives": [
                { "attributes": { "POSITION": shared, "TEXCOORD_0": uv }, "indices": lower, "material": 0 },
                { "attributes": { "POSITION": shared, "TEXCOORD_0": uv }, "indices": upper, "material": 1,
                  "extras": "upper" }] },
            { "primitives": [{ "attributes": cube_attributes, "indices": cube_indices, "material": 1,
                "targets": [{ "POSITION": bend }, { "POSITION": sparse }] }] },
            { "primitives": [
                { "attributes": { "POSITION": position }, "indices": strip, "mode": 5 },
                { "attributes": { "POSITION": position }, "mode": 0, "material": 1 }] },
            { "primitives": [{ "attributes": { "POSITION": ground, "TEXCOORD_0": ground_uv }, "material": 3,
                "indices": ground_indices }] },
        ],
        "materials": [
            { "name": "brick", "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 }, "metallicFactor": 0.25 },
              "normalTexture": { "index": 1, "scale": 0.5, "texCoord": 0 }, "occlusionTexture": { "index": 1 },
              "extensions": { "KHR_materials_clearcoat": { "clearcoatFactor": 0.6 } }, "extras": { "tag": "b" } },
            { "name": "paint", "doubleSided": true, "emissiveFactor": [0, 0.1, 0], "alphaMode": "BLEND" },
            { "name": "other brick", "pbrMetallicRoughness": { "roughnessFactor": 0.125 } },
            { "name": "ground", "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } },
        ],
        "textures": [{ "source": 0, "sampler": 0, "name": "t" }, { "source": 1 }],
        "samplers": [{ "wrapS": 33071, "minFilter": 9987 }],
        "images": [{ "uri": "brick%20%251.png", "name": "brick" }, { "uri": "bumps.png", "extras": 1 }],
        "cameras": [{ "type": "perspective", "perspective": { "yfov": 0.8, "znear": 0.05, "zfar": 90 } }],
        "skins": [{ "joints": [6], "inverseBindMatrices": bind }],
        "animations": [{ "name": "sway", "samplers": [{ "input": inputs, "output": outputs, "interpolation": "STEP" }],
            "channels": [{ "sampler": 0, "target": { "node": 1, "path": "translation" } }] }],
        "extensions": {
            "KHR_lights_punctual": { "lights": [{ "type": "directional", "intensity": 3 }] },
            "KHR_materials_variants": { "variants": [{ "name": "other" }] },
            "ACME_scene": { "wind": [1, 0, 0] },
        },
        "extensionsUsed": ["KHR_lights_punctual", "KHR_materials_variants", "KHR_materials_clearcoat", "ACME_pick",
            "ACME_scene", "EXT_mesh_gpu_instancing"],
        "extras": { "author": "nobody" },
        "bufferViews": made.views, "accessors": made.accessors,
        "buffers": [
            { "uri": "numbers.bin", "byteLength": made.buffers[0].len() },
            { "uri": "rest.bin", "byteLength": made.buffers[1].len(), "name": "rest" },
        ],
    });
    std::fs::write(folder.join("numbers.bin"), &made.buffers[0]).unwrap();
    std::fs::write(folder.join("rest.bin"), &made.buffers[1]).unwrap();
    let file = folder.join("rich.gltf");
    std::fs::write(&file, root.to_string()).unwrap();
    file
}

fn settings() -> BakeSettings {
    BakeSettings { page_size_texels: 256, threads: 1, ..BakeSettings::standard(SunRequest::Day(june_day())) }
}

/// Bakes a file into a set beside it.
fn bake(file: &Path, name: &str, settings: &BakeSettings) -> (PathBuf, sunbake::BakeReport) {
    let set = file.with_file_name(name);
    let report = sunbake::bake(file, &set, false, settings, &Silent).unwrap();
    (set, report)
}

#[test]
fn whatever_is_in_a_file_is_in_scene_glb() {
    let folder = tempfile::tempdir().unwrap();
    let file = write_rich(folder.path());
    let times = BakeSettings { ambient: None, ..settings() };
    let vertices = Some(VertexAttribute::Ao);
    let ambient = Some(AmbientRequest { vertices, ..AmbientRequest::with_rays(16) });
    for (name, settings) in [("times", times), ("ambient", BakeSettings { ambient, ..settings() })] {
        let (set, report) = bake(&file, name, &settings);
        let allowed = Allowed { occlusion: settings.ambient.is_some() };
        assert_eq!(lost(&file, &set.join("scene.glb"), allowed), [""; 0], "{name}");
        if settings.ambient.is_some() {
            assert_eq!(lost(&file, &set.join("vertices.glb"), Allowed::default()), [""; 0], "{name}");
        }
        let said: Vec<String> = report.warnings.iter().map(ToString::to_string).collect();
        assert!(said.iter().any(|line| line.contains("EXT_mesh_gpu_instancing")), "{said:#?}");
        // A second generation keeps the first.
        let (again, _) = bake(&set.join("scene.glb"), "again", &settings);
        assert_eq!(lost(&set.join("scene.glb"), &again.join("scene.glb"), allowed), [""; 0], "{name} again");
    }
}

/// Changes the JSON of a GLB and writes it as another file.
fn changed(file: &Path, change: impl FnOnce(&mut Value)) -> PathBuf {
    let bytes = std::fs::read(file).unwrap();
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    let mut root: Value = serde_json::from_slice(&bytes[20..20 + length]).unwrap();
    change(&mut root);
    let mut json = root.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let rest = &bytes[20 + length..];
    let total = (20 + json.len() + rest.len()) as u32;
    let out = [&bytes[..8], &total.to_le_bytes(), &(json.len() as u32).to_le_bytes(), b"JSON", &json, rest].concat();
    let path = file.with_file_name("changed.glb");
    std::fs::write(&path, out).unwrap();
    path
}

/// A change of a file's JSON.
type Change = fn(&mut Value);

#[test]
fn the_judge_sees_what_is_lost() {
    let folder = tempfile::tempdir().unwrap();
    let file = write_rich(folder.path());
    let (set, _) = bake(&file, "set", &BakeSettings { ambient: None, ..settings() });
    let written = set.join("scene.glb");
    let corner = |root: &Value, name: &str| {
        let at = root["meshes"][0]["primitives"][0]["attributes"][name].as_u64().unwrap() as usize;
        root["accessors"][at]["bufferView"].as_u64().unwrap() as usize
    };
    let changes: [(&str, Change); 14] = [
        ("normalTexture", |root| drop(root["materials"][0].as_object_mut().unwrap().remove("normalTexture"))),
        ("metallicFactor", |root| root["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] = json!(0)),
        ("clearcoat", |root| root["materials"][0]["extensions"] = json!({})),
        ("BLEND", |root| root["materials"][1]["alphaMode"] = json!("OPAQUE")),
        ("extras", |root| drop(root["nodes"][0].as_object_mut().unwrap().remove("extras"))),
        ("animations", |root| drop(root.as_object_mut().unwrap().remove("animations"))),
        ("cameras", |root| root["cameras"][0]["perspective"]["zfar"] = json!(91)),
        ("ACME_pick", |root| root["nodes"][2]["extensions"] = json!({})),
        ("lights", |root| root["extensions"]["KHR_lights_punctual"]["lights"] = json!([])),
        ("its mesh", |root| drop(root["nodes"][1].as_object_mut().unwrap().remove("mesh"))),
        ("morph targets", |root| root["meshes"][0]["primitives"][0]["targets"] = json!([])),
        ("JOINTS_0", |root| {
            drop(root["meshes"][0]["primitives"][0]["attributes"].as_object_mut().unwrap().remove("JOINTS_0"));
        }),
        ("other bytes", |root| root["images"][0]["bufferView"] = root["images"][1]["bufferView"].clone()),
        ("extensionsUsed", |root| root["extensionsUsed"] = json!(["ACME_pick"])),
    ];
    for (expected, change) in changes {
        let found = lost(&file, &changed(&written, change), Allowed::default());
        assert!(found.iter().any(|line| line.contains(expected)), "{expected}: {found:?}");
    }
    // A single byte of a vertex.
    for name in ["POSITION", "_ID", "COLOR_0", "WEIGHTS_0"] {
        let path = changed(&written, |_| ());
        let mut bytes = std::fs::read(&path).unwrap();
        let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
        let root: Value = serde_json::from_slice(&bytes[20..20 + length]).unwrap();
        let view = &root["bufferViews"][corner(&root, name)];
        bytes[28 + length + view["byteOffset"].as_u64().unwrap() as usize] ^= 1;
        std::fs::write(&path, bytes).unwrap();
        let found = lost(&file, &path, Allowed::default());
        assert!(found.iter().any(|line| line.contains(name)), "{name}: {found:?}");
    }
}
