//! What a bake keeps of a file, and what it asks of it.

use super::tools::{bake, file, must, scene, settings};
use super::{Found, Row};
use std::path::Path;
use sunbake::progress::Silent;
use sunbake::scene::{LoadLimits, load};
use sunbake::settings::{AmbientRequest, BakeSettings};
use sunbake_tests::gltf_diff::{Allowed, lost};

pub const ROWS: &[Row] = &[
    Row::new("01_pbr_keep", "scene.glb says all that the source says", || keeps_all("01_pbr_keep/scene.glb")),
    Row::new("21_decal", "BLEND stays BLEND in scene.glb", blend_stays),
    Row::new("24_emissive", "scene.glb keeps the emissive texture", || keeps_all("24_emissive/scene.glb")),
    Row::new("03_parent_uri", "what nothing needs stops no bake; what is needed is refused by name", missing_files),
    Row::new("06_uv1", "a good TEXCOORD_1 is kept; a line names the meshes of a bad one", second_coordinates),
    Row::new("28_uv1_texture", "a TEXCOORD_1 that a texture tiles is not taken for a light map", tiled_coordinates),
    Row::new("12_rebake", "the atlas stays where a prop moves", the_atlas_stays),
    Row::new("40_dupnames", "both cameras are reachable, and the message lists how", both_cameras),
];

fn bake_to_disk(name: &str, folder: &Path) {
    let settings = BakeSettings { ambient: Some(AmbientRequest::with_rays(16)), page_size_texels: 128, ..settings() };
    sunbake::bake(&file(name), folder, false, &settings, &Silent).unwrap_or_else(|error| panic!("{name}: {error}"));
}

fn keeps_all(name: &str) -> Found {
    let folder = tempfile::tempdir().expect("a folder");
    let set = folder.path().join("set");
    bake_to_disk(name, &set);
    let lost = lost(&file(name), &set.join("scene.glb"), Allowed { occlusion: true });
    must(lost.is_empty(), || lost.join("; "))?;
    Ok("nothing is lost".into())
}

fn blend_stays() -> Found {
    let folder = tempfile::tempdir().expect("a folder");
    let set = folder.path().join("set");
    bake_to_disk("21_decal/scene.glb", &set);
    let bytes = std::fs::read(set.join("scene.glb")).expect("a file");
    let length = u32::from_le_bytes(bytes[12..16].try_into().expect("a word")) as usize;
    let json: serde_json::Value = serde_json::from_slice(&bytes[20..20 + length]).expect("JSON");
    let modes: Vec<_> =
        json["materials"].as_array().expect("a list").iter().map(|one| one["alphaMode"].as_str()).collect();
    must(modes == [None, Some("BLEND"), Some("BLEND")], || format!("{modes:?}"))?;
    keeps_all("21_decal/scene.glb")
}

fn missing_files() -> Found {
    for name in ["normal_only", "http"] {
        let (_, warnings) = bake(&scene(&format!("03_parent_uri/models/{name}.gltf")), &settings());
        must(warnings.len() <= 2, || format!("{name}: {warnings:?}"))?;
    }
    let refused = load(&file("03_parent_uri/models/base.gltf"), &LoadLimits::default());
    let text = refused.err().map(|error| error.to_string()).unwrap_or_default();
    must(text.contains("../textures/brick.png"), || format!("refused with: {text}"))?;
    Ok("two bake, and ../textures/brick.png is named".into())
}

fn second_coordinates() -> Found {
    let unwrapped = |name: &str| -> Option<String> {
        let (_, warnings) = bake(&scene(&format!("06_uv1/{name}.glb")), &settings());
        warnings.into_iter().find(|line| line.contains("TEXCOORD_1"))
    };
    for name in ["good", "rightbit", "none"] {
        let line = unwrapped(name);
        must(line.is_none(), || format!("{name}: {line:?}"))?;
    }
    for name in ["overlap", "udim"] {
        let line = unwrapped(name).unwrap_or_default();
        must(line.contains("meshes[") || line.contains('"'), || format!("{name}: {line}"))?;
    }
    Ok("good and rightbit are kept, overlap and udim named and unwrapped".into())
}

fn tiled_coordinates() -> Found {
    let (baked, warnings) = bake(&scene("28_uv1_texture/scene.glb"), &settings());
    let line = warnings.iter().find(|line| line.contains("TEXCOORD_1")).cloned().unwrap_or_default();
    let own: Vec<u32> = baked.manifest.instances.iter().map(|entry| entry.uv_set).collect();
    let text = format!("the bake's coordinates are in TEXCOORD_n, n {own:?}; {line}");
    must(!own.is_empty(), || text.clone())?;
    Ok(text)
}

fn the_atlas_stays() -> Found {
    let places = |name: &str| {
        let (baked, _) = bake(&scene(name), &settings());
        baked.manifest.instances.iter().map(|e| (e.node, e.atlas, e.uv_scale, e.uv_offset)).collect::<Vec<_>>()
    };
    let [before, after] = ["12_rebake/move0.glb", "12_rebake/move1.5.glb"].map(places);
    must(before == after, || "rectangles moved".into())?;
    Ok(format!("{} rectangles are where they were", before.len()))
}

fn both_cameras() -> Found {
    let run = |camera: &str| {
        let folder = tempfile::tempdir().expect("a folder");
        let picture = folder.path().join("picture.png");
        let mut command = std::process::Command::new(sunbake_tests::built_program("sunplay"));
        command.arg("frame").arg(file("40_dupnames/scene.glb")).arg("-o").arg(&picture);
        command.args(["--camera", camera, "--size", "32x18", "--technique", "truth:hard", "--renderer", "cpu"]);
        let output = command.output().expect("it starts");
        (output.status.success(), std::fs::read(&picture).ok(), sunbake_tests::stderr(&output))
    };
    let [first, second, unknown] = ["camera:0", "camera:1", "nothing"].map(run);
    must(first.0 && second.0 && first.1 != second.1, || format!("{} {}", first.2, second.2))?;
    must(unknown.2.contains("Camera, camera:1 (also named Camera)"), || unknown.2.clone())?;
    Ok("two different pictures; an unknown name lists Camera and camera:1".into())
}
