//! Hard cases B3 and B5 on shared scenes: cities far from the origin, and a house whose faces are doubled.

use libtest_mimic::Trial;
use std::collections::HashMap;
use std::path::Path;
use sunbake::disk::read::{BakedSet, read};
use sunbake::progress::Silent;
use sunbake::settings::BakeSettings;
use sunbake::texels::{Texel, draw};
use sunbake_tests::needs::{Need, of_scene, shared, trial};
use sunbake_tests::{bake_scene, quick, share_that_differs};
use tempfile::TempDir;

fn settings() -> BakeSettings {
    BakeSettings { page_size_texels: 512, ..quick() }
}

/// A set, and the folder that it lies in.
struct BakedFolder {
    set: BakedSet,
    _folder: TempDir,
}

fn bake(file: &Path) -> BakedFolder {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let target = folder.path().join("set");
    sunbake::bake(file, &target, true, &settings(), &Silent).unwrap_or_else(|error| panic!("{error}"));
    BakedFolder { set: read(&target).unwrap_or_else(|error| panic!("{error}")), _folder: folder }
}

/// Covered texels that disagree with every neighbour in their plane about whether they see the sun at `t`, as a share
/// of those that have at least three such neighbours. Wires and railings make some; acne makes many.
fn speckle(set: &BakedSet, t: f64) -> f64 {
    let texels = draw(set, usize::MAX, 0).expect("the set's scene loads");
    let at: HashMap<(usize, u32, u32), &Texel> = texels.iter().map(|x| ((x.atlas, x.x, x.y), x)).collect();
    let is_lit = |texel: &Texel| texel.lit.iter().any(|[a, b]| (a..=b).contains(&&t));
    let (mut alone, mut all) = (0usize, 0usize);
    for texel in &texels {
        let around = [(0, 1), (1, 0), (0, u32::MAX), (u32::MAX, 0)];
        let beside = around.iter().filter_map(|(dx, dy)| {
            at.get(&(texel.atlas, texel.x.wrapping_add(*dx), texel.y.wrapping_add(*dy))).copied()
        });
        let dot = |a: &[f64; 3], b: &[f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let same_plane: Vec<_> = beside.filter(|n| dot(&n.normal, &texel.normal) > 0.999).collect();
        if same_plane.len() >= 3 {
            all += 1;
            alone += usize::from(same_plane.iter().all(|n| is_lit(n) != is_lit(texel)));
        }
    }
    assert!(all > 1000, "only {all} texels have neighbours");
    alone as f64 / all as f64
}

/// B3: vertices in map coordinates, which `f32` holds to 3 cm, bake as cleanly as the same city under a node.
fn a_city_in_map_coordinates_does_not_speckle(under_node: &Path, raw: &Path) {
    let [under_node, raw] = [under_node, raw].map(bake);
    for t in [0.15, 0.5, 0.85] {
        let [clean, found] = [&under_node, &raw].map(|baked| speckle(&baked.set, t));
        println!("at {t}: {clean:.5} of the texels stand alone under a node, {found:.5} in map coordinates");
        assert!(clean < 0.01 && found < clean + 0.005, "at {t}: {found} against {clean}");
    }
}

/// B3: the same city, at the origin and under its node's translation, gives the same maps.
fn a_city_under_a_node_bakes_the_maps_of_the_city_at_the_origin(file: &Path) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let far = sunbake::scene::load(file, &sunbake::scene::LoadLimits::default()).expect("it loads");
    // A scene that is not its file's any more.
    let mut near = sunbake::scene::Scene { file: None, ..far.clone() };
    for node in &mut near.nodes {
        node.parent_from_node.w_axis = glam::DVec4::W;
        node.world_from_node.w_axis = glam::DVec4::W;
    }
    let [near, far] =
        [bake_scene(&near, &settings(), folder.path(), "near"), bake_scene(&far, &settings(), folder.path(), "far")];
    assert!(far.manifest.scene.centre_m[0].abs() > 1e6 && near.manifest.scene.centre_m[0].abs() < 1e5);
    let share = share_that_differs(&near, &far);
    println!("{share} of the texels differ");
    assert!(share < 1e-3, "{share} of the texels differ");
}

/// B5: a house of which 2,506 triangles are there twice.
fn coincident_faces_do_not_speckle(file: &Path) {
    let house = bake(file);
    for t in [0.2, 0.5, 0.8] {
        let found = speckle(&house.set, t);
        println!("at {t}: {found:.5} of the texels stand alone");
        assert!(found < 0.01, "{found} at {t}");
    }
}

pub fn trials() -> Vec<Trial> {
    let in_map_coordinates = |city: &str| {
        let files = ["node", "raw"].map(|form| format!("scenes/delft_3d/{city}_{form}.glb"));
        let needs = files.iter().map(|file| Need::shared(file)).collect();
        let [under_node, raw] = files.map(|file| shared(&file));
        let name = format!("a_city_in_map_coordinates_does_not_speckle::{city}");
        trial(&name, needs, move || a_city_in_map_coordinates_does_not_speckle(&under_node, &raw))
    };
    vec![
        in_map_coordinates("delft"),
        in_map_coordinates("zurich"),
        of_scene(
            "a_city_under_a_node_bakes_the_maps_of_the_city_at_the_origin",
            "delft_3d/zurich_node.glb",
            a_city_under_a_node_bakes_the_maps_of_the_city_at_the_origin,
        ),
        of_scene("coincident_faces_do_not_speckle", "pc_house/house.glb", coincident_faces_do_not_speckle),
    ]
}
