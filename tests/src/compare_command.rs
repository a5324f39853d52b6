//! `sunplay compare` as a user runs it, and its report.

use crate::built_program;
use crate::compared::{bake_into, posts};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use sunbake::settings::BakeSettings;

/// Runs the command on a scene or a set, with small pictures.
pub fn compare(source: &Path, report: &Path, options: &[&str]) -> Output {
    let mut command = Command::new(built_program("sunplay"));
    command.arg("compare").arg(source).arg("-o").arg(report).args(["--size", "96x54", "--rounds", "1"]).args(options);
    command.output().expect("sunplay runs")
}

/// The `report.json` of a folder.
pub fn report_in(folder: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(folder.join("report.json")).unwrap()).unwrap()
}

/// Checks a report against the published schema.
pub fn assert_valid(report: &Value) {
    let schema = Path::new(env!("CARGO_MANIFEST_DIR")).join("../runtime/schemas/compare.schema.json");
    let schema = schema.canonicalize().expect("the schema is committed");
    let mut schemas = boon::Schemas::new();
    let index = boon::Compiler::new().compile(&schema.to_string_lossy(), &mut schemas).unwrap();
    schemas.validate(report, index).unwrap_or_else(|error| panic!("{error:#}"));
    let mut broken = report.clone();
    broken["techniques"][0]["error"]["mean"] = "much".into();
    assert!(schemas.validate(&broken, index).is_err(), "the schema lets everything pass");
}

/// A temporary folder with a baked set of three lanes in it, and that set's path.
pub fn folder_with_set() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    bake_into(folder.path(), "set", &posts(0.0), |settings| BakeSettings { lane_count: 3, ..settings });
    let set = folder.path().join("set");
    (folder, set)
}
