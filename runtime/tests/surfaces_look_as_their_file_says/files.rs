//! What is read of a file's looks, and what of it cannot be read.

use glam::{DVec3, Vec3};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use sunbake::scene::looks::{Look, Looks};
use sunbake::scene::{LoadLimits, Scene, load, parse};
use sunbake_runtime::technique::{BakedCpu, Technique, Truth};
use sunbake_runtime::testing::{standing_sun, view};
use sunbake_runtime::{Filter, Shot, Stage};

fn case(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/cases").join(name)
}

fn scene(name: &str) -> Scene {
    load(&case(name), &LoadLimits::default()).unwrap()
}

fn looks(scene: &Scene) -> Looks {
    Looks::read(scene, &LoadLimits::default())
}

#[test]
fn factors_and_textures_of_a_file_are_read() {
    let scene = scene("01_pbr_keep/scene.glb");
    let looks = looks(&scene);
    assert_eq!(looks.warnings, []);
    let crate_a = scene.materials.iter().position(|material| material.emissive != Vec3::ZERO).unwrap();
    let Look { metallic, roughness, normal_scale, .. } = looks.materials[crate_a];
    assert_eq!((metallic, roughness, normal_scale), (0.9, 0.35, 0.8));
    // Metal and roughness, normals, emission: not the occlusion that a bake replaces, nor the base colour.
    assert_eq!((looks.images.len(), scene.images.len()), (3, 1));
    let plain = looks.materials.iter().find(|look| look.roughness == 0.4).unwrap();
    assert_eq!(*plain, Look { roughness: 0.4, ..Look::PLAIN });
}

#[test]
fn panes_of_a_file_are_blended() {
    let blended = |name: &str| looks(&scene(name)).meshes.into_iter().filter(|mesh| mesh.is_blended).count();
    assert_eq!(blended("02_window/none.glb"), 0);
    assert_eq!(blended("02_window/blend.glb"), 1);
    assert_eq!(blended("02_window/transmission.glb"), 1);
    assert_eq!(blended("21_decal/scene.glb"), 2);
}

/// A crate whose emissive texture is black but for a yellow square: with the sun down, the square alone is seen.
#[test]
fn a_small_yellow_square_glows_on_a_dark_crate() {
    let scene = scene("24_emissive/scene.glb");
    let glow = scene.materials.iter().position(|material| material.emissive != Vec3::ZERO).unwrap();
    let place = scene.instances.iter().find(|one| scene.meshes[one.mesh].material == glow).unwrap();
    let centre = place.bake_from_object.w_axis.truncate() + scene.centre_m;
    let stage = Stage::plain(scene, Some(standing_sun(DVec3::Y, 0.0)));
    let mut yellow = 0;
    let mut dark = 0;
    for away in [DVec3::new(2.0, 1.5, 2.5), DVec3::new(-2.0, 1.5, -2.5), DVec3::new(0.3, 3.0, 0.2)] {
        let shot = Shot::new(&stage, view(&stage, centre + away, centre, [96, 96]));
        let moment = stage.moment(0.5).without_sun().without_sky();
        let picture = Truth::Hard.color(&shot, &moment).unwrap();
        let on_crate = shot
            .hits()
            .iter()
            .zip(&picture.pixels)
            .filter(|(hit, _)| hit.is_some_and(|hit| stage.material(hit.triangle as usize).emissive != Vec3::ZERO));
        for (_, light) in on_crate {
            yellow += usize::from(light.x > 0.3 && light.y > 0.3 && light.z < 0.2 * light.x);
            dark += usize::from(light.max_element() < 0.02);
        }
    }
    assert!(yellow > 50 && dark > 10 * yellow, "{yellow} pixels are yellow, {dark} are dark");
}

/// A triangle with normals, coordinates and tangents, and a material.
fn triangle(material: &Value, tangents: [[f32; 4]; 3]) -> Vec<u8> {
    let positions: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]];
    let normals: [[f32; 3]; 3] = [[0.0, 1.0, 0.0]; 3];
    let uvs: [[f32; 2]; 3] = [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]];
    let numbers = positions.iter().flatten().chain(normals.iter().flatten()).chain(uvs.iter().flatten());
    let bytes: Vec<u8> = numbers.chain(tangents.iter().flatten()).flat_map(|x| x.to_le_bytes()).collect();
    let view = |offset: usize, length: usize| json!({ "buffer": 0, "byteOffset": offset, "byteLength": length });
    let accessor =
        |view: usize, kind: &str| json!({ "bufferView": view, "componentType": 5126, "count": 3, "type": kind });
    let mut json = json!({
        "asset": { "version": "2.0" },
        "scenes": [{ "nodes": [0] }], "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{ "material": 0, "attributes": {
            "POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2, "TANGENT": 3 } }] }],
        "materials": [material],
        "textures": [{ "source": 0 }],
        "images": [{ "uri": "missing.png" }],
        "buffers": [{ "byteLength": bytes.len() }],
        "bufferViews": [view(0, 36), view(36, 36), view(72, 24), view(96, 48)],
        "accessors": [accessor(0, "VEC3"), accessor(1, "VEC3"), accessor(2, "VEC2"), accessor(3, "VEC4")],
    })
    .to_string()
    .into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let length = 12 + 8 + json.len() + 8 + bytes.len();
    let mut glb = b"glTF".to_vec();
    [2, length as u32, json.len() as u32].iter().for_each(|n| glb.extend(n.to_le_bytes()));
    glb.extend(b"JSON");
    glb.extend(json);
    glb.extend((bytes.len() as u32).to_le_bytes());
    glb.extend(b"BIN\0");
    glb.extend(bytes);
    glb
}

