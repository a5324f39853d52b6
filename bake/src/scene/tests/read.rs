//! Geometry, nodes and what hangs under them.

use super::{Builder, builder::TRIANGLE};
use crate::scene::{Dropped, Geometry, Scene};
use glam::{DMat4, DVec3, Vec2, Vec3, Vec4};
use serde_json::json;

fn corners(scene: &Scene) -> Vec<[Vec3; 3]> {
    Geometry::new(scene).triangles
}

#[test]
fn lists_strips_and_fans_indexed_or_not_give_the_same_square() {
    let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    let ring = [square[0], square[1], square[3], square[2]];
    for (mode, positions, indices) in [
        (4, square, Some(vec![0, 1, 2, 2, 1, 3])),
        (5, square, None),
        (5, ring, Some(vec![0, 1, 3, 2])),
        (6, ring, None),
        (6, square, Some(vec![0, 1, 3, 2])),
    ] {
        let mut b = Builder::new();
        let mut primitive = json!({ "mode": mode, "attributes": { "POSITION": b.floats(&positions) } });
        if let Some(indices) = indices {
            primitive["indices"] = json!(b.indices(&indices));
        }
        let mesh = b.mesh(primitive);
        b.node(json!({ "mesh": mesh }));
        let scene = b.scene();
        let geometry = Geometry::new(&scene);
        assert_eq!(geometry.triangles.len(), 2, "mode {mode}");
        assert!((0..2).all(|t| geometry.normal(t) == DVec3::Z), "mode {mode}");
    }
}

#[test]
fn points_and_lines_are_left_out_with_a_warning() {
    let mut b = Builder::triangle(json!({}));
    for mode in 0..4 {
        let mesh = b.triangle_mesh_of(json!({}), json!({ "mode": mode }));
        b.node(json!({ "mesh": mesh }));
    }
    let scene = b.scene();
    assert_eq!(scene.triangle_count(), 1);
    let sentences: Vec<String> = scene.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(sentences, ["meshes[1] primitive 0 and 3 more: points and lines cast no shadow; left out"]);
}

#[test]
fn sparse_values_replace_those_of_their_base_or_zeros() {
    let replaced = [[4.0f32, 4.0, 4.0], [0.0, 8.0, 0.0]];
    let bytes: Vec<u8> = replaced.iter().flatten().flat_map(|v| v.to_le_bytes()).collect();
    for (has_base, kept) in [(true, Vec3::X), (false, Vec3::ZERO)] {
        let mut b = Builder::triangle(json!({}));
        let (indices, values) = (b.view(&[0, 2]), b.view(&bytes));
        let accessor = &mut b.root["accessors"][0];
        accessor["sparse"] = json!({
            "count": 2,
            "indices": { "bufferView": indices, "componentType": 5121 },
            "values": { "bufferView": values },
        });
        if !has_base {
            accessor.as_object_mut().expect("accessor").remove("bufferView");
        }
        assert_eq!(b.scene().meshes[0].positions, [Vec3::splat(4.0), kept, Vec3::Y * 8.0]);
        b.root["accessors"][0]["sparse"]["indices"]["byteOffset"] = json!(1);
        assert!(b.refusal().contains("bufferViews[1], which has 2"), "{}", b.refusal());
    }
}

#[test]
fn normalised_integers_become_fractions() {
    let mut b = Builder::new();
    let normalised = json!({ "normalized": true });
    let bytes: Vec<u8> = [0u16, 65535, 32768, 0, 0, 13107].iter().flat_map(|v| v.to_le_bytes()).collect();
    let uv0 = b.accessor(5123, "VEC2", 3, &bytes, normalised.clone());
    let uv1 = b.accessor(5121, "VEC2", 3, &[0, 255, 51, 0, 0, 0], normalised.clone());
    let color = b.accessor(5121, "VEC3", 3, &[255, 0, 51, 0, 0, 0, 0, 0, 0], normalised);
    let mesh = b.triangle_mesh(json!({ "TEXCOORD_0": uv0, "TEXCOORD_1": uv1, "COLOR_0": color }));
    b.node(json!({ "mesh": mesh }));
    let mesh = &b.scene().meshes[0];
    let [uv0, uv1] = [0, 1].map(|set| mesh.texcoord_set(set).expect("a set"));
    assert_eq!(uv0[0], Vec2::new(0.0, 1.0));
    assert_eq!(uv0[2], Vec2::new(0.0, 0.2));
    assert_eq!((uv1[0], uv1[1]), (Vec2::new(0.0, 1.0), Vec2::new(0.2, 0.0)));
    assert_eq!(mesh.colors.as_ref().expect("colours")[0], Vec4::new(1.0, 0.0, 0.2, 1.0));
}

