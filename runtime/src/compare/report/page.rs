//! The report as one page of HTML that needs no network: a viewer of pictures, tables that sort, plots.

use super::tables::{left_out, passes, results, sets};
use super::{Pictures, Report, TechniqueEntry};
use image::ImageError;
use serde::Serialize;
use sunbake::report::plot::{Axis, Plot, Point, Series, scatter};
use sunbake::report::{escape, plain, with_unit};
use sunbake::words::counted;

/// The viewer's controls, and the element that shows its pictures.
const VIEWER: &str = include_str!("viewer.html");
/// Style sheet, which the page holds inline.
const STYLE: &str = include_str!("viewer.css");
/// Its script, one module in three files.
const SCRIPTS: [&str; 3] = [include_str!("pixels.js"), include_str!("viewer.js"), include_str!("controls.js")];
/// Families in the order of plots, with their names there.
const FAMILIES: [(&str, &str); 4] =
    [("baked", "baked"), ("volumes", "shadow volumes"), ("map", "shadow maps"), ("truth", "rays")];

/// Why there is no page.
#[derive(Debug, thiserror::Error)]
pub enum PageError {
    /// A picture cannot be encoded.
    #[error(transparent)]
    Picture(#[from] ImageError),
    /// Numbers cannot be written as JSON.
    #[error(transparent)]
    Json(#[from] serde_json::Error),
}

/// The page of a report.
pub fn page(report: &Report, pictures: &Pictures) -> Result<String, serde_json::Error> {
    let title = format!("{}: baked and live shadows", report.scene.name);
    let body = [
        format!("<h1>{}</h1>\n", escape(&title)),
        lead(report),
        warnings(report),
        limits(report),
        VIEWER.to_owned(),
        results(report),
        plots(report),
        passes(report),
        decisions(report),
        sets(report),
        left_out(report),
        facts(report),
        stored("report", report)?,
        stored("pictures", pictures)?,
        format!("<script type=\"module\">\n{}</script>\n", SCRIPTS.concat()),
    ];
    Ok(sunbake::report::page(&title, STYLE, &body.concat(), ""))
}

/// JSON within the page, without what could end its element.
fn stored(id: &str, value: &impl Serialize) -> Result<String, serde_json::Error> {
    let json = serde_json::to_string(value)?.replace('<', "\\u003c");
    Ok(format!("<script type=\"application/json\" id=\"{id}\">{json}</script>\n"))
}

fn lead(report: &Report) -> String {
    let sentences: String = report.findings().iter().map(|text| format!("<p>{}</p>", escape(text))).collect();
    if sentences.is_empty() {
        return sentences;
    }
    format!("<div class=\"note advice\">{sentences}</div>\n")
}

fn warnings(report: &Report) -> String {
    report.warnings.iter().map(|warning| format!("<p class=\"warning\">{}</p>\n", escape(warning))).collect()
}

fn limits(report: &Report) -> String {
    let line = |limit: &super::LimitEntry| match limit.is_kept() {
        true => format!("<p class=\"note\">{} is nowhere above {}.</p>\n", escape(&limit.key), limit.limit),
        false => format!("<p class=\"warning\">{}</p>\n", escape(&limit.text())),
    };
    report.limits.iter().map(line).collect()
}

fn plots(report: &Report) -> String {
    let plot = |title: &str, label: &str, families: &[(&str, &str)], x: &dyn Fn(&TechniqueEntry) -> f64| {
        let series = families.iter().map(|&(family, name)| Series {
            name: name.into(),
            is_joined: false,
            points: report
                .techniques
                .iter()
                .filter(|technique| technique.family == family)
                .map(|technique| Point { x: x(technique), y: technique.error.mean, label: short(&technique.name) })
                .collect(),
        });
        scatter(&Plot {
            title: title.into(),
            x: Axis::log(label),
            y: Axis::log("mean error of visibility"),
            series: series.filter(|series| !series.points.is_empty()).collect(),
            mark: None,
        })
    };
    let clock = match (&report.machine.adapter, report.machine.is_software) {
        (None, _) => "milliseconds a frame, CPU",
        (Some(_), true) => "milliseconds a frame, software adapter",
        (Some(_), false) => "milliseconds a frame, GPU and the CPU's work for it",
    };
    format!(
        "<h2>Error against time and bytes</h2>\n<p>The nearer to the lower left corner, the better.</p>\n\
         <div class=\"side-by-side\">\n<figure>{}<figcaption>Time per frame, and the error that is left. Time to bake \
         is not included. Rays are left out: theirs is the CPU's time, without finding the \
         surfaces.</figcaption></figure>\n\
         <figure>{}<figcaption>Memory kept from frame to frame: baked maps, shadow maps, the buffers of shadow \
         volumes.</figcaption></figure>\n</div>\n",
        plot("Error and time", clock, &FAMILIES[..3], &|technique| technique.times.frame_ms),
        plot("Error and bytes", "MiB of memory", &FAMILIES, &|technique| technique.memory_bytes as f64
            / f64::from(1 << 20)),
    )
}

/// A name in a plot: without the family, which the colour shows, unless the name is nothing else.
fn short(name: &str) -> String {
    name.split_once(':').map_or(name, |(_, rest)| rest).replace("lanes", "").replace(":filtered", "")
}

/// What techniques decided for their last frames.
fn decisions(report: &Report) -> String {
    let decided = report.techniques.iter().filter(|technique| !technique.plan.is_empty());
    let entry = |technique: &TechniqueEntry| {
        let lines: String = technique.plan.iter().map(|line| format!("<li>{}</li>", escape(line))).collect();
        format!("<dt><code>{}</code></dt><dd><ul>{lines}</ul></dd>\n", escape(&technique.name))
    };
    let entries: String = decided.map(entry).collect();
    if entries.is_empty() {
        return entries;
    }
    format!(
        "<details><summary>What each technique decided for its last frame</summary>\n<dl>\n{entries}</dl></details>\n"
    )
}

fn facts(report: &Report) -> String {
    let machine = &report.machine;
    let times: Vec<String> =
        report.times.iter().map(|time| format!("{} ({:.0}°)", time.clock, time.elevation_deg)).collect();
    let cameras: Vec<&str> = report.cameras.iter().map(|camera| camera.name.as_str()).collect();
    let noise = report.reference.noise.map_or(String::new(), |noise| {
        format!(
            "; its own noise, against four times as many rays, has a mean of {} in its softest frame",
            plain(noise, 2)
        )
    });
    let reference =
        format!("{}, {} a frame on the CPU{noise}", report.reference.name, with_unit(report.reference.frame_ms, "ms"));
    let reference = if report.reference.name.starts_with("truth") { reference } else { report.reference.name.clone() };
    let triangles = counted(report.scene.triangles, "triangle");
    let [cores, threads] = [(machine.cores, "core"), (machine.threads, "thread")].map(|(n, noun)| counted(n, noun));
    let facts = [
        ("scene", format!("{}, {}, SHA-256 {}", report.scene.name, triangles, report.scene.sha256)),
        ("adapter", report.drawn_by()),
        ("machine", format!("{}, {cores}, {threads}, {}", machine.cpu, machine.os)),
        ("reference", reference),
        ("times", times.join(", ")),
        ("cameras", cameras.join("; ")),
        ("rounds", format!("{}; the least of each frame's times counts", report.rounds)),
        ("made by", report.generator.clone()),
    ];
    let lines: String =
        facts.iter().map(|(name, text)| format!("<dt>{name}</dt><dd>{}</dd>\n", escape(text))).collect();
    let notes: String = report.notes.iter().map(|note| format!("<li>{}</li>\n", escape(note))).collect();
    format!("<h2>How it was measured</h2>\n<dl class=\"facts\">\n{lines}</dl>\n<ul>\n{notes}</ul>\n")
}
