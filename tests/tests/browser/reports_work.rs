//! The page of a report: its controls do what they say, its canvas shows the pictures that it holds, light and
//! colours are those of the renderer, and nothing comes from the network. The probe is shown able to fail: each fault
//! is caught.

use glam::Vec3;
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};
use libtest_mimic::Trial;
use serde_json::{Value, json};
use std::fmt::Write;
use sunbake_runtime::Raster;
use sunbake_runtime::compare::visibility_difference;
use sunbake_runtime::light::{codes_from_display, display_from_light};
use sunbake_runtime::sheet::heat_map;
use sunbake_tests::browser::{Verdict, probe};
use sunbake_tests::needs::{Need, trial};

macro_rules! viewer_file {
    ($name:literal) => {
        include_str!(concat!("../../../runtime/src/compare/report/", $name))
    };
}

const SHELL: &str = include_str!("../../src/browser/shell.html");
const STYLE: &str = viewer_file!("viewer.css");
const VIEWER: &str = viewer_file!("viewer.html");
const SCRIPT: &str = concat!(viewer_file!("pixels.js"), viewer_file!("viewer.js"), viewer_file!("controls.js"));

const SIZE: [u32; 2] = [32, 18];
const CAMERAS: usize = 2;
const TIMES: usize = 3;
const TECHNIQUES: [(&str, &str); 3] = [("baked:16bit", "baked"), ("volumes", "volumes"), ("map:cascades", "map")];
const SCALE: f32 = 7.3;

/// Of a frame: visibility by the reference (0) or a technique (1 and up), one code a pixel, all different.
fn seen(camera: usize, time: usize, by: usize) -> Vec<u8> {
    let edge = 5 + 7 * time as u32 + 3 * camera as u32;
    let code = |x: u32, y: u32| {
        let soft = (128 + 24 * i64::from(x) - 24 * i64::from(edge) + i64::from(y)).clamp(0, 255);
        (soft - (by as i64 * (i64::from(x + y) % 5) * 6)).clamp(0, 255) as u8
    };
    pixels().map(|(x, y)| code(x, y)).collect()
}

/// Of a frame: the scene with the sun hidden or open, three codes a pixel.
fn scene(camera: usize, open: bool) -> Vec<u8> {
    let code = |x: u32, y: u32, k: u32| (x * 3 + y * 4 + k * 9 + camera as u32 * 11) as u8 / if open { 1 } else { 3 };
    pixels().flat_map(|(x, y)| [0, 1, 2].map(|k| code(x, y, k))).collect()
}

fn pixels() -> impl Iterator<Item = (u32, u32)> {
    (0..SIZE[0] * SIZE[1]).map(|i| (i % SIZE[0], i / SIZE[0]))
}

/// A picture as an address, percent by percent.
fn address(codes: &[u8], color: ExtendedColorType) -> String {
    let mut png = Vec::new();
    PngEncoder::new(&mut png).write_image(codes, SIZE[0], SIZE[1], color).expect("a small picture");
    png.iter().fold("data:image/png,".into(), |mut address, byte| {
        write!(address, "%{byte:02x}").expect("a string grows");
        address
    })
}

fn moments() -> impl Iterator<Item = [usize; 2]> {
    (0..CAMERAS * TIMES).map(|i| [i / TIMES, i % TIMES])
}

fn report() -> Value {
    let times = [("06:29", 0.08, 12.3), ("12:00", 0.5, 61.0), ("17:45", 0.9, 9.5)];
    let error = |i: usize| json!({ "mean": 0.01 * i as f64, "p99": 0.2, "worst": 1.0, "wrong_share": 0.03 });
    let frame =
        |i, [camera, time]: [usize; 2]| json!({ "camera": camera, "time": time, "error": error(i), "frame_ms": 1.5 });
    let technique = |(i, (name, family)): (usize, &(&str, &str))| {
        let frames: Vec<Value> = moments().map(|moment| frame(i, moment)).collect();
        json!({ "name": name, "family": family, "error": error(i), "times": { "frame_ms": 1.5 }, "frames": frames })
    };
    let times = times.map(|(clock, t, deg)| json!({ "t": t, "clock": clock, "elevation_deg": deg }));
    json!({
        "format": "sunbake-compare", "version": 1, "scene": { "name": "two ramps" }, "size": SIZE,
        "machine": { "adapter": "a test", "is_software": true }, "reference": { "name": "truth:soft:64" },
        "cameras": [{ "name": "default" }, { "name": "street" }],
        "times": times, "left_out": [],
        "techniques": TECHNIQUES.iter().enumerate().map(technique).collect::<Vec<_>>(),
    })
}

