//! `sunplay frame` on a scene without a bake: what it draws, and what it refuses. Needs a GPU adapter.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn scene() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../assets/gas_station.glb")
}

/// Runs `sunplay frame` on a scene, small, at five in the afternoon.
fn frame(scene: &Path, file: &Path, options: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_sunplay"));
    command.arg("frame").arg(scene).args(["--at", "17:00", "--size", "160x90", "-o"]).arg(file).args(options);
    command.output().expect("sunplay runs")
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// A visibility picture's values.
fn values(file: &Path) -> Vec<u16> {
    let mut reader =
        png::Decoder::new(std::io::BufReader::new(std::fs::File::open(file).unwrap())).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut bytes).unwrap();
    bytes.chunks_exact(2).map(|two| u16::from_be_bytes([two[0], two[1]])).collect()
}

#[test]
fn volumes_and_truth_draw_one_mask_and_the_plan_is_printed() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    let mut masks = Vec::new();
    for technique in ["truth:hard", "volumes", "volumes:zfail", "volumes:zpass", "volumes:triangles", "volumes:gpu"] {
        let picture = file(&format!("{}.png", technique.replace(':', "_")));
        let options = ["--technique", technique, "--output", "visibility", "--json", "--explain"];
        let output = frame(&scene(), &picture, &options);
        assert_eq!(output.status.code(), Some(0), "{technique}: {}", stderr(&output));
        let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(report["technique"], technique);
        assert_eq!(report["clock"], "17:00");
        let is_live = technique != "truth:hard";
        assert_eq!(stderr(&output).contains("the whole triangles cast"), is_live, "{}", stderr(&output));
        assert!(report["effects"].as_array().is_some_and(|effects| effects.len() > 2), "{technique}");
        assert!(
            stderr(&output).contains("  on  alpha-test") && stderr(&output).contains("      off by"),
            "{technique}"
        );
        assert_eq!(report["plan"].as_array().is_some_and(|lines| lines.len() > 2), is_live);
        assert_eq!(report["details"]["casters"]["triangles"].as_u64().is_some_and(|n| n > 100_000), is_live);
        assert_eq!(report["bytes"].as_u64().is_some_and(|bytes| bytes > 100_000), is_live);
        masks.push(values(&picture));
    }
    assert!(masks[1..].iter().all(|mask| *mask == masks[1]), "modes differ");
    let differ = masks[0].iter().zip(&masks[1]).filter(|(a, b)| a != b).count();
    // Leaves, which cast whole cards, are most of it.
    assert!(differ < masks[0].len() / 50, "{differ} of {}", masks[0].len());
    for (output, name) in [("color", "color.png"), ("volumes", "volumes.png"), ("color", "color.exr")] {
        let options = ["--technique", "volumes", "--output", output, "-q", "--sun-samples", "2"];
        let drawn = frame(&scene(), &file(name), &options);
        assert_eq!(drawn.status.code(), Some(0), "{}", stderr(&drawn));
        assert!(drawn.stdout.is_empty() && file(name).metadata().unwrap().len() > 5_000);
    }
}

#[test]
fn nothing_is_printed_about_a_display_that_is_not_there() {
    let folder = tempfile::tempdir().unwrap();
    let picture = folder.path().join("picture.png");
    let output = Command::new(env!("CARGO_BIN_EXE_sunplay"))
        .env_remove("XDG_RUNTIME_DIR")
        .arg("frame")
        .arg(scene())
        .args(["--technique", "map", "--at", "17:00", "--size", "16x16", "-q", "-o"])
        .arg(&picture)
        .output()
        .expect("sunplay runs");
    assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(0), ""));
    assert!(picture.exists());
}

#[test]
fn impossible_requests_are_refused_with_advice() {
    let folder = tempfile::tempdir().unwrap();
    let picture = folder.path().join("picture.png");
    let broken = folder.path().join("broken.glb");
    std::fs::write(&broken, "no scene").unwrap();
    let nowhere = folder.path().join("nowhere.glb");
    let ours = scene();
    let cases: [(&Path, &[&str], i32, &str); 15] = [
        (&ours, &[], 1, "nothing was baked for it"),
        (&ours, &["--technique", "truth:hard", "--output", "volumes"], 1, "there are no volumes to show"),
        (&ours, &["--technique", "volumes", "--renderer", "cpu"], 1, "counted by a GPU"),
        (&ours, &["--technique", "truth:hard", "--sun-samples", "4"], 1, "truth:soft:N"),
        (&ours, &["--technique", "volumes:zfail:zpass"], 1, "volumes:triangles"),
        (&ours, &["--technique", "volumes", "--lamp-range", "0"], 1, "metres above 0"),
        (&ours, &["--technique", "volumes", "--place", "95,0"], 1, "off the globe"),
        (&ours, &["--technique", "volumes", "--lamp-range", "-1"], 1, "metres above 0"),
        (&ours, &["--technique", "volumes", "--lamp-range", "5"], 1, "there is no lamp"),
        (&ours, &["--technique", "volumes", "--ambient", "sh2"], 1, "leave --ambient out"),
        (&ours, &["--technique", "volumes", "--light", "sky", "--output", "volumes"], 1, "no shadow volumes"),
        (&ours, &["--technique", "map", "--filter", "nearest"], 1, "--filter nearest has no effect"),
        (&ours, &["--technique", "map", "--output", "visibility", "--ambient", "ao"], 1, "--ambient ao has no effect"),
        (&broken, &["--technique", "volumes"], 3, "broken.glb"),
        (&nowhere, &["--technique", "volumes"], 2, "nowhere.glb"),
    ];
    for (scene, options, code, text) in cases {
        let output = frame(scene, &picture, options);
        assert_eq!(output.status.code(), Some(code), "{options:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(text), "{options:?}: {}", stderr(&output));
        assert!(!picture.exists(), "{options:?} leaves a picture behind");
    }
}
