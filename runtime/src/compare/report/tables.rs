//! The tables of a report's page.

use super::{LeftOut, Passes, Report, SetEntry, TechniqueEntry};
use sunbake::report::{Cell, Column, Row, Table, escape, plain, with_unit};
use sunbake::words::counted;

/// Errors and costs of each technique.
pub(super) fn results(report: &Report) -> String {
    let columns = vec![
        Column::words("technique", "A click shows it on the left of the picture"),
        Column::numbers("mean", "error", "Mean error of visibility, 0 to 1, over pixels that show a surface"),
        Column::numbers("rms", "error", "Root of the mean square: large where few pixels are far off"),
        Column::numbers("99 %", "error", "99 in 100 pixels have a smaller error"),
        Column::numbers("wrong", "% of pixels", "Error above a half: sun for shade, or shade for sun"),
        Column::numbers("penumbra", "mean", "Mean error where the reference sees a part of the sun"),
        Column::numbers("outside", "mean", "Mean error everywhere else"),
        Column::numbers("false light", "mean", "Visibility where the reference is all dark: light through walls"),
        Column::numbers("false shade", "mean", "Shade where the reference is in full light"),
        Column::numbers("similarity", "SSIM", "Structural similarity of the lit pictures, 1 for equal ones"),
        Column::numbers(
            "centre",
            "% wrong",
            "For techniques that take the sun for a point: against truth of its centre",
        ),
        Column::numbers(
            "frame",
            "ms",
            "Passes by the adapter's clock, and the CPU's work for them; mean over frames of the least of the rounds",
        ),
        Column::numbers("memory", "MiB", "Kept from frame to frame, beyond the scene"),
        Column::numbers("on disk", "MiB", "Files of times, without the scene; nothing where they were not written"),
        Column::numbers("bake", "s", "Before the first frame, on the machine that baked"),
    ];
    let table = Table {
        caption: format!(
            "Compared with {}, over {} of {} by {} pixels. Click a heading to sort.",
            report.reference.name,
            counted((report.cameras.len() * report.times.len()) as u64, "frame"),
            report.size[0],
            report.size[1]
        ),
        columns,
        rows: report.techniques.iter().enumerate().map(|(i, technique)| result(i, technique)).collect(),
    };
    format!("<h2>Error and cost of each technique</h2>\n{}", table.html())
}

fn result(index: usize, technique: &TechniqueEntry) -> Row {
    let number = |value: f64| Cell::number(&plain(value, 3), value);
    let percent = |share: f64| Cell::number(&format!("{:.3}", share * 100.0), share);
    let mebibytes = |bytes: u64| number(bytes as f64 / f64::from(1 << 20));
    let error = &technique.error;
    Row {
        cells: vec![
            Cell::html(format!("<code>{}</code>", escape(&technique.name)), None),
            number(error.mean),
            number(error.rms),
            number(error.p99),
            percent(error.wrong_share),
            or_none(error.penumbra.map(number)),
            number(error.outside),
            or_none(error.false_light.map(number)),
            or_none(error.false_shade.map(number)),
            Cell::number(&format!("{:.4}", error.ssim), error.ssim),
            or_none(technique.hard_error.map(|error| percent(error.wrong_share))),
            number(technique.times.frame_ms),
            mebibytes(technique.memory_bytes),
            or_none(technique.disk_bytes.map(mebibytes)),
            or_none(technique.preparation.bake_s.map(number)),
        ],
        data: vec![("technique".into(), index.to_string())],
        ..Row::default()
    }
}

fn or_none(value: Option<Cell>) -> Cell {
    value.unwrap_or_else(Cell::empty)
}

/// Where the time goes.
pub(super) fn passes(report: &Report) -> String {
    let columns = vec![
        Column::words("technique", ""),
        Column::numbers("depth", "ms", "The camera's depth pass"),
        Column::numbers("volumes", "ms", "Shadow volumes in the stencil buffer"),
        Column::numbers("maps", "ms", "Drawing shadow maps, and pictures of casters"),
        Column::numbers("light", "ms", "Visibility of the sun at each pixel"),
        Column::numbers("all passes", "ms", "From the start of the first pass to the end of the last"),
        Column::numbers("CPU", "ms", "To find what the passes draw: silhouettes, or the maps' projections"),
        Column::numbers("call to picture", "ms", "Includes reading the picture back, which a window does not do"),
        Column::numbers("setting up", "s", "Uploading the scene, and building pipelines"),
    ];
    let number = |value: f64| Cell::number(&plain(value, 3), value);
    let row = |technique: &TechniqueEntry| {
        let times = &technique.times;
        let pass = |of: fn(&Passes) -> f64| {
            times.passes.as_ref().map(of).filter(|&ms| ms > 0.0).map_or_else(Cell::empty, number)
        };
        Row::of(vec![
            Cell::html(format!("<code>{}</code>", escape(&technique.name)), None),
            pass(|p| p.depth_ms),
            pass(|p| p.volumes_ms),
            pass(|p| p.maps_ms),
            pass(|p| p.light_ms),
            pass(|p| p.all_ms),
            number(times.cpu_ms),
            number(times.wall_ms),
            number(technique.preparation.setup_s),
        ])
    };
    let table = Table {
        caption: "Means over all frames; nothing is kept from one frame to the next.".into(),
        columns,
        rows: report.techniques.iter().map(row).collect(),
    };
    format!("<h2>Where the time goes</h2>\n{}", table.html())
}

/// What was baked.
pub(super) fn sets(report: &Report) -> String {
    if report.scene.sets.is_empty() {
        return String::new();
    }
    let columns = vec![
        Column::numbers("lanes", "", "Lines across the sun's disc"),
        Column::numbers("bits", "", "Of a stored time"),
        Column::numbers("texels", "", "Texels that hold a surface point"),
        Column::numbers("density", "texels/m", ""),
        Column::words("engine", "What computed the times"),
        Column::numbers("bake", "s", "Without ambient light"),
        Column::numbers("files", "", "Files of times, without the scene"),
        Column::numbers("tracks", "s", "To find them, on top"),
        Column::numbers("files of tracks", "", "In place of those of times"),
    ];
    let size = |bytes: u64| Cell::number(&with_unit(bytes as f64, "bytes"), bytes as f64);
    let row = |set: &SetEntry| {
        Row::of(vec![
            Cell::number(&set.lanes.to_string(), set.lanes as f64),
            Cell::number(&set.bits.to_string(), f64::from(set.bits)),
            Cell::number(&plain(set.texels as f64, 3), set.texels as f64),
            Cell::number(&plain(set.texels_per_metre, 3), set.texels_per_metre),
            Cell::text(&set.engine),
            Cell::number(&plain(set.bake_s, 3), set.bake_s),
            size(set.disk_bytes),
            or_none(set.tracks.map(|tracks| Cell::number(&plain(tracks.bake_s, 3), tracks.bake_s))),
            or_none(set.tracks.map(|tracks| size(tracks.disk_bytes))),
        ])
    };
    let table = Table { caption: String::new(), columns, rows: report.scene.sets.iter().map(row).collect() };
    format!("<h2>What was baked</h2>\n{}", table.html())
}

/// Techniques that were left out, and why.
pub(super) fn left_out(report: &Report) -> String {
    if report.left_out.is_empty() {
        return String::new();
    }
    let line = |left: &LeftOut| format!("<li><code>{}</code>: {}</li>\n", escape(&left.name), escape(&left.reason));
    let lines: String = report.left_out.iter().map(line).collect();
    format!("<h2>What was left out</h2>\n<ul>\n{lines}</ul>\n")
}