fn pictures() -> Value {
    let frame = |[camera, time]: [usize; 2]| {
        let grey = |by| address(&seen(camera, time, by), ExtendedColorType::L8);
        let color = |open| address(&scene(camera, open), ExtendedColorType::Rgb8);
        let by_techniques: Vec<String> = (1..=TECHNIQUES.len()).map(grey).collect();
        json!({ "camera": camera, "time": time, "scale": SCALE, "dark": color(false), "open": color(true),
                "reference": grey(0), "seen": by_techniques })
    };
    json!({ "size": SIZE, "frames": moments().map(frame).collect::<Vec<_>>() })
}

/// What the renderer's own code makes of the same numbers.
fn expected() -> Value {
    let shown = |[camera, time]: [usize; 2]| {
        let of = |mode: &str, codes: Vec<[u8; 3]>| {
            let (left, right) = (time, "reference");
            json!({ "camera": camera, "time": time, "left": left, "right": right, "mode": mode, "codes": codes })
        };
        let share = |by| visibility(&seen(camera, time, by));
        let [left, reference] = [time + 1, 0].map(share);
        [
            of("picture", lit(camera, &left)),
            of("difference", heat_map(&visibility_difference(&left, &reference)).pixels),
        ]
    };
    moments().flat_map(shown).collect()
}

fn visibility(codes: &[u8]) -> Raster<f32> {
    Raster { size: SIZE, pixels: codes.iter().map(|&code| f32::from(code) / 255.0).collect() }
}

fn lit(camera: usize, seen: &Raster<f32>) -> Vec<[u8; 3]> {
    let light = |code: &[u8; 3]| SCALE * (Vec3::from(code.map(f32::from)) / 255.0).powf(2.0);
    let [dark, open] = [false, true].map(|open| scene(camera, open));
    let lights = dark.as_chunks().0.iter().zip(open.as_chunks().0);
    let pixel = |((dark, open), &share)| codes_from_display(display_from_light(light(dark).lerp(light(open), share)));
    lights.zip(&seen.pixels).map(pixel).collect()
}

/// A small report, and pieces of its page to replace.
struct Page {
    report: Value,
    pictures: Value,
    replaced: Vec<[String; 2]>,
}

impl Page {
    fn new() -> Self {
        Self { report: report(), pictures: pictures(), replaced: Vec::new() }
    }

    fn with(mut self, from: &str, to: &str) -> Self {
        self.replaced.push([from.into(), to.into()]);
        self
    }

    fn html(&self) -> String {
        let row = |(i, (name, _)): (usize, &(&str, &str))| {
            let mean = &self.report["techniques"][i]["error"]["mean"];
            format!("<tr data-technique=\"{i}\"><td>{name}</td><td>{mean}</td></tr>")
        };
        let parts = [
            ("{{CSS}}", STYLE.to_owned()),
            ("{{VIEWER}}", VIEWER.to_owned()),
            ("{{ROWS}}", TECHNIQUES.iter().enumerate().map(row).collect()),
            ("{{REPORT}}", self.report.to_string()),
            ("{{PICTURES}}", self.pictures.to_string()),
            ("{{EXPECTED}}", expected().to_string()),
            ("{{SCRIPT}}", SCRIPT.to_owned()),
        ];
        let page = parts.iter().fold(SHELL.to_owned(), |page, (name, text)| page.replace(name, text));
        self.replaced.iter().fold(page, |page, [from, to]| {
            assert!(page.contains(from), "the page has no {from}");
            page.replace(from, to)
        })
    }

    fn probed(&self) -> Verdict {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = folder.path().join("report.html");
        std::fs::write(&file, self.html()).expect("a folder to write in");
        probe(&file)
    }

