//! Which filter `sunplay frame` draws a set with, where none is asked for.

use std::fs::read;
use std::path::Path;
use std::process::{Command, Output};
use sunbake::settings::{BakeSettings, TrackChoice};
use sunbake_tests::built_program;
use sunbake_tests::compared::{bake_into, fence};

/// A picture of the fence's shadow.
fn draw(set: &Path, picture: &Path, options: &[&str]) -> Output {
    let mut command = Command::new(built_program("sunplay"));
    command.arg("frame").arg(set).arg("-o").arg(picture).args(["--at", "08:00", "--size", "96x64"]).args(options);
    command.args(["--renderer", "cpu", "--output", "visibility"]).output().expect("sunplay runs")
}

#[test]
fn tracks_are_drawn_where_a_set_has_them_and_texels_are_blended_where_not() {
    let folder = tempfile::tempdir().unwrap();
    for (name, tracks) in [("tracked", TrackChoice::Auto), ("plain", TrackChoice::Off)] {
        bake_into(folder.path(), name, &fence(), |settings| BakeSettings { tracks, ..settings });
    }
    let picture = |set: &str, name: &str, options: &[&str]| {
        let file = folder.path().join(format!("{set}-{name}.png"));
        let drawn = draw(&folder.path().join(set), &file, options);
        assert_eq!(drawn.status.code(), Some(0), "{}", String::from_utf8_lossy(&drawn.stderr));
        read(file).unwrap()
    };
    for (set, usual, other) in [("tracked", "tracks", "bilinear"), ("plain", "bilinear", "sharp")] {
        let drawn = picture(set, "usual", &[]);
        assert!(drawn == picture(set, usual, &["--filter", usual]), "{set}: not drawn by {usual}");
        assert!(drawn != picture(set, other, &["--filter", other]), "{set}: {other} draws the same");
    }
    let refused = draw(&folder.path().join("plain"), &folder.path().join("none.png"), &["--filter", "tracks"]);
    let why = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(refused.status.code() == Some(1) && why.contains("bake it with --tracks"), "{why}");
}
