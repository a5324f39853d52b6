//! Materials, images, and how alpha is read.

use super::{Builder, builder::png};
use crate::scene::{Alpha, Material, Scene, Wrap};
use glam::{Mat3, Vec2, Vec3, Vec4};
use serde_json::{Value, json};

fn with_material(b: &mut Builder, attributes: Value, material: Value) -> Scene {
    let material = b.push("materials", material);
    let mesh = b.triangle_mesh_of(attributes, json!({ "material": material }));
    b.node(json!({ "mesh": mesh }));
    b.scene()
}

fn material_of(material: Value) -> Material {
    with_material(&mut Builder::new(), json!({}), material).materials.remove(0)
}

fn alpha_of(mode: Value, factor: f32, texels: &[[u8; 4]]) -> Alpha {
    let mut b = Builder::new();
    let texture = b.texture(&png(texels));
    let mut material = mode;
    material["pbrMetallicRoughness"] =
        json!({ "baseColorFactor": [1, 1, 1, factor], "baseColorTexture": { "index": texture } });
    with_material(&mut b, json!({}), material).materials[0].alpha
}

const CLEAR: [u8; 4] = [9, 9, 9, 0];
const HALF: [u8; 4] = [9, 9, 9, 128];
const SOLID: [u8; 4] = [9, 9, 9, 255];

/// B13.
#[test]
fn blended_surfaces_are_masked_at_one_half_and_clear_where_nothing_reaches_it() {
    let blend = || json!({ "alphaMode": "BLEND" });
    assert_eq!(alpha_of(blend(), 1.0, &[CLEAR, SOLID]), Alpha::Mask { cutoff: 0.5 });
    assert_eq!(alpha_of(blend(), 0.4, &[CLEAR, SOLID]), Alpha::Opaque, "glass");
    assert_eq!(alpha_of(blend(), 1.0, &[CLEAR, [9, 9, 9, 120]]), Alpha::Opaque, "no point reaches the cutoff");
    assert_eq!(alpha_of(blend(), 0.0, &[SOLID]), Alpha::Invisible, "nothing can be seen");
    assert_eq!(alpha_of(blend(), 1.0, &[HALF, SOLID]), Alpha::Opaque, "no point is below the cutoff");
    assert_eq!(alpha_of(blend(), 0.9, &[HALF, SOLID]), Alpha::Mask { cutoff: 0.5 });
    assert_eq!(alpha_of(json!({}), 0.1, &[CLEAR]), Alpha::Opaque, "OPAQUE ignores alpha");
}

/// B13.
#[test]
fn masks_keep_their_cutoff_and_the_ends_of_its_range_mean_what_they_say() {
    let mask = |cutoff: f32| json!({ "alphaMode": "MASK", "alphaCutoff": cutoff });
    assert_eq!(alpha_of(mask(0.25), 1.0, &[CLEAR, SOLID]), Alpha::Mask { cutoff: 0.25 });
    assert_eq!(alpha_of(json!({ "alphaMode": "MASK" }), 1.0, &[CLEAR, SOLID]), Alpha::Mask { cutoff: 0.5 });
    assert_eq!(alpha_of(mask(0.0), 1.0, &[CLEAR, SOLID]), Alpha::Opaque, "nothing is below 0");
    assert_eq!(alpha_of(mask(1.0), 1.0, &[CLEAR, SOLID]), Alpha::Mask { cutoff: 1.0 });
    assert_eq!(alpha_of(mask(1.0), 1.0, &[SOLID]), Alpha::Opaque);
}

#[test]
fn vertex_alpha_counts() {
    for (alpha, is_clear) in [(0.25f32, true), (1.0, false)] {
        let mut b = Builder::new();
        let color = b.floats(&[[1.0, 0.5, 2.0, alpha]; 3]);
        let scene = with_material(&mut b, json!({ "COLOR_0": color }), json!({ "alphaMode": "BLEND" }));
        assert_eq!((scene.materials[0].alpha, scene.materials[0].is_clear), (Alpha::Opaque, is_clear));
        let colors = scene.meshes[0].colors.as_ref().expect("colours");
        assert_eq!(colors[0], Vec4::new(1.0, 0.5, 1.0, alpha), "colours are clamped");
    }
}

#[test]
fn the_older_diffuse_colour_stands_in_where_there_is_no_newer_one() {
    let older = || json!({ "KHR_materials_pbrSpecularGlossiness": { "diffuseFactor": [0.5, 0.25, 0, 1] } });
    let material = material_of(json!({ "extensions": older() }));
    assert_eq!(material.base_color, Vec4::new(0.5, 0.25, 0.0, 1.0));
    let newer = json!({ "baseColorFactor": [1, 0, 0, 1] });
    let material = material_of(json!({ "extensions": older(), "pbrMetallicRoughness": newer }));
    assert_eq!(material.base_color, Vec4::new(1.0, 0.0, 0.0, 1.0));
}

#[test]
fn unlit_emission_and_sides_are_read() {
    let material = material_of(json!({
        "name": "lamp", "doubleSided": true, "emissiveFactor": [1, 0.5, 0],
        "extensions": { "KHR_materials_unlit": {}, "KHR_materials_emissive_strength": { "emissiveStrength": 4 } },
    }));
    assert_eq!(material.emissive, Vec3::new(4.0, 2.0, 0.0));
    assert!(material.is_unlit && material.is_double_sided);
    assert_eq!(material.name.as_deref(), Some("lamp"));
}