    /// The page is broken; this is among what the probe has to say of it.
    fn assert_caught(&self, said: &[&str]) {
        let problems = self.probed().problems;
        for said in said {
            let is_said = problems.iter().any(|problem| problem.contains(said));
            assert!(is_said, "not among the problems: {said}; they are {problems:#?}");
        }
    }
}

fn every_control_does_what_it_says() {
    let found = Page::new().probed();
    assert_eq!(found.problems, [""; 0]);
    let moments = CAMERAS * TIMES;
    assert_eq!(found.pictures, moments * (3 + TECHNIQUES.len()));
    assert_eq!((found.options, found.moments), (2 * (TECHNIQUES.len() + 1), moments));
    assert_eq!((found.columns, found.rows, found.twins), (2, TECHNIQUES.len(), 2 * moments));
    assert!(found.checks > 200, "{}", found.checks);
}

fn a_missing_or_broken_picture_is_caught() {
    let mut page = Page::new();
    page.pictures["frames"][4]["seen"][1] = Value::Null;
    page.pictures["frames"][0]["dark"] = "data:image/png;base64,iVBORw0KGgo=".into();
    let said =
        ["volumes of camera 1 at time 1 is missing or broken", "dark of camera 0 at time 0 is missing or broken"];
    page.assert_caught(&said);
    let silent = page.with("message.hidden = !problem ||", "message.hidden = true ||");
    silent.assert_caught(&["the page does not say that the picture of 1 is missing"]);
}

fn a_swapped_picture_is_caught() {
    let page = Page::new().with("frame.seen?.[choice]", "frame.seen?.[0]");
    page.assert_caught(&["volumes chosen on the left: the canvas does not show the picture of 1"]);
}

fn an_error_of_a_script_is_caught() {
    let page = Page::new().with("<h1>", "<script>nothing.of.the.kind()</script><h1>");
    page.assert_caught(&["nothing is not defined"]);
    Page::new()
        .with("function start() {", "function start() { throw new Error('early');")
        .assert_caught(&["no viewer"]);
}

fn what_comes_from_outside_is_caught() {
    let page = Page::new().with("<h1>", "<img alt=\"\" src=\"https://example.invalid/a.png\"><h1>");
    page.assert_caught(&[
        "refers to the network: https://example.invalid/a.png",
        "against the content policy: img-src",
    ]);
}

fn controls_that_do_nothing_are_caught() {
    let page = Page::new()
        .with("showDivider();\n  followInAddress();\n  paint();", "")
        .with("change({ time: Number(target.value) })", "{}")
        .with("(order === \"ascending\" ? 1 : -1)", "1");
    page.assert_caught(&["the picture is not divided at", "does not say 06:29", "is not descending"]);
}

/// Frames that are asked for late take less long.
fn an_early_frame_that_comes_late_is_caught() {
    let late = "await new Promise((done) => setTimeout(done, 100 * (2 - asked.time)));";
    Page::new().with("if (ticket !== newest) return;", late).assert_caught(&["after quick moves of the time"]);
}

fn another_tone_or_heat_is_caught() {
    let page = Page::new().with("EXPOSURE = 0.62", "EXPOSURE = 0.65").with("[72, 24, 102]", "[72, 24, 112]");
    page.assert_caught(&["picture of 0 at time 0 is", "difference of 0 at time 0 is"]);
}

pub fn trials() -> Vec<Trial> {
    let all: [(&str, fn()); 8] = [
        ("every_control_does_what_it_says", every_control_does_what_it_says),
        ("a_missing_or_broken_picture_is_caught", a_missing_or_broken_picture_is_caught),
        ("a_swapped_picture_is_caught", a_swapped_picture_is_caught),
        ("an_error_of_a_script_is_caught", an_error_of_a_script_is_caught),
        ("what_comes_from_outside_is_caught", what_comes_from_outside_is_caught),
        ("controls_that_do_nothing_are_caught", controls_that_do_nothing_are_caught),
        ("an_early_frame_that_comes_late_is_caught", an_early_frame_that_comes_late_is_caught),
        ("another_tone_or_heat_is_caught", another_tone_or_heat_is_caught),
    ];
    all.map(|(name, test)| trial(name, vec![Need::browser()], test)).into()
}