const RIGHT: [f32; 4] = [1.0, 0.0, 0.0, 1.0];

fn parsed(material: &Value, tangents: [[f32; 4]; 3]) -> Scene {
    parse(Path::new("made.glb"), &triangle(material, tangents), &LoadLimits::default()).unwrap()
}

/// A7: a picture that only looks need stops no bake, and is missed in one line.
#[test]
fn what_cannot_be_read_is_missed_once_and_the_surface_is_plain() {
    let material = json!({
        "pbrMetallicRoughness": { "metallicFactor": 0, "metallicRoughnessTexture": { "index": 0 } },
        "normalTexture": { "index": 0, "scale": 2 },
    });
    let scene = parsed(&material, [RIGHT; 3]);
    assert_eq!(scene.warnings, [], "the loader does not ask for it");
    let found = looks(&scene);
    assert_eq!(found.materials, [Look { normal_scale: 2.0, ..Look::PLAIN }]);
    let [metal, normal] = &found.warnings[..] else { panic!("{:?}", found.warnings) };
    assert!(metal.problem.contains("metallic-roughness texture") && metal.place.contains("missing.png"), "{metal}");
    assert!(normal.problem.contains("as a normal texture") && normal.more == 0, "{normal}");
    let stage = Stage::plain(scene.clone(), Some(standing_sun(DVec3::Y, 0.0)));
    assert_eq!(stage.look_warnings().len(), 2);
    let plain = Stage::plain(Scene { file: None, ..scene }, Some(standing_sun(DVec3::Y, 0.0)));
    let [a, b] = [&stage, &plain].map(|stage| {
        let shot = Shot::new(stage, view(stage, DVec3::new(0.4, 2.0, 0.5), DVec3::new(0.3, 0.0, 0.3), [8, 8]));
        BakedCpu::new(stage, Filter::Bilinear).color(&shot, &stage.moment(0.5)).unwrap().pixels
    });
    assert_eq!(a, b);
    // Nonsense where a number should be costs the material its look, and nothing else.
    let odd = parsed(&json!({ "pbrMetallicRoughness": { "roughnessFactor": "smooth" } }), [RIGHT; 3]);
    let found = looks(&odd);
    assert_eq!((found.materials, found.warnings.len()), (vec![Look::PLAIN], 1));
}

/// A material without a word about metal is a rough metal, as the specification has it; so is no material at all. The
/// older model has no metal.
#[test]
fn what_a_file_does_not_say_is_the_specifications_default() {
    let of = |material: Value| looks(&parsed(&material, [RIGHT; 3])).materials[0];
    let default = Look { metallic: 1.0, ..Look::PLAIN };
    assert_eq!(of(json!({})), default);
    assert_eq!(of(json!({ "pbrMetallicRoughness": { "baseColorFactor": [1, 0, 0, 1] } })), default);
    let factors = json!({ "pbrMetallicRoughness": { "metallicFactor": 7, "roughnessFactor": -1 } });
    assert_eq!(of(factors), Look { roughness: 0.0, ..default });
    let older = json!({ "extensions": { "KHR_materials_pbrSpecularGlossiness": { "glossinessFactor": 0.5 } } });
    assert_eq!(of(older), Look::PLAIN);
    assert_eq!(of(json!({ "extensions": { "KHR_materials_unlit": {} } })), Look::PLAIN);
    let glass = json!({ "extensions": { "KHR_materials_transmission": { "transmissionFactor": 0.75 } } });
    assert_eq!(of(glass), Look { transmission: 0.75, ..default });
    let made = looks(&Scene { file: None, ..parsed(&json!({}), [RIGHT; 3]) });
    assert_eq!(made.materials, [Look::PLAIN]);
}

/// Tangents of the file are taken where they are tangents; else they are computed.
#[test]
fn tangents_of_a_file_are_checked() {
    // One texel of 128, 128, 255.
    let image = "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGNo\
                 aPgPAAODAgAApfuJAAAAAElFTkSuQmCC";
    let read = |tangents| {
        let bytes = triangle(&json!({ "normalTexture": { "index": 0 } }), tangents);
        let text = String::from_utf8_lossy(&bytes[20..]).find("missing.png").map(|at| at + 20).unwrap();
        assert!(bytes[text..].starts_with(b"missing.png"));
        let json_length = u32::from_le_bytes([bytes[12], bytes[13], bytes[14], bytes[15]]) as usize;
        let mut json: Value = serde_json::from_slice(&bytes[20..20 + json_length]).unwrap();
        json["images"][0]["uri"] = image.into();
        let mut text = json.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let rest = &bytes[20 + json_length..];
        let mut glb = b"glTF".to_vec();
        [2, (20 + text.len() + rest.len()) as u32, text.len() as u32].iter().for_each(|n| glb.extend(n.to_le_bytes()));
        glb.extend(b"JSON");
        glb.extend(text);
        glb.extend(rest);
        let scene = parse(Path::new("made.glb"), &glb, &LoadLimits::default()).unwrap();
        let looks = looks(&scene);
        assert!(looks.materials[0].normal_texture.is_some(), "{:?}", looks.warnings);
        (looks.meshes[0].tangents.clone(), looks.warnings.len())
    };
    let turned = [[0.0, 0.0, 1.0, -1.0]; 3];
    assert_eq!(read(turned), (Some(turned.map(glam::Vec4::from_array).to_vec()), 0));
    for bad in [[f32::NAN, 0.0, 0.0, 1.0], [0.0; 4], [1.0, 0.0, 0.0, 0.0]] {
        assert_eq!(read([RIGHT, bad, RIGHT]), (None, 1), "{bad:?}");
    }
}
