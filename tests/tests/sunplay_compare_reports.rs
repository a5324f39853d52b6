//! `sunplay compare`, as a user runs it: what it writes, what it refuses, how it ends. Needs a GPU adapter, and a browser.

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use sunbake_tests::browser::probe;
use sunbake_tests::compared::{bake_into, posts};
use sunbake_tests::write_scene;

/// Runs the command on something, with small pictures.
fn compare(source: &Path, report: &Path, options: &[&str]) -> Output {
    let mut command = sunplay();
    command.arg("compare").arg(source).arg("-o").arg(report).args(["--size", "96x54", "--rounds", "1"]).args(options);
    command.output().expect("cargo runs")
}

/// The command: where the whole workspace was built, as `tests/run` does, it lies beside the tests' folder; else cargo builds it,
/// with all that it is made of once more, since alone it asks for fewer features.
fn sunplay() -> Command {
    let is_built = std::env::var_os("SUNBAKE_WORKSPACE_IS_BUILT").is_some();
    let tests = std::env::current_exe().expect("a test knows where it is");
    let beside = tests.parent().and_then(Path::parent).map(|folder| folder.join("sunplay"));
    if let Some(built) = beside.filter(|file| is_built && file.is_file()) {
        return Command::new(built);
    }
    let mut command = Command::new(env!("CARGO"));
    command.args(["run", "-q", "-p", "sunbake-runtime", "--bin", "sunplay", "--"]);
    command
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn report_in(folder: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(folder.join("report.json")).unwrap()).unwrap()
}

/// Holds a report against the published schema, by another program's reading of it.
fn assert_valid(report: &Value) {
    let schema = Path::new(env!("CARGO_MANIFEST_DIR")).join("../runtime/schemas/compare.schema.json");
    let schema = schema.canonicalize().expect("the schema is committed");
    let mut schemas = boon::Schemas::new();
    let index = boon::Compiler::new().compile(&schema.to_string_lossy(), &mut schemas).unwrap();
    schemas.validate(report, index).unwrap_or_else(|error| panic!("{error:#}"));
    let mut broken = report.clone();
    broken["techniques"][0]["error"]["mean"] = "much".into();
    assert!(schemas.validate(&broken, index).is_err(), "the schema lets everything pass");
}

