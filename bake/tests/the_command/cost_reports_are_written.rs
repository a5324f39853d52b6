//! `sunbake cost`: what a report holds, and that it names what was not measured.

use super::tools::{Desk, Run, names};
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Measures `floor.glb` within ten seconds, with further arguments.
fn cost(desk: &Desk, more: &[&str]) -> Run {
    let usual = ["cost", "floor.glb", "-o", "out/report", "--budget=10", "--size=64", "--threads=1"];
    desk.run(&[&usual[..], more].concat())
}

fn rows(report: &Value) -> Vec<Value> {
    let sweeps = report["sweeps"].as_array().unwrap();
    sweeps.iter().flat_map(|sweep| sweep["rows"].as_array().unwrap().clone()).collect()
}

/// Checks a report against the published schema with a validator that shares no code with ours.
fn validate(report: &Value) {
    let schema = Path::new(env!("CARGO_MANIFEST_DIR")).join("schemas/cost.schema.json");
    let mut schemas = boon::Schemas::new();
    let index = boon::Compiler::new().compile(&schema.to_string_lossy(), &mut schemas).unwrap();
    schemas.validate(report, index).unwrap_or_else(|error| panic!("{error:#}"));
    let mut broken = report.clone();
    broken["sweeps"][0]["rows"][0]["how"] = "guessed".into();
    assert!(schemas.validate(&broken, index).is_err(), "the schema lets everything pass");
}

#[test]
fn with_a_small_budget_a_report_names_what_did_not_run() {
    let desk = Desk::new();
    let started = Instant::now();
    let run = cost(&desk, &["--json"]).ok();
    assert!(started.elapsed() < Duration::from_secs(40), "{:?}", started.elapsed());
    assert_eq!(names(&desk.path("out/report")), ["report.html", "report.json"]);
    assert_eq!(desk.left(), ["report"]);
    let report = run.json();
    let written: Value = serde_json::from_slice(&std::fs::read(desk.path("out/report/report.json")).unwrap()).unwrap();
    assert_eq!(written, report);
    validate(&report);
    let rows = rows(&report);
    for row in &rows {
        let (how, note) = (row["how"].as_str().unwrap(), row["note"].as_str().unwrap_or_default());
        match how {
            "not-run" => assert!(note.contains("not run") || note.contains("stopped"), "{row}"),
            _ => {
                let has_error = row["sun_min"].is_object() || row["open"].is_object();
                assert!(row["seconds"].is_f64() && row["gpu_bytes"].is_u64() && has_error, "{row}");
            }
        }
    }
    let count = |how: &str| rows.iter().filter(|row| row["how"] == how).count();
    assert!(count("turned") > 10 && count("baked") + count("sampled") > 0, "{rows:?}");
    assert!(count("baked") < 6, "a budget of ten seconds does not bake a page of 4096");
}

#[test]
fn the_page_needs_no_network_and_holds_every_row() {
    let desk = Desk::new();
    let report = cost(&desk, &["--json"]).ok().json();
    let html = std::fs::read_to_string(desk.path("out/report/report.html")).unwrap();
    for row in rows(&report) {
        let name = row["name"].as_str().unwrap();
        assert!(html.contains(&format!("<code>{name}</code>")), "{name}");
    }
    for outside in ["http://", "https://", "<link", "src=", "@import"] {
        assert!(!html.contains(outside), "{outside}");
    }
    assert!(html.contains("default-src 'none'") && html.contains("<svg"), "{html}");
    // An older report is replaced by force alone, and a set never.
    cost(&desk, &[]).fails("again", 2, &["out/report exists", "--force"]);
    desk.bake(&[]).ok();
    let over_a_set = desk.run(&["cost", "floor.glb", "-o", "out/set", "--force"]);
    over_a_set.fails("over a set", 2, &["not a report", "never replaced"]);
}

#[test]
fn requests_that_cannot_be_measured_are_refused() {
    let desk = Desk::new();
    let hasty = desk.run(&["cost", "floor.glb", "-o", "out/report", "--budget=5"]);
    hasty.fails("budget", 1, &["10 to 86400", "sunbake cost --help"]);
    let lamp = r#"{"keys": [{"t": 0, "position": [0, 2, 0]}, {"t": 1, "position": [3, 2, 0]}]}"#;
    desk.write("lamp.json", lamp.as_bytes());
    cost(&desk, &["--path=lamp.json"]).fails("a lamp", 1, &["the path file is a lamp's", "--path"]);
    let night = ["--place=80,0", "--date=2026-12-21"];
    cost(&desk, &night).fails("polar night", 1, &["does not rise", "--date"]);
    desk.run(&["cost", "none.glb", "-o", "out/report"]).fails("no file", 2, &["none.glb"]);
    cost(&desk, &["--leave-out=ghost"]).fails("leave out", 1, &["ghost"]);
    assert!(desk.left().is_empty(), "{:?}", desk.left());
}

#[cfg(unix)]
#[test]
fn an_interrupted_report_leaves_nothing() {
    let desk = Desk::new();
    let arguments = ["cost", "floor.glb", "-o", "out/report", "--threads=1"];
    let child = desk.command(&arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let deadline = Instant::now() + Duration::from_secs(30);
    while desk.left().is_empty() {
        assert!(Instant::now() < deadline, "nothing was begun");
        std::thread::sleep(Duration::from_millis(10));
    }
    std::thread::sleep(Duration::from_millis(700));
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(130), "{stderr}");
    assert_eq!(stderr, "sunbake: stopped before the end; nothing was written\n");
    assert!(desk.left().is_empty(), "{:?}", desk.left());
}
