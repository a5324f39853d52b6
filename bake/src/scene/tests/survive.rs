//! No input panics: thousands of broken variants of a scene that uses everything.

use super::{Builder, builder::load_limited, builder::png};
use crate::scene::LoadLimits;
use serde_json::{Value, json};

/// SplitMix64: Steele, Lea, Flood, *Fast Splittable Pseudorandom Number Generators*, 2014.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ z >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ z >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ z >> 31) % n.max(1) as u64) as usize
    }
}

fn everything() -> Builder {
    let mut b = Builder::new();
    let texture = b.texture(&png(&[[1, 2, 3, 0], [4, 5, 6, 255]]));
    b.push("samplers", json!({ "wrapS": 33071 }));
    b.root["textures"][texture]["sampler"] = json!(0);
    let transform = json!({ "KHR_texture_transform": { "rotation": 1.5, "texCoord": 1 } });
    let info = json!({ "index": texture, "extensions": transform });
    b.push("materials", json!({ "alphaMode": "MASK", "pbrMetallicRoughness": { "baseColorTexture": info } }));
    let uv = b.floats(&[[0.0f32, 0.5]; 3]);
    let color = b.accessor(5121, "VEC4", 3, &[255; 12], json!({ "normalized": true }));
    let joints = b.accessor(5121, "VEC4", 3, &[0; 12], json!({}));
    let weights = b.floats(&[[1.0f32, 0.0, 0.0, 0.0]; 3]);
    let delta = b.floats(&[[0.0f32, 0.0, 1.0]; 3]);
    let (at, values) = (b.view(&[1]), b.view(&[0; 12]));
    b.root["accessors"][delta]["sparse"] = json!({
        "count": 1, "indices": { "bufferView": at, "componentType": 5121 }, "values": { "bufferView": values },
    });
    let bind = b.floats(&[glam::Mat4::IDENTITY.to_cols_array()]);
    let indices = b.indices(&[0, 1, 2, 2, 1, 0]);
    let attributes = json!({
        "TEXCOORD_0": uv, "TEXCOORD_1": uv, "COLOR_0": color, "NORMAL": delta, "JOINTS_0": joints, "WEIGHTS_0": weights,
    });
    let primitive = json!({ "indices": indices, "material": 0, "targets": [{ "POSITION": delta }] });
    let mesh = b.triangle_mesh_of(attributes, primitive);
    b.push("skins", json!({ "joints": [1], "inverseBindMatrices": bind }));
    b.push("cameras", json!({ "type": "perspective", "perspective": { "yfov": 1.0, "znear": 0.1 } }));
    b.root["extensions"] = json!({ "KHR_lights_punctual": { "lights": [{ "type": "directional" }] } });
    b.node(json!({ "mesh": mesh, "skin": 0, "weights": [0.5], "children": [1], "rotation": [0, 0.6, 0, 0.8] }));
    b.child(json!({ "camera": 0, "mesh": mesh, "extensions": { "KHR_lights_punctual": { "light": 0 } } }));
    b
}

fn count(value: &Value) -> usize {
    1 + match value {
        Value::Array(list) => list.iter().map(count).sum(),
        Value::Object(map) => map.values().map(count).sum(),
        _ => 0,
    }
}

/// Replaces the value at `place`, counting values from the root in order.
fn replace(value: &mut Value, place: &mut usize, new: &Value) {
    if *place == 0 {
        *value = new.clone();
    }
    *place = place.wrapping_sub(1);
    match value {
        Value::Array(list) => list.iter_mut().for_each(|v| replace(v, place, new)),
        Value::Object(map) => map.values_mut().for_each(|v| replace(v, place, new)),
        _ => {}
    }
}

fn nasty() -> Vec<Value> {
    vec![
        json!(null),
        json!(-1),
        json!(0),
        json!(1),
        json!(2),
        json!(5),
        json!(255),
        json!(65535),
        json!(1u64 << 32),
        json!(u64::MAX),
        json!(usize::MAX - 1),
        json!(1e300),
        json!(-1e-300),
        json!(0.5),
        json!(""),
        json!("MAT4"),
        json!("VEC2"),
        json!([]),
        json!({}),
        json!([0]),
        json!([0, 1, 2]),
        json!(true),
        json!(5126),
        json!(5120),
        json!([0, 0, 0]),
        json!("../x"),
    ]
}

#[test]
fn no_change_to_the_json_panics() {
    let good = everything();
    good.scene();
    let root = good.json();
    let (values, places) = (nasty(), count(&root));
    let limits = LoadLimits { max_memory_bytes: 1 << 24 };
    let (mut random, mut loaded) = (Random(1), 0);
    for round in 0..2000 {
        let mut bad = root.clone();
        for _ in 0..1 + round % 3 {
            let mut place = 1 + random.below(places - 1);
            replace(&mut bad, &mut place, &values[random.below(values.len())]);
        }
        let bytes = Builder::glb_of(bad.to_string().as_bytes(), good.binary());
        loaded += usize::from(load_limited("bad.glb", &bytes, &limits).is_ok());
    }
    assert!(loaded > 200, "too few changed files load to test much: {loaded} of 2000");
}

#[test]
fn no_change_to_the_bytes_panics() {
    let good = everything().glb();
    let limits = LoadLimits { max_memory_bytes: 1 << 24 };
    let mut random = Random(2);
    for round in 0..2000 {
        let mut bad = good.clone();
        for _ in 0..1 + round % 5 {
            let at = random.below(bad.len());
            bad[at] = random.below(256) as u8;
        }
        if round % 7 == 0 {
            bad.truncate(random.below(bad.len()));
        }
        drop(load_limited("bad.glb", &bad, &limits));
    }
}