/// A desk with a baked set of three lanes.
fn desk_with_set() -> (tempfile::TempDir, PathBuf) {
    let desk = tempfile::tempdir().unwrap();
    bake_into(desk.path(), "set", &posts(0.0), |settings| sunbake::settings::BakeSettings {
        lane_count: 3,
        ..settings
    });
    let set = desk.path().join("set");
    (desk, set)
}

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
fn a_report_holds_every_technique_and_works_in_a_browser() {
    let (desk, set) = desk_with_set();
    let folder = desk.path().join("report");
    let output = compare(&set, &folder, &["--against", "truth:soft:16"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let report = report_in(&folder);
    assert_valid(&report);
    let techniques = report["techniques"].as_array().unwrap();
    // Two counts of lanes, two depths, two filters; volumes; ten maps; truth of the sun's centre.
    assert_eq!(techniques.len(), 8 + 1 + 10 + 1, "{}", report["left_out"]);
    assert_eq!(report["left_out"], Value::Array(Vec::new()));
    let frames = report["cameras"].as_array().unwrap().len() * report["times"].as_array().unwrap().len();
    assert_eq!(frames, 15);
    for technique in techniques {
        let name = technique["name"].as_str().unwrap();
        let mean = technique["error"]["mean"].as_f64().unwrap();
        let ms = technique["times"]["frame_ms"].as_f64().unwrap();
        assert!(mean > 0.0 && mean < 0.5 && ms > 0.0, "{name}: {mean}, {ms} ms");
        assert_eq!(technique["frames"].as_array().unwrap().len(), frames, "{name}");
        let is_drawn = !name.starts_with("truth");
        assert_eq!(technique["times"]["passes"].is_object(), is_drawn, "{name}");
        assert_eq!(technique["memory_bytes"].as_u64().unwrap() > 0, is_drawn, "{name}");
        // The set has three lanes; what baking one would have taken, nobody knows.
        let is_known = name.starts_with("baked") && name.contains("lanes3");
        assert_eq!(technique["preparation"]["bake_s"].is_number(), is_known, "{name}");
    }
    let mean = |name: &str| {
        let found = techniques.iter().find(|technique| technique["name"] == name);
        found.unwrap_or_else(|| panic!("no {name}"))["error"]["mean"].as_f64().unwrap()
    };
    // A shadow drawn on the ground alone is worse than any other, and eight bits are worse than sixteen.
    assert!(
        mean("map:planar") > mean("map:cascades") && mean("baked:8:lanes1:filtered") > mean("baked:16:lanes1:filtered")
    );
    let sheet = image::open(folder.join("sheet.png")).unwrap();
    assert!(sheet.width() > 200 && sheet.height() > 100);

    let verdict = probe(&folder.join("report.html"));
    assert_eq!(verdict.problems, [""; 0]);
    // Two colours and one grey a frame, and one a technique.
    assert_eq!(verdict.pictures, frames * (3 + techniques.len()));
    assert!(verdict.rows == techniques.len() && verdict.columns >= 12 && verdict.plots == 2, "{verdict:?}");
    assert!(verdict.moments == frames && verdict.options >= 2 * (techniques.len() + 1), "{verdict:?}");
}

#[test]
fn a_scene_compared_with_itself_is_all_zeros_and_two_runs_agree() {
    let (desk, set) = desk_with_set();
    let name = "baked:16:lanes3:filtered";
    let report = |folder: &str, against: &str| {
        let folder = desk.path().join(folder);
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
    let desk = tempfile::tempdir().unwrap();
    let scene = write_scene(&posts(0.0), desk.path(), "posts");
    let day =
        ["--place", "40,0", "--date", "2026-06-21", "--page-size", "128", "--against", "truth:soft:4", "--at", "12:00"];
    let lanes = |folder: &str, techniques: &str| {
        let folder = desk.path().join(folder);
        let output = compare(&scene, &folder, &[&day[..], &["--techniques", techniques]].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let sets = report_in(&folder)["scene"]["sets"].clone();
        sets.as_array().unwrap().iter().map(|set| set["lanes"].as_u64().unwrap()).collect::<Vec<_>>()
    };
    assert_eq!(lanes("both", "baked"), [1, 3]);
    assert_eq!(lanes("one", "baked:lanes1,truth:hard"), [1]);
    assert_eq!(lanes("none", "truth:hard"), [0; 0]);
}

#[test]
fn limits_decide_how_it_ends_and_the_report_is_written_all_the_same() {
    let (desk, set) = desk_with_set();
    let run = |folder: &str, limits: &str| {
        let folder = desk.path().join(folder);
        let options = ["--techniques", "baked:16:lanes3:filtered", "--against", "truth:soft:4", "--fail-above", limits];
        let output = compare(&set, &folder, &[&options[..], &["--renderer", "cpu"]].concat());
        (output.status.code(), stderr(&output), folder.join("report.html").is_file())
    };
    let (code, text, is_written) = run("kept", "visibility=0.5,wrong=0.5");
    assert!(code == Some(0) && is_written, "{text}");
    let (code, text, is_written) = run("passed", "visibility=0.000001");
    assert!(code == Some(6) && is_written && text.contains("baked:16:lanes3:filtered"), "{text}");
    // A limit that nobody was held to is not kept: the CPU draws no maps.
    let folder = desk.path().join("unchecked");
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
fn what_cannot_be_compared_is_said_and_nothing_is_left_behind() {
    let (desk, set) = desk_with_set();
    let folder = desk.path().join("report");
    let fails = |source: &Path, options: &[&str], code: i32, words: &[&str]| {
        let output = compare(source, &folder, options);
        let text = stderr(&output);
        assert_eq!(output.status.code(), Some(code), "{options:?}: {text}");
        assert!(words.iter().all(|word| text.contains(word)), "{options:?}: {text}");
        assert!(!folder.exists(), "{options:?} left something behind");
    };
    let source = desk.path().join("set-source.glb");
    let other = write_scene(&posts(0.3), desk.path(), "other");
    let hash = sunbake::disk::read::read_manifest(&set).unwrap().source.sha256;
    let other_hash = sunbake::scene::sha256(&std::fs::read(&other).unwrap());
    let other = other.display().to_string();
    fails(&set, &["--scene", &other], 3, &[&hash, &other_hash]);
    fails(&set, &["--techniques", "baked:9"], 1, &["baked:16:lanes3:filtered", "map:cascades"]);
    fails(&set, &["--against", "baked"], 1, &["several"]);
    fails(&set, &["--place", "1,1"], 1, &["--place"]);
    fails(&desk.path().join("nothing"), &[], 2, &["not there"]);
    fails(&set, &["--size", "8000x8000"], 1, &["--size"]);
    // Without a GPU there is what the CPU draws, and the rest is left out by name.
    let report = desk.path().join("cpu");
    let options = ["--renderer", "cpu", "--against", "truth:soft:4", "--scene", &source.display().to_string()];
    let output = compare(&set, &report, &options);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let found = report_in(&report);
    let left: Vec<&str> =
        found["left_out"].as_array().unwrap().iter().map(|left| left["name"].as_str().unwrap()).collect();
    assert!(left.len() == 11 && left.contains(&"volumes") && left.contains(&"map:pcss"), "{left:?}");
    assert!(found["machine"]["adapter"].is_null() && found["warnings"][0].as_str().unwrap().contains("No GPU"));
    // An older report is replaced if asked to be, and only then.
    let again = compare(&set, &report, &options[..4]);
    assert!(again.status.code() == Some(2) && stderr(&again).contains("--force"), "{}", stderr(&again));
    // A set whose scene is gone.
    std::fs::remove_file(set.join("scene.glb")).unwrap();
    fails(&set, &[], 2, &["scene.glb is missing", "SHA-256"]);
}
