//! A report in a real browser: a probe operates the page as a reader would, and returns what it found.
//!
//! Chromium prints a page's document once it is loaded. The probe is two scripts within the page: one in front keeps
//! it from being taken for loaded, one at the end works the controls and leaves its verdict in the document. What is
//! probed is a copy; the page itself is left as it is, its content policy included.

use serde::Deserialize;
use std::ffi::OsString;
use std::fs::File;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

const WATCH: &str = include_str!("browser/watch.js");
const PROBE: &str = concat!(include_str!("browser/hands.js"), include_str!("browser/probe.js"));

/// How long the probe may take. A page that hangs is printed then, without a verdict.
const LIMIT_S: u64 = 180;
/// What Chromium itself may take beyond that.
const GRACE_S: u64 = 60;
/// A narrow window, in which a page is most likely to be too wide. Chromium makes none narrower.
const WINDOW: &str = "--window-size=500,900";

/// What a probe found.
#[derive(Debug, Clone, Deserialize)]
pub struct Verdict {
    /// What is wrong with the page; empty is good.
    pub problems: Vec<String>,
    /// Single checks made.
    pub checks: usize,
    /// Pictures of the report that decoded with the stated size.
    pub pictures: usize,
    /// Options chosen, on both sides together.
    pub options: usize,
    /// Moments shown: cameras times times of day.
    pub moments: usize,
    /// Columns sorted by.
    pub columns: usize,
    /// Rows clicked.
    pub rows: usize,
    /// SVG drawings on the page.
    pub plots: usize,
    /// Pictures compared with what the page says they must be.
    pub twins: usize,
}

/// Operates a report in Chromium. Panics with advice where Chromium is not installed.
pub fn probe(report: &Path) -> Verdict {
    let page = std::fs::read_to_string(report).unwrap_or_else(|error| panic!("{}: {error}", report.display()));
    let folder = tempfile::tempdir().expect("a temporary folder");
    let probed = folder.path().join("probed.html");
    std::fs::write(&probed, with_probe(&page)).expect("a folder to write in");
    let document = printed(&probed, folder.path());
    verdict_in(&document).unwrap_or_else(|| panic!("{}: the probe did not end within {LIMIT_S} s", report.display()))
}

/// A page with the probe in it: in front of all other scripts, and behind them.
fn with_probe(page: &str) -> String {
    let head = page.find("<head>").expect("a report has a head") + "<head>".len();
    let end = page.rfind("</body>").expect("a report has a body");
    let watch = format!("<script>{WATCH}</script>");
    let probe = format!("<script type=\"module\">{PROBE}</script>");
    [&page[..head], &watch, &page[head..end], &probe, &page[end..]].concat()
}

fn verdict_in(document: &str) -> Option<Verdict> {
    let (_, after) = document.rsplit_once("<pre id=\"verdict\">")?;
    let (text, _) = after.split_once("</pre>")?;
    let json = text.replace("&lt;", "<").replace("&gt;", ">").replace("&nbsp;", "\u{a0}").replace("&amp;", "&");
    Some(serde_json::from_str(&json).unwrap_or_else(|error| panic!("{error} in the verdict {json}")))
}

/// Chromium without a window, with a profile in this folder.
pub(crate) fn headless(folder: &Path) -> Command {
    let mut command = Command::new(find_chromium());
    // Root has no sandbox; the page is ours.
    command.args(["--headless", "--no-sandbox", "--no-first-run", WINDOW]);
    command.arg(flag("--user-data-dir=", &folder.join("profile"))).stdin(Stdio::null()).stderr(Stdio::null());
    command
}

/// The document that a page has become once it is loaded.
fn printed(page: &Path, folder: &Path) -> String {
    let document = folder.join("document.html");
    let mut command = headless(folder);
    command.args(["--disable-gpu", "--dump-dom"]).arg(format!("--timeout={}", LIMIT_S * 1000));
    command.arg(flag("file://", page)).stdout(File::create(&document).expect("a folder to write in"));
    let mut child = command.spawn().expect("Chromium starts");
    let start = Instant::now();
    while child.try_wait().expect("a child can be waited for").is_none() {
        if start.elapsed() > Duration::from_secs(LIMIT_S + GRACE_S) {
            child.kill().expect("a child can be killed");
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    let bytes = std::fs::read(&document).expect("what was written");
    String::from_utf8_lossy(&bytes).into_owned()
}

fn flag(name: &str, path: &Path) -> OsString {
    let mut flag = OsString::from(name);
    flag.push(path);
    flag
}

/// What a browser may be called: what `CHROMIUM` says, or the usual names.
pub(crate) fn names() -> Vec<OsString> {
    let usual = || ["chromium", "chromium-browser", "google-chrome"].map(OsString::from).to_vec();
    std::env::var_os("CHROMIUM").map_or_else(usual, |name| vec![name])
}

fn find_chromium() -> OsString {
    let found = names().into_iter().find(|name| crate::needs::answers(name));
    found.unwrap_or_else(|| {
        panic!(
            "none of {:?} runs, and reports are tested in a browser: run tests/setup, install Chromium (Debian: \
             chromium), or name one in CHROMIUM",
            names()
        )
    })
}
