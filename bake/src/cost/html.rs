//! The report as a page.

use super::report::{CostReference, CostReport, CostRow, ErrorSummary, How, Sweep};
use crate::report::plot::{self, Axis, Plot, Point, Series};
use crate::report::{Cell, Column, Row, Table, escape, page, plain, whole, with_unit};

/// What stands beside a row that a preset has, or that a knee is.
const STYLE: &str = "\
.tag { color: var(--accent); font-size: .85em; margin-left: .4em; white-space: nowrap; }
.why { display: block; width: 13rem; color: var(--soft); font-size: .85em; line-height: 1.3; }
";

/// The report as an HTML document.
pub fn html(report: &CostReport) -> String {
    let title = format!("What accuracy costs: {}", report.scene.file);
    let sweeps: String = report.sweeps.iter().map(|sweep| section(sweep, &report.reference)).collect();
    let body = format!(
        "<h1>{}</h1>\n{}{}{}<h2>How to read this</h2>\n{}{sweeps}<footer>{}; format {} {}. \
         The numbers are in <code>report.json</code>.</footer>",
        escape(&title),
        facts(report),
        advice(report),
        warnings(report),
        explanation(report),
        escape(&report.generator),
        escape(&report.format),
        report.version
    );
    page(&title, STYLE, &body, "")
}

fn facts(report: &CostReport) -> String {
    let sun = &report.sun;
    let day = sun.local.as_ref().map_or(String::new(), |[start, end]| format!("{start} to {end}, "));
    let rows = || report.sweeps.iter().flat_map(|sweep| &sweep.rows);
    let measured = rows().filter(|row| row.is_measured()).count();
    let predicted = rows().filter(|row| row.how == How::Sampled).count();
    let all: usize = report.sweeps.iter().map(|sweep| sweep.rows.len()).sum();
    let facts = [
        ("machine", report.machine.text()),
        ("scene", format!("{}, {} triangles", report.scene.file, whole(report.scene.triangles))),
        ("sun", format!("{day}{} minutes", plain(sun.duration_min, 4))),
        ("time", format!("{} of {}", with_unit(report.spent_s, "s"), with_unit(report.budget_s, "s"))),
        ("rows", format!("{measured} of {all} measured, the time of {predicted} of these predicted")),
    ];
    let entry = |(name, value): &(&str, String)| format!("<dt>{name}</dt><dd>{}</dd>", escape(value));
    format!("<dl class=\"facts\">{}</dl>\n", facts.iter().map(entry).collect::<String>())
}

fn advice(report: &CostReport) -> String {
    let sentences: Vec<String> = match &report.advice[..] {
        [] => vec!["<p>Too little was measured to advise anything: give a larger <code>--budget</code>.</p>".into()],
        [first, rest @ ..] => {
            let first = format!("<p class=\"lead\">{}</p>", with_code(first));
            std::iter::once(first).chain(rest.iter().map(|text| format!("<p>{}</p>", with_code(text)))).collect()
        }
    };
    format!("<div class=\"note advice\">\n{}\n</div>\n", sentences.join("\n"))
}

fn warnings(report: &CostReport) -> String {
    report.warnings.iter().map(|text| format!("<div class=\"warning\">{}</div>\n", escape(text))).collect()
}

/// Text as HTML; what stands between back ticks is code.
fn with_code(text: &str) -> String {
    let part = |(k, part): (usize, &str)| {
        let part = escape(part);
        if k % 2 == 1 { format!("<code>{part}</code>") } else { part }
    };
    text.split('`').enumerate().map(part).collect()
}

