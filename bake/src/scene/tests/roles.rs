//! Extras say what objects do with light.

use super::builder::Builder;
use crate::scene::{Role, Scene};
use serde_json::{Value, json};

/// A node above another that draws a triangle, with these extras on the upper node, the node, the mesh and the
/// material.
fn scene([above, node, mesh, material]: &[Value; 4]) -> Result<Scene, String> {
    let mut b = Builder::new();
    let index = b.triangle_mesh_of(json!({}), json!({ "material": 0 }));
    b.push("materials", json!({ "extras": material }));
    b.root["meshes"][index]["extras"] = mesh.clone();
    b.node(json!({ "children": [1], "extras": above }));
    b.child(json!({ "mesh": index, "extras": node }));
    b.load().map_err(|error| error.to_string())
}

fn role(extras: &[Value; 4]) -> Role {
    scene(extras).unwrap().instances[0].role
}

#[test]
fn the_nearest_extras_count_and_nodes_pass_theirs_down() {
    let none = || json!({});
    assert_eq!(role(&[none(), none(), none(), json!("a text")]), Role::default());
    assert_eq!(role(&[none(), none(), none(), json!({ "other": 3 })]), Role::default());
    let no_cast = || json!({ "sunbake_no_cast": true });
    for role in [
        role(&[no_cast(), none(), none(), none()]),
        role(&[none(), no_cast(), none(), none()]),
        role(&[none(), none(), no_cast(), none()]),
        role(&[none(), none(), none(), json!({ "sunbake_no_cast": 1 })]),
    ] {
        assert_eq!(role, Role { casts: false, ..Role::default() });
    }
    let casts = json!({ "sunbake_no_cast": false, "sunbake_density": 8 });
    let found = role(&[no_cast(), casts, no_cast(), json!({ "sunbake_density": 2.5, "sunbake_no_receive": true })]);
    assert_eq!(found, Role { receives: false, texels_per_metre: Some(8.0), ..Role::default() });
    let around = role(&[json!({ "sunbake_density_around": 3 }), none(), none(), none()]);
    assert_eq!(around.texels_per_metre_around, Some(3.0));
}

#[test]
fn extras_leave_out() {
    let left_out = scene(&[json!({}), json!({}), json!({ "sunbake_leave_out": true }), json!({})]).unwrap();
    assert!(!left_out.is_there(0) && !left_out.casts(0) && !left_out.receives(0));
    let kept =
        scene(&[json!({ "sunbake_leave_out": true }), json!({ "sunbake_leave_out": false }), json!({}), json!({})]);
    assert!(kept.unwrap().is_there(0));
}

#[test]
fn extras_that_make_no_sense_are_refused_with_their_place() {
    for (extras, words) in [
        (json!({ "sunbake_no_cast": "yes" }), ["nodes[1]", "sunbake_no_cast", "\"yes\"", "true or false"]),
        (json!({ "sunbake_no_cast": 2 }), ["nodes[1]", "sunbake_no_cast", "2", "true or false"]),
        (json!({ "sunbake_density": 0 }), ["nodes[1]", "sunbake_density", "0", "no number"]),
        (json!({ "sunbake_density": [4] }), ["nodes[1]", "sunbake_density", "[4]", "no number"]),
        (json!({ "sunbake_nocast": true }), ["nodes[1]", "sunbake_nocast", "none of that name", "no_cast"]),
        (
            json!({ "sunbake_leave_out": true, "sunbake_density": 3 }),
            ["nodes[1]", "sunbake_leave_out", "leaves out", "it"],
        ),
    ] {
        let message = scene(&[json!({}), extras, json!({}), json!({})]).unwrap_err();
        assert!(words.iter().all(|word| message.contains(word)) && !message.contains('\n'), "{message}");
    }
}

#[test]
fn what_transmits_or_blends_is_clear_unless_extras_say_otherwise() {
    let of_material = |material: Value| {
        let mut b = Builder::new();
        let index = b.triangle_mesh_of(json!({}), json!({ "material": 0 }));
        b.push("materials", material);
        b.node(json!({ "mesh": index }));
        let scene = b.scene();
        (scene.is_there(0), scene.casts(0), scene.receives(0))
    };
    let transmitting = |factor: f64| json!({ "KHR_materials_transmission": { "transmissionFactor": factor } });
    assert_eq!(of_material(json!({ "extensions": transmitting(0.9) })), (true, false, false));
    assert_eq!(of_material(json!({ "extensions": transmitting(0.2) })), (true, true, true));
    let opaque = json!({ "extensions": transmitting(0.9), "extras": { "sunbake_no_cast": false } });
    assert_eq!(of_material(opaque), (true, true, false));
    let color = |alpha: f64| json!({ "baseColorFactor": [1.0, 1.0, 1.0, alpha] });
    let blended = |alpha: f64| json!({ "alphaMode": "BLEND", "pbrMetallicRoughness": color(alpha) });
    assert_eq!(of_material(blended(0.3)), (true, false, false));
    assert_eq!(of_material(blended(0.8)), (true, true, true));
    assert_eq!(of_material(blended(0.0)), (false, false, false));
}
