//! A stock viewer shows the same of a model before and after a bake without ambient occlusion.
//!
//! With `SUNBAKE_KEEP_PICTURES` set to a folder, the pictures stay there, to be looked at.

use image::RgbImage;
use libtest_mimic::Trial;
use std::path::{Path, PathBuf};
use sunbake::progress::Silent;
use sunbake::settings::{BakeSettings, SunRequest};
use sunbake_tests::june_day;
use sunbake_tests::needs::{Need, gas_station, shared, trial, workspace};
use sunbake_tests::viewer::pictures;

/// Channels further apart than this, of 255, count as different.
const SAME: u8 = 2;
/// Largest share of a picture's pixels that may differ: those on edges, where splitting a strip changes the order in
/// which triangles are drawn.
const MOST_DIFFERENT: f64 = 1e-3;
/// Least share of a picture's pixels that must show the model.
const LEAST_SHOWN: f64 = 0.02;

/// Finished models: PBR, textures in the file and beside it, vertex colours, blending, instances.
const CASES: [&str; 4] = ["01_pbr_keep", "24_emissive", "07_quantised/q.glb", "21_decal"];

const SCENES: [&str; 10] = [
    "box_textured/BoxTextured.glb",
    "box_textured/CornellBox.glb",
    "gazebo_thin/tower_crane.glb",
    "gazebo_thin/oak_tree.glb",
    "gazebo_thin/playground.glb",
    "japanese_bridge_garden/japanese_bridge_garden.glb",
    "littlest_tokyo/littlest_tokyo.glb",
    "pc_house/house.glb",
    "truck_town/truck_town.glb",
    "two_cylinder_engine/2CylinderEngine.glb",
];

fn share_different(a: &RgbImage, b: &RgbImage) -> f64 {
    let differs = |(a, b): &(&image::Rgb<u8>, &image::Rgb<u8>)| a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > SAME);
    a.pixels().zip(b.pixels()).filter(differs).count() as f64 / f64::from(a.width() * a.height())
}

fn shows_the_same(files: &[PathBuf]) {
    let folder = tempfile::tempdir().unwrap();
    let settings =
        BakeSettings { page_size_texels: 256, ambient: None, ..BakeSettings::standard(SunRequest::Day(june_day())) };
    let bake = |(index, file): (usize, &PathBuf)| {
        let set = folder.path().join(index.to_string());
        sunbake::bake(file, &set, false, &settings, &Silent).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
        set.join("scene.glb")
    };
    let baked: Vec<PathBuf> = files.iter().enumerate().map(bake).collect();
    let (before, after) = (pictures(files), pictures(&baked));
    let kept = std::env::var_os("SUNBAKE_KEEP_PICTURES").map(PathBuf::from);
    let mut wrong = Vec::new();
    for (file, (before, after)) in files.iter().zip(before.iter().zip(&after)) {
        for (side, (a, b)) in before.iter().zip(after).enumerate() {
            let name = file.strip_prefix(workspace()).unwrap_or(file).display().to_string().replace(['/', '.'], "_");
            kept.iter().for_each(|folder| keep(folder, &format!("{name}_{side}"), a, b));
            let corner = a.get_pixel(0, 0);
            let shown = a.pixels().filter(|pixel| *pixel != corner).count() as f64 / f64::from(a.width() * a.height());
            let different = share_different(a, b);
            println!("{name} side {side}: {:.3} % differ, {:.0} % shown", 100.0 * different, 100.0 * shown);
            if different > MOST_DIFFERENT || shown < LEAST_SHOWN {
                wrong.push(format!("{name} side {side}: {:.3} % of its pixels", 100.0 * different));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

fn keep(folder: &Path, name: &str, before: &RgbImage, after: &RgbImage) {
    let mut both = RgbImage::new(before.width() * 2, before.height());
    image::imageops::replace(&mut both, before, 0, 0);
    image::imageops::replace(&mut both, after, i64::from(before.width()), 0);
    both.save(folder.join(format!("{name}.png"))).unwrap();
}

pub fn trials() -> Vec<Trial> {
    let needs = || vec![Need::viewer(), Need::browser()];
    let case = |name: &&str| {
        workspace().join("tests/cases").join(match name.ends_with(".glb") {
            true => (*name).to_owned(),
            false => format!("{name}/scene.glb"),
        })
    };
    let own: Vec<PathBuf> = CASES.iter().map(case).chain([gas_station()]).collect();
    let scenes: Vec<PathBuf> = SCENES.iter().map(|name| shared("scenes").join(name)).collect();
    let with_scenes = needs().into_iter().chain([Need::shared("scenes")]).collect();
    vec![
        trial("a_stock_viewer_shows_the_same_of_finished_models", needs(), move || shows_the_same(&own)),
        trial("a_stock_viewer_shows_the_same_of_shared_scenes", with_scenes, move || shows_the_same(&scenes)),
    ]
}
