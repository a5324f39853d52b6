//! `scene.glb`: what goes in comes back, and others can read it.

use super::{Builder, builder::TRIANGLE, builder::load_bytes, builder::png};
use crate::{
    atlas::{Layout, LayoutOrigin},
    glb::{WrittenScene, write_glb},
    scene::{Alpha, Scene},
};
use glam::{Vec2, Vec3};
use serde_json::json;

/// A layout in which every triangle is a chart of its own.
fn split(scene: &Scene) -> Vec<Layout> {
    let one = |mesh: &crate::scene::Mesh| {
        let count = mesh.indices.len();
        Layout {
            origin: LayoutOrigin::Unwrapped,
            vertices: mesh.indices.clone(),
            uvs: (0..count).map(|i| Vec2::new(i as f32 / count as f32, 0.75)).collect(),
            indices: (0..count as u32).collect(),
        }
    };
    scene.meshes.iter().map(one).collect()
}

/// A scene that was made by code, so that its file is made of it.
fn made_by_code(scene: Scene) -> Scene {
    Scene { file: None, ..scene }
}

fn places(written: &WrittenScene) -> Vec<(usize, usize)> {
    written.places.iter().map(|place| (place.node, place.primitive)).collect()
}

fn rewrite(scene: &Scene) -> (WrittenScene, Scene) {
    let written = write_glb(scene, &split(scene), None).expect("small");
    let again = load_bytes("scene.glb", &written.bytes).unwrap_or_else(|error| panic!("{error}"));
    (written, again)
}

/// Two nodes with one mesh of two primitives, one of which has two triangles, under a turned parent far from the
/// origin.
fn two_by_two() -> Builder {
    let mut b = Builder::new();
    let mesh = b.triangle_mesh(json!({}));
    let square = b.floats(&[TRIANGLE[0], TRIANGLE[1], TRIANGLE[2], [1.0, 1.0, 0.125]]);
    let indices = b.indices(&[0, 1, 2, 2, 1, 3]);
    let second = json!({ "attributes": { "POSITION": square }, "indices": indices });
    b.root["meshes"][mesh]["primitives"].as_array_mut().expect("primitives").push(second);
    b.root["meshes"][mesh]["name"] = json!("Post \"A\"");
    let turn = [0.1, 0.2, 0.3, 0.927];
    b.node(json!({ "name": "yard", "rotation": turn, "translation": [450123.456, 7, 0.1], "children": [1, 2] }));
    b.child(json!({ "name": "post 1", "mesh": mesh, "translation": [0.1, 0.2, 0.3] }));
    b.child(json!({ "mesh": mesh, "scale": [1, -1, 1] }));
    b
}

#[test]
fn nodes_instances_and_triangles_come_back_in_order_and_to_the_last_bit() {
    for scene in [two_by_two().scene(), made_by_code(two_by_two().scene())] {
        come_back(&scene);
    }
}

fn come_back(scene: &Scene) {
    let (written, again) = rewrite(scene);
    assert_eq!(places(&written), [(1, 0), (1, 1), (2, 0), (2, 1)]);
    let found: Vec<_> = again.instances.iter().map(|i| (i.node, again.meshes[i.mesh].gltf.1)).collect();
    assert_eq!(places(&written), found);
    assert_eq!(again.centre_m, scene.centre_m);
    for (a, b) in scene.nodes.iter().zip(&again.nodes) {
        assert_eq!((&a.name, a.parent, a.world_from_node), (&b.name, b.parent, b.world_from_node));
    }
    for (a, b) in scene.instances.iter().zip(&again.instances) {
        assert_eq!((a.bake_from_object, a.is_mirrored), (b.bake_from_object, b.is_mirrored));
        let corners = |scene: &Scene, mesh: usize| -> Vec<Vec3> {
            scene.meshes[mesh].indices.iter().map(|&i| scene.meshes[mesh].positions[i as usize]).collect()
        };
        assert_eq!(corners(scene, a.mesh), corners(&again, b.mesh));
    }
    for (mesh, layout) in again.meshes.iter().zip(split(scene)) {
        let corner_uvs = |uvs: &[Vec2], indices: &[u32]| indices.iter().map(|&i| uvs[i as usize]).collect::<Vec<_>>();
        let baked = mesh.texcoord_set(1).expect("baked coordinates");
        assert_eq!(corner_uvs(baked, &mesh.indices), corner_uvs(&layout.uvs, &layout.indices));
        assert_eq!(mesh.name.as_deref(), Some("Post \"A\""));
    }
}

#[test]
fn the_same_scene_is_the_same_bytes_and_a_second_generation_too() {
    let scene = two_by_two().scene();
    let (first, again) = rewrite(&scene);
    assert!(first.bytes == rewrite(&scene).0.bytes);
    let (second, again) = rewrite(&again);
    assert!(
        second.bytes == rewrite(&again).0.bytes,
        "a second generation adds nothing once the baked set has replaced a missing set 0"
    );
}

#[test]
fn another_reader_that_validates_accepts_it() {
    let (written, _) = rewrite(&made_by_code(two_by_two().scene()));
    let other = gltf::Gltf::from_slice(&written.bytes).expect("valid");
    assert_eq!((other.nodes().count(), other.meshes().count(), other.accessors().count()), (3, 1, 6));
    let blob = other.blob.as_deref();
    let primitive = other.meshes().next().and_then(|mesh| mesh.primitives().nth(1)).expect("two primitives");
    let reader = primitive.reader(|_| blob);
    assert_eq!(reader.read_positions().expect("positions").count(), 6);
    assert_eq!(primitive.bounding_box().max, [1.0, 1.0, 0.125]);
}

