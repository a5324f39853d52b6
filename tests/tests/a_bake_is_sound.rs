//! Hard cases of whole bakes, from a file to the maps that are read back: B3, B4, B9, B11 to B14, B17.

use glam::{DMat4, DQuat, DVec3, Vec2, Vec3};
use std::collections::BTreeMap;
use std::path::Path;
use sunbake::atlas::Density;
use sunbake::disk::read::BakedSet;
use sunbake::scene::{Alpha, Material, Mesh, Scene, TextureRef, Wrap};
use sunbake::settings::{BakeSettings, SunRequest};
use sunbake::testing::{SceneBuilder, block, cut, floor, opaque};
use sunbake::texels::{Texel, draw};
use sunbake_tests::{CODE_STEP_T, bake_scene, june_day, quick, share_that_differs};

fn temporary() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

fn all_texels(set: &BakedSet) -> Vec<Texel> {
    draw(set, usize::MAX, 0).expect("the set's scene loads")
}

/// A courtyard: a floor, a block and a leaning sheet.
fn courtyard() -> SceneBuilder {
    let sheet = [Vec3::new(-3.0, 0.0, 1.0), Vec3::new(-1.0, 0.0, 2.0), Vec3::new(-2.5, 3.0, 0.5)];
    SceneBuilder::new()
        .soup(&floor(Vec2::splat(-6.0), Vec2::splat(6.0), 0.0))
        .block(Vec3::new(0.5, 0.0, -1.5), Vec3::new(2.0, 2.5, 1.0))
        .soup_of(&[sheet], Material { is_double_sided: true, ..opaque() })
}

fn transformed(scene: &Scene, matrix: DMat4) -> Scene {
    let mut builder = SceneBuilder::new();
    for instance in &scene.instances {
        let world = DMat4::from_translation(scene.centre_m) * instance.bake_from_object;
        let mesh = scene.meshes[instance.mesh].clone();
        let material = scene.materials[mesh.material].clone();
        builder = builder.mesh_of(mesh, material, &[matrix * world]);
    }
    builder.build()
}

/// Every file of a set; of the manifest, what does not depend on the clock.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files = BTreeMap::new();
    for entry in std::fs::read_dir(folder).expect("a set") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        let mut bytes = std::fs::read(&path).expect("a file");
        if name == "sunbake.json" {
            let mut json: serde_json::Value = serde_json::from_slice(&bytes).expect("JSON");
            json["stats"]["seconds"] = serde_json::Value::Null;
            json["stats"]["threads"] = serde_json::Value::Null;
            bytes = json.to_string().into_bytes();
        }
        files.insert(name, bytes);
    }
    files
}

/// B17.
#[test]
fn the_same_bake_is_the_same_bytes_at_one_thread_and_two() {
    let folder = temporary();
    let scene = courtyard().build();
    let bake = |name: &str, threads| {
        bake_scene(&scene, &BakeSettings { threads, ..quick() }, folder.path(), "set");
        std::fs::rename(folder.path().join("set"), folder.path().join(name)).expect("to rename");
        files(&folder.path().join(name))
    };
    let one = bake("one", 1);
    assert!(one.len() >= 4, "{:?}", one.keys());
    assert_eq!(one, bake("two", 2));
    assert_eq!(one, bake("again", 2));
}

/// B3: under a node far away, whose translation an `f32` could not add, the scene bakes the same maps.
#[test]
fn a_scene_a_million_units_away_bakes_the_same_maps() {
    let folder = temporary();
    let near = bake_scene(&courtyard().build(), &quick(), folder.path(), "near");
    let away = DMat4::from_translation(DVec3::new(1e6 + 0.3, -4e5, 2.7e6));
    let far = bake_scene(&transformed(&courtyard().build(), away), &quick(), folder.path(), "far");
    let share = share_that_differs(&near, &far);
    assert!(share < 1e-3, "{share} of the texels differ");
    let centre = far.manifest.scene.centre_m;
    assert!((centre[0] - 1e6).abs() < 10.0 && (centre[2] - 2.7e6).abs() < 10.0, "{centre:?}");
}

/// B4.
#[test]
fn a_scene_of_another_size_bakes_the_same_maps() {
    let folder = temporary();
    let usual = bake_scene(&courtyard().build(), &quick(), folder.path(), "usual");
    for (name, scale) in [("tiny", 1e-4), ("huge", 1e4)] {
        let scaled = transformed(&courtyard().build(), DMat4::from_scale(DVec3::splat(scale)));
        let set = bake_scene(&scaled, &quick(), folder.path(), name);
        let share = share_that_differs(&usual, &set);
        assert!(share < 1e-3, "{name}: {share} of the texels differ");
    }
}