#[test]
fn a_texture_transform_turns_coordinates_and_chooses_their_set() {
    let mut b = Builder::new();
    let texture = b.texture(&png(&[SOLID]));
    b.push("samplers", json!({ "wrapS": 33071, "wrapT": 33648 }));
    b.root["textures"][0]["sampler"] = json!(0);
    let transform = json!({ "KHR_texture_transform": { "offset": [0.5, 0.25], "scale": [2, 3], "texCoord": 1 } });
    let info = json!({ "index": texture, "texCoord": 0, "extensions": transform });
    let scene = with_material(&mut b, json!({}), json!({ "pbrMetallicRoughness": { "baseColorTexture": info } }));
    let texture = scene.materials[0].base_color_texture.expect("a texture");
    assert_eq!((texture.texcoord, texture.wrap), (1, [Wrap::Clamp, Wrap::Mirror]));
    assert_eq!(texture.image_from_texcoord.transform_point2(Vec2::ONE), Vec2::new(2.5, 3.25));
}

#[test]
fn a_picture_may_use_any_set_of_coordinates() {
    let mut b = Builder::new();
    let texture = b.texture(&png(&[SOLID]));
    let sets = [0.25f32, 0.5, 0.75].map(|u| b.floats(&[[u, u]; 3]));
    let attributes = json!({ "TEXCOORD_0": sets[0], "TEXCOORD_1": sets[1], "TEXCOORD_2": sets[2] });
    let info = json!({ "index": texture, "texCoord": 2 });
    let scene = with_material(&mut b, attributes, json!({ "pbrMetallicRoughness": { "baseColorTexture": info } }));
    let first = |set: usize| scene.meshes[0].texcoord_set(set).expect("a set")[0];
    assert_eq!([0, 1, 2].map(first), [0.25, 0.5, 0.75].map(Vec2::splat));
    let texture = scene.materials[0].base_color_texture.expect("a texture");
    assert_eq!((texture.texcoord, texture.image_from_texcoord), (2, Mat3::IDENTITY));
}

#[test]
fn an_unusable_image_is_a_warning_for_colour_and_an_error_for_alpha() {
    let webp = b"RIFF\x10\0\0\0WEBPVP8 ".as_slice();
    let cut_png = &png(&[SOLID])[..40];
    for (bytes, cause) in [(webp, "it is WebP"), (b"nonsense", "neither PNG nor JPEG"), (cut_png, "")] {
        let mut b = Builder::new();
        let texture = b.texture(bytes);
        let pbr = json!({ "baseColorTexture": { "index": texture }, "baseColorFactor": [1, 0, 0, 1] });
        let scene = with_material(&mut b, json!({}), json!({ "pbrMetallicRoughness": pbr }));
        assert!(
            scene.warnings[0].to_string().contains("drawn in its plain colour")
                && scene.warnings[0].to_string().contains(cause)
        );
        assert!(scene.images.is_empty() && scene.materials[0].base_color_texture.is_none());
        for mode in ["MASK", "BLEND"] {
            b.root["materials"][0]["alphaMode"] = json!(mode);
            let refusal = b.refusal();
            assert!(refusal.contains("materials[0] has an alpha mask in images[0]"), "{refusal}");
            assert!(refusal.contains(cause), "{refusal}");
        }
    }
}

#[test]
fn a_broken_jpeg_never_had_alpha_so_its_mask_still_bakes() {
    let mut b = Builder::new();
    let texture = b.texture(&[0xFF, 0xD8, 0xFF, 0xE0, 0, 0]);
    let pbr = json!({ "baseColorTexture": { "index": texture } });
    let scene = with_material(&mut b, json!({}), json!({ "alphaMode": "MASK", "pbrMetallicRoughness": pbr }));
    assert_eq!(scene.materials[0].alpha, Alpha::Opaque);
}

#[test]
fn only_images_that_a_drawn_material_shows_are_decoded() {
    let mut b = Builder::new();
    let texture = b.texture(&png(&[SOLID, CLEAR]));
    let unused = b.texture(b"nonsense");
    b.push("materials", json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": unused } } }));
    let pbr = json!({ "baseColorTexture": { "index": texture } });
    let scene =
        with_material(&mut b, json!({}), json!({ "pbrMetallicRoughness": pbr, "normalTexture": { "index": 1 } }));
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    assert_eq!((scene.images.len(), scene.materials.len()), (1, 1));
    assert_eq!((scene.images[0].width, scene.images[0].rgba.as_slice()), (2, [SOLID, CLEAR].as_slice()));
}

#[test]
fn the_default_material_comes_last_and_stands_in_for_one_that_is_missing() {
    let mut b = Builder::triangle(json!({}));
    with_material(&mut b, json!({}), json!({ "name": "named" }));
    let lost = b.triangle_mesh_of(json!({}), json!({ "material": 99 }));
    b.node(json!({ "mesh": lost }));
    let scene = b.scene();
    let names: Vec<Option<&str>> = scene.materials.iter().map(|m| m.name.as_deref()).collect();
    assert_eq!(names, [Some("named"), None]);
    assert_eq!(scene.meshes.iter().map(|m| m.material).collect::<Vec<_>>(), [1, 0, 1]);
    let sentences: Vec<String> = scene.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(sentences, ["meshes[2] primitive 0: its material does not exist; the default material is used"]);
}
