//! The report that `sunplay compare` writes of every technique: its numbers, and its page. Needs a GPU adapter as well.

use libtest_mimic::Trial;
use sunbake_tests::browser::probe;
use sunbake_tests::compare_command::{assert_valid, compare, folder_with_set, report_in};
use sunbake_tests::needs::{Need, trial};
use sunbake_tests::stderr;

fn a_report_holds_every_technique_and_works_in_a_browser() {
    let (temporary, set) = folder_with_set();
    let folder = temporary.path().join("report");
    let output = compare(&set, &folder, &["--against", "truth:soft:16"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let report = report_in(&folder);
    assert_valid(&report);
    let techniques = report["techniques"].as_array().unwrap();
    // Two counts of lanes, two depths, three filters; volumes; ten maps; truth of the sun's centre.
    assert_eq!(techniques.len(), 12 + 1 + 10 + 1, "{}", report["left_out"]);
    let left_out = report["left_out"].as_array().unwrap();
    assert!(left_out.len() == 1 && left_out[0]["name"] == "baked:tracks", "{left_out:?}");
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

pub fn trials() -> Vec<Trial> {
    let name = "a_report_holds_every_technique_and_works_in_a_browser";
    vec![trial(name, vec![Need::browser()], a_report_holds_every_technique_and_works_in_a_browser)]
}
