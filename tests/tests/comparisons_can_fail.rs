//! A comparison must be able to fail. Sets are broken in each way that a set can be wrong, and the comparer's numbers
//! have to show it.

use image::{ImageBuffer, Rgba};
use std::path::Path;
use sunbake_runtime::stage::StageError;
use sunbake_runtime::{Shot, Stage, View};
use sunbake_tests::compared::{PLAYED, TRUE, bake_into, compared, mean_error, posts};

type Texels = ImageBuffer<Rgba<u16>, Vec<u16>>;

/// Asserts that a defect multiplies a set's mean error by at least `least`.
fn assert_caught(defect: &str, least: f64, spoil: impl Fn(&Path)) {
    let folder = tempfile::tempdir().unwrap();
    bake_into(folder.path(), "set", &posts(0.0), |settings| settings);
    let set = folder.path().join("set");
    let sound = mean_error(&set);
    spoil(&set);
    let broken = mean_error(&set);
    println!("{defect}: mean error {sound:.4} became {broken:.4}");
    assert!(sound < 0.03, "a sound set is off by {sound}");
    assert!(broken > least * sound, "{defect}: {sound} became {broken}");
}

fn texels(set: &Path, name: &str) -> Texels {
    image::open(set.join(name)).unwrap().into_rgba16()
}

/// Changes a texture of a set.
fn edit(set: &Path, name: &str, change: impl Fn(&mut Texels)) {
    let mut picture = texels(set, name);
    change(&mut picture);
    picture.save(set.join(name)).unwrap();
}

/// Changes the manifest of a set.
fn edit_manifest(set: &Path, change: impl Fn(&mut serde_json::Value)) {
    let file = set.join("sunbake.json");
    let mut manifest: serde_json::Value = serde_json::from_slice(&std::fs::read(&file).unwrap()).unwrap();
    change(&mut manifest);
    std::fs::write(file, serde_json::to_vec(&manifest).unwrap()).unwrap();
}

#[test]
fn a_shifted_sun_is_caught() {
    // Ten minutes late: two and a half degrees.
    assert_caught("a shifted sun", 1.5, |set| {
        edit_manifest(set, |manifest| {
            for arc in manifest["path"]["arcs"].as_array_mut().unwrap() {
                for end in 0..2 {
                    let angle = arc["hour_angle_deg"][end].as_f64().unwrap();
                    arc["hour_angle_deg"][end] = (angle + 2.5).into();
                }
            }
        });
    });
}

#[test]
fn swapped_channels_are_caught() {
    assert_caught("swapped channels", 2.0, |set| {
        edit(set, "page0_lane0_layer0_rise.png", |rise| rise.pixels_mut().for_each(|texel| texel.0.swap(0, 1)));
    });
}

#[test]
fn a_layer_that_is_off_by_one_is_caught() {
    assert_caught("rises a layer off", 2.0, |set| {
        let names = [0, 1].map(|layer| format!("page0_lane0_layer{layer}_rise.png"));
        let [first, second] = [texels(set, &names[0]), texels(set, &names[1])];
        first.save(set.join(&names[1])).unwrap();
        second.save(set.join(&names[0])).unwrap();
    });
}

#[test]
fn a_stale_set_is_refused_with_both_hashes_and_caught_without_them() {
    let folder = tempfile::tempdir().unwrap();
    bake_into(folder.path(), "old", &posts(0.0), |settings| settings);
    bake_into(folder.path(), "new", &posts(0.2), |settings| settings);
    let [old, new] = ["old", "new"].map(|name| folder.path().join(name));
    let sound = mean_error(&old);
    std::fs::copy(new.join("scene.glb"), old.join("scene.glb")).unwrap();
    let (found, baked) = match Stage::read(&old) {
        Err(StageError::Changed { found, baked, .. }) => (found, baked),
        other => panic!("{:?}", other.err()),
    };
    let hash = |set: &Path| {
        let manifest = sunbake::disk::read::read_manifest(set).unwrap();
        manifest.scene.sha256.unwrap()
    };
    assert_eq!((found, baked), (hash(&new), hash(&old)));
    // A set of before hashes were kept, whose scene has moved on.
    edit_manifest(&old, |manifest| drop(manifest["scene"].as_object_mut().unwrap().remove("sha256")));
    let stale = mean_error(&old);
    assert!(stale > 2.0 * sound, "{sound} became {stale}");
    std::fs::remove_file(old.join("scene.glb")).unwrap();
    assert!(matches!(Stage::read(&old), Err(StageError::NoScene { .. })));
}