/// B9: slivers thinner than a texel, and specks smaller than one, in the open: none of their texels is black.
#[test]
fn no_texel_of_a_sliver_in_the_open_is_black() {
    let folder = temporary();
    let mut triangles = Vec::new();
    for i in 0..40 {
        let (x, width) = (i as f32 * 0.5, 0.4 * 0.5f32.powi(i / 4));
        let corner = |u: f32, v: f32| Vec3::new(x + u * width, 0.0, v);
        triangles.push([corner(0.0, 0.0), corner(0.0, 8.0), corner(1.0, 8.0)]);
        triangles.push([corner(0.0, -1.0), corner(0.0, -1.0 + width), corner(1.0, -1.0 + width)]);
    }
    let set = bake_scene(&SceneBuilder::new().soup(&triangles).build(), &quick(), folder.path(), "slivers");
    let texels = all_texels(&set);
    assert!(texels.len() > 500);
    for texel in &texels {
        let lit: f64 = texel.lit.iter().map(|[a, b]| b - a).sum();
        assert!(lit > 0.98, "{texel:?}");
    }
}

/// B11: under mirrors, shears and uneven scales the outside stays the outside.
#[test]
fn mirrored_and_sheared_boxes_keep_their_normals_outside() {
    let folder = temporary();
    let shear =
        DMat4::from_cols_array(&[1.0, 0.0, 0.0, 0.0, 0.6, 1.0, 0.0, 0.0, 0.0, 0.3, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
    let turn = DMat4::from_quat(DQuat::from_rotation_y(0.7));
    let matrices: Vec<DMat4> = [
        DMat4::IDENTITY,
        DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0)),
        DMat4::from_scale(DVec3::new(0.2, 3.0, -1.5)),
        DMat4::from_scale(DVec3::splat(-1.0)),
        turn * shear,
        turn * shear * DMat4::from_scale(DVec3::new(1.0, -2.0, 1.0)),
    ]
    .iter()
    .enumerate()
    .map(|(i, m)| DMat4::from_translation(DVec3::new(20.0 * i as f64, 0.0, 0.0)) * *m)
    .collect();
    let positions: Vec<Vec3> = block(Vec3::splat(-1.0), Vec3::splat(1.0)).into_iter().flatten().collect();
    let mesh = Mesh { indices: (0..positions.len() as u32).collect(), positions, ..Mesh::default() };
    let scene = SceneBuilder::new().mesh_of(mesh, opaque(), &matrices).build();
    let set = bake_scene(&scene, &quick(), folder.path(), "boxes");
    let texels = all_texels(&set);
    for (i, _) in matrices.iter().enumerate() {
        let own: Vec<_> = texels.iter().filter(|t| t.instance == i).collect();
        assert!(own.len() > 20, "box {i} has {} texels", own.len());
        let middle = DVec3::new(20.0 * i as f64, 0.0, 0.0);
        for texel in own {
            let outwards = (DVec3::from(texel.position) - middle).dot(DVec3::from(texel.normal));
            assert!(outwards > 0.0, "box {i}: {texel:?}");
            assert!(texel.normal[1] < 0.9 || !texel.lit.is_empty(), "the top of box {i} is dark: {texel:?}");
        }
    }
}

/// B12: instances of one mesh have texels of their own: the one in a box is dark, its twins are not.
#[test]
fn instances_of_one_mesh_keep_their_own_light() {
    let folder = temporary();
    let positions: Vec<Vec3> = floor(Vec2::splat(-1.0), Vec2::splat(1.0), 0.0).into_iter().flatten().collect();
    let mesh = Mesh { indices: (0..positions.len() as u32).collect(), positions, ..Mesh::default() };
    let places: Vec<DMat4> =
        (0..5).map(|i| DMat4::from_translation(DVec3::new(50.0 * f64::from(i), 0.0, 0.0))).collect();
    let scene = SceneBuilder::new()
        .mesh_of(mesh, opaque(), &places)
        .block(Vec3::new(98.0, -0.5, -2.0), Vec3::new(102.0, 1.0, 2.0))
        .build();
    let set = bake_scene(&scene, &quick(), folder.path(), "tiles");
    for texel in all_texels(&set) {
        match texel.instance {
            2 => assert!(texel.lit.is_empty(), "{texel:?}"),
            0 | 1 | 3 | 4 => assert!(!texel.lit.is_empty(), "{texel:?}"),
            _ => {}
        }
    }
}