fn explanation(report: &CostReport) -> String {
    let CostReference {
        points,
        buried_points,
        lanes,
        moments,
        point_rays,
        page_texels,
        measured_texels,
        texel_rays,
        ..
    } = report.reference;
    let edge = report.reference.page_size_texels;
    let [points, buried, page_texels, measured_texels] =
        [points, buried_points, page_texels, measured_texels].map(whole);
    let [moments, point_rays, texel_rays] = [moments, point_rays, texel_rays].map(whole);
    format!(
        "<p><b>Whole bakes</b>: a set is baked, read from its files as a runtime reads it, and compared with the exact \
         answer at {points} points drawn evenly by area over all surfaces ({buried} more lie inside solids and do not \
         count). The exact answer is that at the point itself, along {lanes} lanes across the sun's disc, compared at \
         {moments} moments of the day; and for the sky, the ambient visibility by {point_rays} rays. Where there was \
         no time for a bake, only the texels that the points read are baked (a sparse bake): its error of sun is the \
         same, its ambient visibility is not stitched at seams, and its time is a prediction.</p>\n\
         <p><b>Settings at texels</b> are varied one at a time on {measured_texels} of the {page_texels} texels of a \
         page of {edge}, in runs of neighbours; seconds are scaled to all of them. Each is compared with the best \
         answer for the same texel (for the sky {texel_rays} rays), so the error is that of the setting alone, \
         without that of texels that are too large.</p>\n\
         <p><b>Minutes of sun</b>: for how much of the day the sun is wrong, where half of its disc counts half. Point \
         at a circle or a dot for its name; a ring marks the knee, the point farthest below the straight line between \
         a curve's ends, both axes being logarithmic. Where a small page cannot hold all charts there are several, so \
         a smaller `--size` may come out as dense as a larger one. Click a heading to sort.</p>\n"
    )
}

fn section(sweep: &Sweep, reference: &CostReference) -> String {
    let measured_on = match sweep.measured_on.as_str() {
        "texels" => {
            format!("Measured on {} of {} texels.", whole(reference.measured_texels), whole(reference.page_texels))
        }
        _ => "Whole bakes.".into(),
    };
    format!(
        "<h2 id=\"{}\">{}</h2>\n<p>{measured_on} The error is {}.</p>\n{}{}",
        escape(&sweep.id),
        escape(&sweep.title),
        escape(&sweep.meaning),
        table(sweep),
        figures(sweep)
    )
}

fn table(sweep: &Sweep) -> String {
    let has = |of: fn(&CostRow) -> bool| sweep.rows.iter().any(of);
    let (has_sun, has_ambient) = (has(|row| row.sun_min.is_some()), has(|row| row.ambient.is_some()));
    let (has_disk, has_texels) = (has(|row| row.disk_bytes.is_some()), has(|row| row.texels.is_some()));
    let mut columns = vec![
        Column::words("setting", "as on the command line"),
        Column::numbers("time", "s", "wall-clock; of settings at texels scaled to all texels of the page"),
    ];
    if has_disk {
        columns.push(Column::numbers("on disk", "MiB", "all files of the set"));
    }
    columns.push(Column::numbers("on the GPU", "MiB", "what was varied, as a runtime holds it"));
    if has_texels {
        columns.push(Column::numbers("texels", "", "that stand for a point of a surface"));
    }
    for (is_there, what, unit) in [(has_sun, "sun", "min"), (has_ambient, "sky", "visibility")] {
        if is_there {
            columns.push(Column::numbers(&format!("{what}, mean"), unit, "mean error"));
            columns.push(Column::numbers("99 % under", unit, "99 in 100 are no worse"));
            columns.push(Column::numbers("worst", unit, "the worst"));
        }
    }
    let row = |row: &CostRow| {
        let mut cells = vec![name_cell(row, sweep), number(row.seconds)];
        cells.extend(has_disk.then(|| mib(row.disk_bytes)));
        cells.push(mib(row.gpu_bytes));
        cells.extend(has_texels.then(|| row.texels.map_or(Cell::empty(), |n| Cell::number(&whole(n), n as f64))));
        let errors = [(has_sun, row.sun_min), (has_ambient, row.ambient)];
        cells.extend(errors.into_iter().filter(|(is_there, _)| *is_there).flat_map(|(_, error)| error_cells(error)));
        Row { is_marked: is_knee(row, sweep), is_muted: !row.is_measured(), ..Row::of(cells) }
    };
    Table { caption: String::new(), columns, rows: sweep.rows.iter().map(row).collect() }.html()
}

