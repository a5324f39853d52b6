//! `sunplay compare` as a user runs it: what it writes, what it refuses, its exit codes. Needs a GPU adapter.

use serde_json::Value;
use std::path::Path;
use sunbake_tests::compare_command::{compare, folder_with_set, report_in};
use sunbake_tests::compared::{fence, posts};
use sunbake_tests::{stderr, write_scene};

/// A report without what a clock says.
fn timeless(mut report: Value) -> Value {
    fn strip(value: &mut Value) {
        match value {
            Value::Object(fields) => {
                fields.retain(|key, _| !key.ends_with("_ms") && !key.ends_with("_s") && key != "passes");
                fields.values_mut().for_each(strip);
            }
            Value::Array(all) => all.iter_mut().for_each(strip),
            _ => {}
        }
    }
    strip(&mut report);
    report
}

#[test]
fn a_technique_compared_with_itself_has_no_error_and_two_runs_agree() {
    let (temporary, set) = folder_with_set();
    let name = "baked:16:lanes3:filtered";
    let report = |folder: &str, against: &str| {
        let folder = temporary.path().join(folder);
        let output =
            compare(&set, &folder, &["--techniques", "baked:16:lanes3:filtered,volumes", "--against", against]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        report_in(&folder)
    };
    let itself = report("itself", name);
    let error = &itself["techniques"][0]["error"];
    assert_eq!(itself["techniques"][0]["name"], name);
    for key in ["mean", "p99", "worst", "wrong_share", "outside", "penumbra"] {
        assert_eq!(error[key].as_f64(), Some(0.0), "{key}");
    }
    assert!((error["ssim"].as_f64().unwrap() - 1.0).abs() < 1e-12);
    assert!(itself["techniques"][1]["error"]["mean"].as_f64().unwrap() > 0.0, "volumes are no bake");
    let [a, b] = ["a", "b"].map(|folder| timeless(report(folder, "truth:soft:16")));
    assert_eq!(a, b);
}

#[test]
fn a_scene_is_baked_as_often_as_it_is_played_back() {
    let temporary = tempfile::tempdir().unwrap();
    let scene = write_scene(&fence(), temporary.path(), "fence");
    let day =
        ["--place", "40,0", "--date", "2026-12-21", "--page-size", "96", "--against", "truth:soft:4", "--at", "10:00"];
    let report = |folder: &str, techniques: &str| {
        let folder = temporary.path().join(folder);
        let output = compare(&scene, &folder, &[&day[..], &["--techniques", techniques]].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        report_in(&folder)
    };
    let sets = |report: &Value| {
        let sets = report["scene"]["sets"].as_array().unwrap().iter();
        sets.map(|set| (set["lanes"].as_u64().unwrap(), set["tracks"].is_object())).collect::<Vec<_>>()
    };
    let both = report("both", "baked");
    assert_eq!(sets(&both), [(1, true), (3, false)]);
    assert_eq!(sets(&report("one", "baked:lanes1:filtered,truth:hard")), [(1, false)]);
    assert_eq!(sets(&report("none", "truth:hard")), []);
    // Tracks are read in place of the intervals, take longer to bake, and draw something else.
    let of = |name: &str| both["techniques"].as_array().unwrap().iter().find(|one| one["name"] == name).unwrap();
    let [filtered, tracks] = ["filtered", "tracks"].map(|filter| of(&format!("baked:16:lanes1:{filter}")));
    let bake_s = |one: &Value| one["preparation"]["bake_s"].as_f64().unwrap();
    assert!(bake_s(tracks) > bake_s(filtered));
    let tracks_bytes = both["scene"]["sets"][0]["tracks"]["disk_bytes"].as_u64().unwrap();
    assert_eq!(tracks["disk_bytes"].as_u64(), Some(tracks_bytes));
    let mean = |one: &Value| one["error"]["mean"].as_f64().unwrap();
    assert!(mean(tracks) < 0.5 * mean(filtered), "{} {}", mean(tracks), mean(filtered));
}

#[test]
fn limits_decide_the_exit_code_and_the_report_is_written() {
    let (temporary, set) = folder_with_set();
    let run = |folder: &str, limits: &str| {
        let folder = temporary.path().join(folder);
        let options = ["--techniques", "baked:16:lanes3:filtered", "--against", "truth:soft:4", "--fail-above", limits];
        let output = compare(&set, &folder, &[&options[..], &["--renderer", "cpu"]].concat());
        (output.status.code(), stderr(&output), folder.join("report.html").is_file())
    };
    let (code, text, is_written) = run("kept", "visibility=0.5,wrong=0.5");
    assert!(code == Some(0) && is_written, "{text}");
    let (code, text, is_written) = run("passed", "visibility=0.000001");
    assert!(code == Some(6) && is_written && text.contains("baked:16:lanes3:filtered"), "{text}");
    // A limit that nobody was held to is not kept: the CPU draws no maps.
    let folder = temporary.path().join("unchecked");
    let options =
        ["--techniques", "map:pcss", "--against", "truth:soft:4", "--fail-above", "visibility=1", "--renderer", "cpu"];
    let output = compare(&set, &folder, &options);
    assert_eq!(output.status.code(), Some(6), "{}", stderr(&output));
    assert!(stderr(&output).contains("could not be checked of map:pcss"), "{}", stderr(&output));
    for unknown in ["brightness=1", "visibility", "visibility=-1"] {
        let (code, text, is_written) = run("unknown", unknown);
        assert!(code == Some(1) && !is_written && text.contains("give"), "{unknown}: {text}");
    }
}

#[test]
fn what_cannot_be_compared_is_refused_and_nothing_is_left() {
    let (temporary, set) = folder_with_set();
    let folder = temporary.path().join("report");
    let fails = |source: &Path, options: &[&str], code: i32, words: &[&str]| {
        let output = compare(source, &folder, options);
        let text = stderr(&output);
        assert_eq!(output.status.code(), Some(code), "{options:?}: {text}");
        assert!(words.iter().all(|word| text.contains(word)), "{options:?}: {text}");
        assert!(!folder.exists(), "{options:?} left something behind");
    };
    let source = temporary.path().join("set-source.glb");
    let other = write_scene(&posts(0.3), temporary.path(), "other");
    let hash = sunbake::disk::read::read_manifest(&set).unwrap().source.sha256;
    let other_hash = sunbake::scene::sha256(&std::fs::read(&other).unwrap());
    let other = other.display().to_string();
    fails(&set, &["--scene", &other], 3, &[&hash, &other_hash]);
    fails(&set, &["--techniques", "baked:9"], 1, &["baked:16:lanes3:filtered", "map:cascades"]);
    fails(&set, &["--against", "baked"], 1, &["several"]);
    fails(&set, &["--place", "1,1"], 1, &["--place"]);
    fails(&temporary.path().join("nothing"), &[], 2, &["not there"]);
    fails(&set, &["--size", "8000x8000"], 1, &["--size"]);
    // Without a GPU there is what the CPU draws, and the rest is left out by name.
    let report = temporary.path().join("cpu");
    let options = ["--renderer", "cpu", "--against", "truth:soft:4", "--scene", &source.display().to_string()];
    let output = compare(&set, &report, &options);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let found = report_in(&report);
    let left: Vec<&str> =
        found["left_out"].as_array().unwrap().iter().map(|left| left["name"].as_str().unwrap()).collect();
    assert!(
        left.len() == 12 && left.contains(&"baked:tracks") && left.contains(&"volumes") && left.contains(&"map:pcss"),
        "{left:?}"
    );
    assert!(found["machine"]["adapter"].is_null() && found["warnings"][0].as_str().unwrap().contains("No GPU"));
    // An older report is replaced if asked to be, and only then.
    let again = compare(&set, &report, &options[..4]);
    assert!(again.status.code() == Some(2) && stderr(&again).contains("--force"), "{}", stderr(&again));
    // A set whose scene is gone.
    std::fs::remove_file(set.join("scene.glb")).unwrap();
    fails(&set, &[], 2, &["scene.glb is missing", "SHA-256"]);
}