/// A card over a floor, its left half transparent, its right half opaque at 200 of 255, under a sun at the zenith.
fn leaf_over_floor(cutoff: f32) -> Scene {
    let (builder, image) = SceneBuilder::new().image(2, 1, vec![[255, 255, 255, 0], [255, 255, 255, 200]]);
    let texture = TextureRef { image, texcoord: 0, image_from_texcoord: glam::Mat3::IDENTITY, wrap: [Wrap::Clamp; 2] };
    let triangles = floor(Vec2::splat(-1.0), Vec2::splat(1.0), 1.0);
    let positions: Vec<Vec3> = triangles.into_iter().flatten().collect();
    let uvs = positions.iter().map(|p| Vec2::new(p.x * 0.5 + 0.5, 0.5)).collect();
    let mesh = Mesh {
        indices: (0..positions.len() as u32).collect(),
        positions,
        texcoords: [Some(uvs), None],
        ..Mesh::default()
    };
    builder
        .soup(&floor(Vec2::splat(-2.0), Vec2::splat(2.0), 0.0))
        .mesh_of(mesh, Material { alpha: Alpha::Mask { cutoff }, ..cut(texture) }, &[DMat4::IDENTITY])
        .build()
}

/// B13: a leaf casts its cut-out. At cutoff 0 all of it is solid, at cutoff 1 what is not fully opaque is air.
#[test]
fn a_leaf_casts_its_cut_out_and_not_its_card() {
    let folder = temporary();
    let overhead =
        r#"{"keys": [{"azimuth_deg": 90, "elevation_deg": 89.99}, {"azimuth_deg": 270, "elevation_deg": 89.99}]}"#;
    let sun = SunRequest::Keyed { json: overhead.into(), north_deg: 0.0 };
    let settings = BakeSettings { sun, density: Density::Pages(1), ..quick() };
    for (cutoff, casts) in [(0.5, [false, true]), (0.0, [true, true]), (1.0, [false, false])] {
        let set = bake_scene(&leaf_over_floor(cutoff), &settings, folder.path(), "leaf");
        let mut seen = [0, 0];
        for texel in all_texels(&set).iter().filter(|t| t.instance == 0) {
            let [x, _, z] = texel.position;
            if !(0.1..0.9).contains(&x.abs()) || z.abs() > 0.9 {
                continue;
            }
            let side = usize::from(x > 0.0);
            seen[side] += 1;
            assert_eq!(texel.lit.is_empty(), casts[side], "cutoff {cutoff}: {texel:?}");
        }
        assert!(seen[0] > 50 && seen[1] > 50, "{seen:?}");
    }
}

/// B14: behind a picket fence texels flicker more often than one layer can say. The loss is reported, and more layers
/// remove it.
#[test]
fn a_picket_fence_reports_what_one_layer_loses() {
    let folder = temporary();
    let mut builder = SceneBuilder::new().soup(&floor(Vec2::splat(-5.0), Vec2::splat(5.0), 0.0));
    for i in 0..24 {
        let x = -5.0 + i as f32 * 0.4;
        builder = builder.block(Vec3::new(x, 0.0, 0.0), Vec3::new(x + 0.2, 6.0, 0.05));
    }
    let scene = builder.build();
    let day = june_day();
    let winter = sunbake::sun::DayRequest { date: "2026-12-21".parse().expect("a date"), ..day };
    let bake = |layer_cap| {
        let settings = BakeSettings { sun: SunRequest::Day(winter.clone()), layer_cap, ..quick() };
        bake_scene(&scene, &settings, folder.path(), "fence").manifest
    };
    let one = bake(1);
    assert_eq!(one.atlases[0].lanes[0].layers.len(), 1);
    assert!(one.error.merged_texels > 100 && one.error.merge_min.worst > 1.0, "{:?}", one.error);
    let enough = bake(16);
    assert_eq!(enough.error.merged_texels, 0);
    assert!(enough.atlases[0].lanes[0].layers.len() as u64 == enough.stats.most_intervals.div_ceil(4));
}