#[test]
fn quantised_positions_are_read_normalised_or_not_and_strided() {
    let signed: Vec<u8> = [0i8, 0, 0, 99, 127, 0, 0, 99, 0, -128, 0, 99].map(|v| v as u8).to_vec();
    for (normalized, expected) in [(true, Vec3::NEG_Y), (false, Vec3::new(0.0, -128.0, 0.0))] {
        let mut b = Builder::new();
        let position = b.accessor(5120, "VEC3", 3, &signed, json!({ "normalized": normalized }));
        let view = b.root["accessors"][position]["bufferView"].as_u64().expect("a view") as usize;
        b.root["bufferViews"][view]["byteStride"] = json!(4);
        b.root["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
        let mesh = b.mesh(json!({ "attributes": { "POSITION": position } }));
        b.node(json!({ "mesh": mesh }));
        assert_eq!(b.scene().meshes[0].positions[2], expected);
    }
}

/// B3.
#[test]
fn map_coordinates_keep_their_millimetres_through_node_translations() {
    let mut b = Builder::triangle(json!({ "translation": [2682808.123, 408.5, -1247654.321] }));
    let other = json!({ "mesh": 0, "translation": [2682808.125, 408.5, -1247654.321] });
    let parent = json!({ "children": [1], "matrix": DMat4::IDENTITY.to_cols_array() });
    b.child(other);
    b.node(parent);
    let scene = b.scene();
    let shift = scene.instances[1].bake_from_object.w_axis.x - scene.instances[0].bake_from_object.w_axis.x;
    assert!((shift - 0.002).abs() < 1e-9, "{shift}");
    assert_eq!(scene.nodes[0].world_from_node.w_axis.x, 2682808.123);
    assert!(scene.instances.iter().all(|i| i.bake_from_object.w_axis.truncate().length() < 2.0));
}

/// B3.
#[test]
fn a_scene_moved_by_a_million_metres_is_the_same_in_bake_space() {
    let at = |x: f64, z: f64| {
        let mut b = Builder::triangle(json!({ "translation": [x, 0.3, z], "rotation": [0.0, 0.6, 0.0, 0.8] }));
        b.node(json!({ "mesh": 0, "translation": [x + 21.5, 7.25, z] }));
        corners(&b.scene())
    };
    assert_eq!(at(0.5, 0.25), at(1e6 + 0.5, -3e6 + 0.25));
}

/// B12.
#[test]
fn a_mesh_under_many_nodes_is_kept_once_and_a_mesh_under_none_not_at_all() {
    let mut b = Builder::triangle(json!({}));
    for i in 0..159 {
        b.node(json!({ "mesh": 0, "translation": [i, 0, 1] }));
    }
    let unused = b.triangle_mesh(json!({}));
    b.child(json!({ "mesh": unused }));
    let scene = b.scene();
    assert_eq!((scene.meshes.len(), scene.instances.len(), scene.nodes.len()), (1, 160, 160));
}

/// B11.
#[test]
fn fronts_stay_fronts_under_mirrors_scales_and_shears() {
    let shear = [1.0, 0.0, 0.0, 0.0, 0.5, 1.0, 0.0, 0.0, 0.25, 0.75, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    for (node, mirrored) in [
        (json!({ "scale": [-1, 1, 1] }), true),
        (json!({ "scale": [3, 0.1, 1] }), false),
        (json!({ "scale": [-2, -1, 5] }), false),
        (json!({ "matrix": shear }), false),
        (json!({ "scale": [1, 1, -1] }), true),
        (json!({ "rotation": [0.5, -0.5, 0.5, 0.5], "scale": [1, -7, 2] }), true),
    ] {
        let scene = Builder::triangle(node.clone()).scene();
        let instance = &scene.instances[0];
        assert_eq!(instance.is_mirrored, mirrored, "{node}");
        // A front normal is a plane's normal: it goes through the inverse transpose, sign included.
        let expected = instance.bake_from_object.inverse().transpose().transform_vector3(DVec3::Z).normalize();
        let normal = Geometry::new(&scene).normal(0);
        assert!(normal.distance(expected) < 1e-6, "{node}: {normal} instead of {expected}");
    }
}

#[test]
fn nodes_without_volume_are_left_out_with_all_below_them() {
    let mut b = Builder::triangle(json!({}));
    b.node(json!({ "name": "flat", "scale": [1, 0, 1], "children": [2] }));
    b.child(json!({ "mesh": 0 }));
    let scene = b.scene();
    assert_eq!(scene.instances.len(), 1);
    assert!(
        scene.warnings[0].to_string().contains("nodes[1] \"flat\": its matrix is singular"),
        "{:?}",
        scene.warnings
    );
    let alone = Builder::triangle(json!({ "scale": [0, 0, 0] })).refusal();
    assert!(alone.contains("draws no triangles") && alone.contains("singular"), "{alone}");
}

/// B4.
#[test]
fn small_and_large_scenes_are_read_alike() {
    for size in [1e-4, 1.0, 1e4] {
        let scene = Builder::triangle(json!({ "scale": [size, size, size] })).scene();
        assert!((scene.half_extent_m - DVec3::new(0.5, 0.5, 0.0) * size).length() < size * 1e-9);
        assert!(Geometry::new(&scene).casts(&scene, 0));
    }
}

/// B7.
#[test]
fn bad_triangles_are_counted_and_the_rest_is_kept() {
    let mut b = Builder::new();
    let nan = f32::NAN;
    let positions = [TRIANGLE[0], TRIANGLE[1], TRIANGLE[2], [nan, 0.0, 0.0], [f32::INFINITY; 3], [2.0, 0.0, 0.0]];
    let position = b.floats(&positions);
    let indices = b.indices(&[0, 1, 2, 0, 1, 3, 4, 1, 2, 0, 0, 1, 0, 1, 5, 0, 1, 2]);
    let normal = b.floats(&[[0.0, 0.0, 2.0], [nan; 3], [0.0; 3], [1.0; 3], [1.0; 3], [1.0; 3]]);
    let mesh = b.mesh(json!({ "attributes": { "POSITION": position, "NORMAL": normal }, "indices": indices }));
    b.node(json!({ "mesh": mesh }));
    let scene = b.scene();
    assert_eq!(scene.dropped, Dropped { repeated_index: 1, zero_area: 1, non_finite: 2 });
    assert_eq!(scene.triangle_count(), 2);
    assert_eq!(scene.meshes[0].positions.len(), 3, "unused vertices are removed, among them the broken ones");
    assert_eq!(scene.meshes[0].normals.as_deref(), Some([Vec3::Z; 3].as_slice()), "normals are repaired");
}

#[test]
fn the_scene_drawn_is_the_default_else_the_first_else_every_root() {
    let mut b = Builder::triangle(json!({ "name": "first" }));
    b.child(json!({ "name": "second", "mesh": 0 }));
    b.push("scenes", json!({ "nodes": [1] }));
    let name = |b: &Builder| b.scene().nodes.iter().map(|n| n.name.clone().unwrap_or_default()).collect::<Vec<_>>();
    assert_eq!(name(&b), ["first"]);
    b.root["scene"] = json!(1.0);
    assert_eq!(name(&b), ["second"], "1.0 is an index too");
    b.root.as_object_mut().expect("root").remove("scene");
    assert_eq!(name(&b), ["first"]);
    b.root.as_object_mut().expect("root").remove("scenes");
    assert_eq!(name(&b), ["first", "second"]);
}

#[test]
fn hidden_nodes_are_not_drawn() {
    let mut b = Builder::triangle(json!({}));
    b.node(json!({ "mesh": 0, "extensions": { "KHR_node_visibility": { "visible": false } } }));
    assert_eq!(b.scene().instances.len(), 1);
}

#[test]
fn a_hundred_thousand_nodes_in_a_chain_are_read() {
    let mut b = Builder::triangle(json!({ "children": [1] }));
    for i in 1..100_000 {
        b.child(json!({ "children": [i + 1], "translation": [0.001, 0, 0] }));
    }
    b.child(json!({ "mesh": 0 }));
    let scene = b.scene();
    assert_eq!(scene.nodes.len(), 100_001);
    assert!((scene.nodes[100_000].world_from_node.w_axis.x - 99.999).abs() < 1e-6);
}

#[test]
fn perspective_cameras_are_rigid_and_others_are_left_out() {
    let mut b = Builder::triangle(json!({}));
    b.push("cameras", json!({ "type": "perspective", "perspective": { "yfov": 0.8, "znear": 0.1 } }));
    b.push("cameras", json!({ "type": "orthographic", "orthographic": { "xmag": 1, "ymag": 1 } }));
    b.node(json!({ "name": "eye", "camera": 0, "scale": [2, 3, -4], "translation": [5, 6, 7] }));
    b.node(json!({ "camera": 1 }));
    let scene = b.scene();
    let camera = &scene.cameras[0];
    assert_eq!((scene.cameras.len(), camera.name.as_deref(), camera.fov_y_rad), (1, Some("eye"), 0.8));
    assert!((camera.bake_from_camera.determinant() - 1.0).abs() < 1e-12);
    assert_eq!(camera.bake_from_camera.w_axis.truncate() + scene.centre_m, DVec3::new(5.0, 6.0, 7.0));
    let sentences: Vec<String> = scene.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(sentences, ["cameras[1]: only perspective cameras are read; left out"]);
}

#[test]
fn the_first_directional_light_is_the_sun() {
    let mut b = Builder::triangle(json!({}));
    b.root["extensions"] =
        json!({ "KHR_lights_punctual": { "lights": [{ "type": "point" }, { "type": "directional" }] } });
    let light = |index| json!({ "KHR_lights_punctual": { "light": index } });
    b.node(json!({ "extensions": light(0) }));
    assert_eq!(b.scene().sun_direction, None);
    // Turned a quarter about X, it shines down -Y instead of along -Z.
    let quarter = std::f64::consts::FRAC_1_SQRT_2;
    b.node(json!({ "extensions": light(1), "rotation": [-quarter, 0.0, 0.0, quarter], "scale": [2, 2, 2] }));
    let sun = b.scene().sun_direction.expect("a sun");
    assert!(sun.distance(DVec3::Y) < 1e-12, "{sun}");
}

#[test]
fn the_same_file_gives_the_same_hash_and_another_file_another() {
    let a = Builder::triangle(json!({})).scene().source;
    let b = Builder::triangle(json!({ "name": "other" })).scene().source;
    assert_eq!(a, Builder::triangle(json!({})).scene().source);
    assert_ne!(a.sha256, b.sha256);
    assert_eq!((a.file_name.as_str(), a.sha256.len()), ("built.glb", 64));
}

#[test]
fn copies_by_gpu_instancing_are_plain_nodes() {
    let quarter = std::f32::consts::FRAC_1_SQRT_2;
    let (places, turns) =
        ([[1.0f32, 2.0, 3.0], [-4.0, 0.5, 0.0]], [[0.0, quarter, 0.0, quarter], [0.0, 0.0, 0.0, 1.0]]);
    let placed = json!({ "translation": [10, 0, 0], "scale": [2, 2, 2] });
    let mut b = Builder::triangle(placed.clone());
    let child = b.child(json!({ "name": "child", "translation": [0, 1, 0] }));
    let attributes = json!({ "TRANSLATION": b.floats(&places), "ROTATION": b.floats(&turns) });
    b.root["nodes"][0]["children"] = json!([child]);
    b.root["nodes"][0]["extensions"] = json!({ "EXT_mesh_gpu_instancing": { "attributes": attributes } });
    b.root["extensionsRequired"] = json!(["EXT_mesh_gpu_instancing"]);
    let copied = b.scene();

    let mut plain = Builder::new();
    let mesh = plain.triangle_mesh(json!({}));
    let copies: Vec<usize> =
        (0..2).map(|i| plain.child(json!({ "mesh": mesh, "translation": places[i], "rotation": turns[i] }))).collect();
    let child = plain.child(json!({ "name": "child", "translation": [0, 1, 0] }));
    let mut parent = placed;
    parent["children"] = json!([copies[0], copies[1], child]);
    plain.node(parent);
    let plain = plain.scene();

    let nodes = |scene: &Scene| scene.nodes.iter().map(|n| (n.name.clone(), n.parent)).collect::<Vec<_>>();
    assert_eq!(nodes(&copied), nodes(&plain));
    assert_eq!((copied.meshes.len(), copied.instances.len()), (1, 2));
    for (a, b) in copied.instances.iter().zip(&plain.instances) {
        assert_eq!(a.node, b.node);
        assert!(a.bake_from_object.abs_diff_eq(b.bake_from_object, 1e-6), "{:?}", [a, b]);
    }
}