#[test]
fn materials_and_images_survive_writing() {
    let mut b = Builder::new();
    let texture = b.texture(&png(&[[255, 0, 0, 255], [0, 255, 0, 0]]));
    b.push("samplers", json!({ "wrapS": 33648, "wrapT": 33071 }));
    b.root["textures"][texture]["sampler"] = json!(0);
    let transform = json!({ "KHR_texture_transform": { "offset": [0.5, 0.25], "rotation": 0.5, "scale": [2, -3] } });
    let info = json!({ "index": texture, "texCoord": 1, "extensions": transform });
    let leaf = json!({ "name": "leaf", "alphaMode": "MASK", "alphaCutoff": 0.3, "doubleSided": true,
        "pbrMetallicRoughness": { "baseColorTexture": info } });
    let glow = json!({ "emissiveFactor": [1, 0.5, 0.25], "alphaMode": "BLEND",
        "pbrMetallicRoughness": { "baseColorFactor": [0.25, 0.5, 0.75, 0.25] },
        "extensions": { "KHR_materials_unlit": {}, "KHR_materials_emissive_strength": { "emissiveStrength": 8 } } });
    let uv = b.floats(&[[0.25f32, 0.5], [0.5, 0.75], [7.0, -3.0]]);
    let color = b.floats(&[[0.5f32, 0.25, 1.0, 1.0]; 3]);
    for (material, attributes) in
        [(leaf, json!({ "TEXCOORD_0": color, "TEXCOORD_1": uv })), (glow, json!({ "COLOR_0": color }))]
    {
        let material = b.push("materials", material);
        let mut attributes = attributes;
        if attributes.get("TEXCOORD_0").is_some() {
            attributes["TEXCOORD_0"] = json!(uv);
        }
        let mesh = b.triangle_mesh_of(attributes, json!({ "material": material }));
        b.node(json!({ "mesh": mesh }));
    }
    for scene in [b.scene(), made_by_code(b.scene())] {
        materials_survive(&scene);
    }
}

fn materials_survive(scene: &Scene) {
    let (_, again) = rewrite(scene);
    for (a, b) in scene.materials.iter().zip(&again.materials) {
        assert_eq!((&a.name, a.base_color, a.emissive, a.alpha), (&b.name, b.base_color, b.emissive, b.alpha));
        assert_eq!((a.is_double_sided, a.is_unlit, a.is_clear), (b.is_double_sided, b.is_unlit, b.is_clear));
    }
    assert_eq!((again.materials[0].alpha, again.materials[1].alpha), (Alpha::Mask { cutoff: 0.3 }, Alpha::Opaque));
    let texture = |scene: &Scene| scene.materials[0].base_color_texture.expect("a texture");
    let (a, b) = (texture(scene), texture(&again));
    assert_eq!((a.texcoord, a.wrap), (b.texcoord, b.wrap));
    let difference = a.image_from_texcoord - b.image_from_texcoord;
    assert!(difference.abs().to_cols_array().iter().all(|&d| d < 1e-6), "{difference}");
    assert_eq!(scene.images[0].rgba, again.images[0].rgba);
    assert_eq!(again.meshes[0].texcoord_set(1), scene.meshes[0].texcoord_set(1), "the file's own set stays");
    assert!(again.meshes[0].texcoord_set(2).is_some(), "and the baked one is the next");
    assert_eq!(again.meshes[1].colors, scene.meshes[1].colors);
}

#[test]
fn more_than_65535_vertices_take_wide_indices() {
    let mut b = Builder::new();
    let positions: Vec<[f32; 3]> = (0..22_000).flat_map(|i| TRIANGLE.map(|[x, y, z]| [x, y, z + i as f32])).collect();
    let position = b.floats(&positions);
    let mesh = b.mesh(json!({ "attributes": { "POSITION": position } }));
    b.node(json!({ "mesh": mesh }));
    let scene = b.scene();
    let (_, again) = rewrite(&scene);
    assert_eq!(scene.meshes[0].positions, again.meshes[0].positions);
    assert_eq!(scene.meshes[0].indices, again.meshes[0].indices);
}

#[test]
fn skinned_meshes_come_back_where_they_stood() {
    let mut b = Builder::new();
    let joints = b.accessor(5121, "VEC4", 3, &[0; 12], json!({}));
    let weights = b.floats(&[[1.0f32, 0.0, 0.0, 0.0]; 3]);
    let mesh = b.triangle_mesh(json!({ "JOINTS_0": joints, "WEIGHTS_0": weights }));
    b.push("skins", json!({ "joints": [1] }));
    b.node(json!({ "mesh": mesh, "skin": 0, "translation": [5, 0, 0] }));
    b.node(json!({ "mesh": mesh, "translation": [0, 0, 9] }));
    let scene = b.scene();
    let (written, again) = rewrite(&scene);
    assert_eq!(places(&written), [(0, 0), (1, 0)]);
    let triangles = |scene: &Scene| crate::scene::Geometry::new(scene).triangles;
    assert_eq!(triangles(&scene), triangles(&again));
    assert_eq!(again.warnings, scene.warnings, "the skin is still there");
}