fn is_knee(row: &CostRow, sweep: &Sweep) -> bool {
    sweep.knee.as_ref() == Some(&row.name)
}

fn name_cell(row: &CostRow, sweep: &Sweep) -> Cell {
    let tag = if is_knee(row, sweep) { "<span class=\"tag\">knee</span>" } else { "" };
    let note = row.note.as_ref().map_or(String::new(), |note| format!("<span class=\"why\">{}</span>", escape(note)));
    Cell::html(format!("<code>{}</code>{tag}{note}", escape(&row.name)), None)
}

fn number(value: Option<f64>) -> Cell {
    value.map_or(Cell::empty(), |value| Cell::number(&plain(value, 3), value))
}

fn mib(bytes: Option<u64>) -> Cell {
    number(bytes.map(|bytes| bytes as f64 / f64::from(1 << 20)))
}

fn error_cells(error: Option<ErrorSummary>) -> [Cell; 3] {
    [error.map(|e| e.mean), error.map(|e| e.p99), error.map(|e| e.worst)].map(number)
}

/// Error against time, and against bytes where the setting changes them.
fn figures(sweep: &Sweep) -> String {
    let is_of_bytes = matches!(sweep.id.as_str(), "bits" | "layers");
    let seconds: Figure = (Axis::log("seconds"), |row| row.seconds);
    let mib: Figure = (Axis::log("MiB on the GPU"), |row| row.gpu_bytes.map(|bytes| bytes as f64 / f64::from(1 << 20)));
    let axes: Vec<Figure> = match sweep.id.as_str() {
        // Filters but that of tracks draw the same set.
        "filters" => Vec::new(),
        _ if is_of_bytes => vec![mib],
        "engines" | "sky" => vec![seconds],
        _ => vec![seconds, mib],
    };
    let drawn: String = axes.into_iter().filter_map(|figure| drawn(sweep, figure)).collect();
    if drawn.is_empty() { drawn } else { format!("<div class=\"side-by-side\">{drawn}</div>\n") }
}

/// An axis, and a row's value along it.
type Figure = (Axis, fn(&CostRow) -> Option<f64>);

fn drawn(sweep: &Sweep, (x, of): Figure) -> Option<String> {
    let point = |row: &CostRow| {
        let label = row.name.trim_start_matches("--").to_owned();
        Some(Point { x: of(row)?, y: row.error()?.mean, label })
    };
    let mut series: Vec<Series> = Vec::new();
    for row in &sweep.rows {
        let Some(point) = point(row) else { continue };
        match series.iter_mut().find(|series| series.name == row.curve) {
            Some(series) => series.points.push(point),
            None => series.push(Series { name: row.curve.clone(), is_joined: true, points: vec![point] }),
        }
    }
    if series.is_empty() {
        return None;
    }
    let is_of_time = x.label == "seconds";
    let knee = sweep.rows.iter().find(|row| is_of_time && is_knee(row, sweep)).and_then(point);
    let mark = knee.map(|knee| Point { label: format!("knee: {}", knee.label), ..knee });
    let y = Axis::log(if sweep.rows.iter().any(|row| row.sun_min.is_some()) {
        "minutes of sun wrong, mean"
    } else {
        "error of ambient visibility, mean"
    });
    let title = format!("{}: error against {}", sweep.title, if is_of_time { "time" } else { "bytes" });
    Some(format!("<figure>{}</figure>", plot::scatter(&Plot { title, x, y, series, mark })))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn back_ticks_are_code_and_the_rest_is_text() {
        assert_eq!(with_code("take `--size 4` & <b>"), "take <code>--size 4</code> &amp; &lt;b&gt;");
    }
}