/// B6: the sun rises behind a wall that stands on a floor. No texel before it is lit earlier than the wall's height
/// allows, at any density of texels.
#[test]
fn no_texel_before_a_wall_is_lit_too_early_at_any_density() {
    let folder = temporary();
    let keys = r#"{"keys": [{"azimuth_deg": 270, "elevation_deg": 0}, {"azimuth_deg": 0, "elevation_deg": 90}, {"azimuth_deg": 90, "elevation_deg": 0}]}"#;
    let height = 2.0;
    for (kind, thickness) in [("block", 0.2), ("sheet", 0.0f32)] {
        let wall = match thickness > 0.0 {
            true => block(Vec3::new(-thickness, 0.0, -4.0), Vec3::new(0.0, height, 4.0)),
            false => floor(Vec2::new(0.0, -4.0), Vec2::new(height, 4.0), 0.0)
                .iter()
                .map(|t| t.map(|v| Vec3::new(0.0, v.x, v.z)))
                .collect(),
        };
        let scene = SceneBuilder::new().soup(&floor(Vec2::splat(-4.0), Vec2::splat(4.0), 0.0)).soup(&wall).build();
        for texels_per_metre in [0.7, 3.0, 17.0] {
            let settings = BakeSettings {
                sun: SunRequest::Keyed { json: keys.into(), north_deg: 0.0 },
                density: Density::TexelsPerMetre(texels_per_metre),
                page_size_texels: 1024,
                ..quick()
            };
            let set = bake_scene(&scene, &settings, folder.path(), kind);
            let texels = all_texels(&set);
            let shaded = texels.iter().filter(|t| t.instance == 0 && t.position[0] > 1e-3);
            let mut count = 0;
            for texel in shaded {
                count += 1;
                let near = f64::from(height).atan2(texel.position[0]);
                let far = f64::from(height).atan2(texel.position[0] + f64::from(thickness));
                let earliest = near.max(far) / std::f64::consts::PI - CODE_STEP_T;
                let start = texel.lit.first().map_or(1.0, |lit| lit[0]);
                assert!(start >= earliest, "{kind} at {texels_per_metre} texels/m: {texel:?} before {earliest}");
            }
            assert!(count >= 8, "{kind} at {texels_per_metre} texels/m has {count} texels before the wall");
        }
    }
}

/// An oracle of its own: f64 Moeller-Trumbore over all triangles, the sun from the manifest's own numbers. Each stored time
/// is the edge of a shadow to a code step, and what is stored between them is right.
#[test]
fn stored_times_agree_with_brute_force_within_a_code_step() {
    const MOMENTS: usize = 1024;
    let folder = temporary();
    let scene = courtyard().build();
    let set = bake_scene(&scene, &quick(), folder.path(), "yard");
    let path = set.manifest.path.as_ref().expect("a June day has a sun");
    let [ref arc] = path.arcs[..] else { panic!("one arc does for this day") };
    let triangles: Vec<[DVec3; 3]> = sunbake::scene::Geometry::new(&scene)
        .triangles
        .iter()
        .map(|t| t.map(|v| v.as_dvec3() + scene.centre_m))
        .collect();
    let mut edges = 0;
    for texel in draw(&set, 300, 5).expect("the scene loads") {
        let is_lit = |t: f64| {
            let sun = sun_of(arc, t);
            let before = DVec3::from(texel.normal).dot(sun) > 0.0;
            let origin = if before { Some(texel.origin) } else { texel.origin_back };
            sun.y > 0.0 && origin.is_some_and(|o| !triangles.iter().any(|c| hits(o.into(), sun, c)))
        };
        let ends = texel.lit.as_flattened();
        for t in (0..MOMENTS).map(|i| (i as f64 + 0.5) / MOMENTS as f64) {
            let stored = texel.lit.iter().any(|[a, b]| (a..=b).contains(&&t));
            let beside = ends.iter().any(|end| (end - t).abs() <= CODE_STEP_T);
            assert!(beside || stored == is_lit(t), "{texel:?} at {t}: stored {stored}");
        }
        for (i, &end) in ends.iter().enumerate().filter(|(_, end)| (CODE_STEP_T..1.0 - CODE_STEP_T).contains(*end)) {
            let [before, after] = [-CODE_STEP_T, CODE_STEP_T].map(|off_t| is_lit(end + off_t));
            assert!((before, after) == (i % 2 == 1, i % 2 == 0), "{texel:?} at {end}: {before}, then {after}");
            edges += 1;
        }
    }
    assert!(edges > 200, "only {edges} edges");
}

fn sun_of(arc: &sunbake::disk::manifest::ArcEntry, t: f64) -> DVec3 {
    let [h0, h1] = arc.hour_angle_deg;
    let h = (h0 + (h1 - h0) * (t - arc.t[0]) / (arc.t[1] - arc.t[0])).to_radians();
    let d = arc.declination_deg.to_radians();
    let (axis, zero) = (DVec3::from(arc.axis), DVec3::from(arc.zero));
    (zero * h.cos() + axis.cross(zero) * h.sin()) * d.cos() + axis * d.sin()
}

fn hits(origin: DVec3, direction: DVec3, [a, b, c]: &[DVec3; 3]) -> bool {
    let (e1, e2) = (b - a, c - a);
    let p = direction.cross(e2);
    let inverse = 1.0 / e1.dot(p);
    let s = origin - a;
    let u = s.dot(p) * inverse;
    let q = s.cross(e1);
    let (v, t) = (direction.dot(q) * inverse, e2.dot(q) * inverse);
    u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0
}
