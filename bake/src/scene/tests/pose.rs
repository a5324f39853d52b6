//! Skins and morph targets at rest.

use super::{Builder, builder::TRIANGLE};
use crate::scene::Geometry;
use glam::{DMat4, DVec3, Vec3};
use serde_json::json;

/// A triangle skinned to two joints, the third vertex half to each, under a node that is moved and mirrored.
fn skinned(joint_node_is_drawn: bool) -> Builder {
    let mut b = Builder::new();
    let joints = b.accessor(5121, "VEC4", 3, &[0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0], json!({}));
    let weights = b.floats(&[[1.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [2.0, 2.0, 0.0, 0.0]]);
    let normal = b.floats(&[[0.0f32, 0.0, 1.0]; 3]);
    let bind = DMat4::from_translation(DVec3::new(0.0, 0.0, -3.0)).as_mat4().to_cols_array();
    let bind = b.floats(&[bind, bind]);
    let mesh = b.triangle_mesh(json!({ "JOINTS_0": joints, "WEIGHTS_0": weights, "NORMAL": normal }));
    b.push("skins", json!({ "joints": [1, 2], "inverseBindMatrices": bind }));
    b.node(json!({ "mesh": mesh, "skin": 0, "translation": [1000, 0, 0], "scale": [-2, 1, 1] }));
    b.child(json!({ "translation": [0, 0, 13], "children": [2] }));
    b.child(json!({ "translation": [4, 0, 0] }));
    if joint_node_is_drawn {
        b.root["scenes"][0]["nodes"] = json!([0, 1]);
    }
    b
}

#[test]
fn a_skinned_mesh_stands_where_its_joints_are_whatever_its_node_says() {
    for drawn in [true, false] {
        let scene = skinned(drawn).scene();
        let instance = &scene.instances[0];
        let world = |p: Vec3| scene.nodes[instance.node].world_from_node.transform_point3(p.as_dvec3());
        let positions: Vec<DVec3> = scene.meshes[0].positions.iter().map(|&p| world(p)).collect();
        let expected = [[0.0, 0.0, 10.0], [1.0, 0.0, 10.0], [2.0, 1.0, 10.0]].map(DVec3::from_array);
        for (position, expected) in positions.iter().zip(expected) {
            assert!(position.distance(expected) < 1e-3, "{position} instead of {expected}");
        }
        assert!(scene.warnings.iter().any(|w| w.to_string().contains("skin")), "{:?}", scene.warnings);
    }
}

#[test]
fn joints_that_do_not_exist_are_refused_and_missing_weights_leave_the_mesh_under_its_node() {
    let mut b = skinned(true);
    b.root["skins"][0]["joints"] = json!([1, 77]);
    assert!(b.refusal().contains("skins[0] (skin of nodes["), "{}", b.refusal());
    assert!(b.refusal().contains(": its joint 77 is not a node"), "{}", b.refusal());
    let mut b = skinned(true);
    b.root["meshes"][0]["primitives"][0]["attributes"].as_object_mut().expect("attributes").remove("WEIGHTS_0");
    assert_eq!(b.scene().meshes[0].positions[1], Vec3::X);
}

#[test]
fn morph_targets_stand_at_the_weights_of_the_node_else_of_the_mesh() {
    let mut b = Builder::new();
    let delta = b.floats(&[[0.0f32, 0.0, 8.0]; 3]);
    let mesh = b.triangle_mesh_of(json!({}), json!({ "targets": [{ "POSITION": delta }] }));
    b.node(json!({ "mesh": mesh }));
    let height = |b: &Builder, instance: usize| {
        let scene = b.scene();
        scene.meshes[scene.instances[instance].mesh].positions[0].z
    };
    assert_eq!(height(&b, 0), 0.0, "weights default to 0");
    b.root["meshes"][0]["weights"] = json!([0.5]);
    assert_eq!(height(&b, 0), 4.0);
    b.node(json!({ "mesh": mesh, "weights": [0.25] }));
    assert_eq!((height(&b, 0), height(&b, 1)), (4.0, 2.0), "two nodes pose one mesh in two ways");
    assert!(b.scene().warnings.iter().any(|w| w.to_string().contains("morph")));
}

#[test]
fn a_posed_mesh_is_placed_in_bake_space_like_any_other() {
    let scene = skinned(true).scene();
    let geometry = Geometry::new(&scene);
    let third = geometry.triangles[0][2].as_dvec3() + scene.centre_m;
    assert!(third.distance(DVec3::new(2.0, 1.0, 10.0)) < 1e-3, "{third}");
    assert_eq!(TRIANGLE.len(), scene.meshes[0].positions.len());
}