#[test]
fn one_corrupted_texel_is_caught_by_comparing_with_the_sound_set() {
    let folder = tempfile::tempdir().unwrap();
    bake_into(folder.path(), "set", &posts(0.0), |settings| settings);
    let set = folder.path().join("set");
    let sound = compared(&set, &[PLAYED], TRUE);
    // A texel of the ground that the second camera looks at.
    let stage = Stage::read(&set).unwrap();
    let eye_m = glam::DVec3::new(-1.0, 1.5, 3.0) - stage.scene.centre_m;
    let camera = sunbake_runtime::Camera::look_at(eye_m, -stage.scene.centre_m, 0.8).unwrap();
    let shot = Shot::new(&stage, View::new(&camera, [160, 90], &stage.scene));
    let hit = shot.hits()[70 * 160 + 80].expect("the ground");
    let (_, uv) = stage.page_uv(&hit).unwrap();
    let [x, y] = [uv.x * stage.pages[0].width as f32, uv.y * stage.pages[0].height as f32].map(|c| c as u32);
    for layer in 0.. {
        let name = format!("page0_lane0_layer{layer}_fall.png");
        if !set.join(&name).is_file() {
            break;
        }
        edit(&set, &name, |fall| fall.get_pixel_mut(x, y).0 = [0; 4]);
    }
    let spoilt = compared(&set, &[PLAYED], TRUE);
    let frames = sound.techniques[0].frames.iter().zip(&spoilt.techniques[0].frames);
    let differ = frames.filter(|(a, b)| a.camera == 1 && b.error.mean > a.error.mean).count();
    assert!(differ > 0, "a texel that is always dark changed no frame");
}

#[test]
fn a_set_compared_with_itself_has_no_error_and_two_runs_agree() {
    let folder = tempfile::tempdir().unwrap();
    bake_into(folder.path(), "set", &posts(0.0), |settings| settings);
    let set = folder.path().join("set");
    for one in [PLAYED, TRUE] {
        let outcome = compared(&set, &[one], one);
        for error in outcome.techniques[0].frames.iter().map(|frame| frame.error).chain([outcome.techniques[0].error]) {
            assert_eq!((error.mean, error.p99, error.worst, error.wrong_share), (0.0, 0.0, 0.0, 0.0));
            assert_eq!((error.outside, error.not_numbers), (0.0, 0));
            assert!(
                error.penumbra.is_none_or(|mean| mean == 0.0)
                    && (error.ssim - 1.0).abs() < 1e-12
                    && error.pixels > 1000
            );
        }
    }
    let [a, b] = [(); 2].map(|()| compared(&set, &[PLAYED], TRUE));
    let errors = |outcome: &sunbake_runtime::compare::Outcome| {
        outcome.techniques[0].frames.iter().map(|frame| frame.error).collect::<Vec<_>>()
    };
    assert_eq!((errors(&a), a.techniques[0].error, &a.visibility), (errors(&b), b.techniques[0].error, &b.visibility));
}

#[test]
fn lanes_and_bits_made_of_a_set_are_those_that_a_bake_makes() {
    let folder = tempfile::tempdir().unwrap();
    let scene = posts(0.0);
    bake_into(folder.path(), "three", &scene, |settings| sunbake::settings::BakeSettings { lane_count: 3, ..settings });
    bake_into(folder.path(), "one", &scene, |settings| settings);
    let bits = sunbake::maps::Bits::Eight;
    bake_into(folder.path(), "eight", &scene, |settings| sunbake::settings::BakeSettings { bits, ..settings });
    let stage = |name: &str| Stage::read(&folder.path().join(name)).unwrap();
    let [middle, one] = [stage("three").with_one_lane(), stage("one")];
    assert_eq!(middle.pages[0].lanes, one.pages[0].lanes);
    let [made, baked] = [one.with_eight_bits(), stage("eight")];
    assert_eq!(made.bits, baked.bits);
    // Codes of lists that rounding has not shortened; those hold their intervals in the same places.
    let codes = |stage: &Stage| {
        let layers = stage.pages[0].lanes[0].layers.iter();
        layers.flat_map(|layer| layer.rise.iter().chain(&layer.fall).flatten().copied()).collect::<Vec<u16>>()
    };
    let (made, baked) = (codes(&made), codes(&baked));
    let differ = made.iter().zip(&baked).filter(|(a, b)| a.abs_diff(**b) > 1).count();
    assert!(made.len() >= baked.len() && differ < made.len() / 50, "{differ} of {}", made.len());
}
