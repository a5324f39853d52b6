//! `sunbake cost`.

use super::args::{CostCommandArgs, OutputArgs};
use super::bake::{in_file, path_file_of, sun};
use std::fmt::Write;
use sunbake::console::{Failure, ProgressLine, print, print_json, warn};
use sunbake::cost::report::{CostReport, CostRow};
use sunbake::cost::{self, CostError, CostSettings};
use sunbake::report::folder::{self, REPORT_HTML, REPORT_JSON};
use sunbake::report::{plain, with_unit};

/// Measures, and writes the report.
pub fn run(args: &CostCommandArgs) -> Result<(), Failure> {
    let settings = CostSettings {
        sun: sun(&args.sun)?,
        objects: args.objects.wishes_with(&args.densities),
        page_size_texels: args.size,
        budget_s: args.budget,
        threads: args.threads,
        max_memory_bytes: args.max_memory,
    };
    let progress = ProgressLine::new(args.printing.quiet).listening();
    // The folder before anything is spent: nobody should wait for a report that cannot be kept.
    let folder = folder::begin(&args.output, args.force, REPORT_JSON)?;
    let measured = cost::cost(&args.scene, &settings, folder.path(), &progress);
    progress.clear();
    let report = measured.map_err(|error| failure(error, args).after_signal(progress.signal_code()))?;
    let files = [(REPORT_JSON, report.json().into_bytes()), (REPORT_HTML, cost::html(&report).into_bytes())];
    folder::finish(folder, &files)?;
    tell(args, &report)
}

fn failure(error: CostError, args: &CostCommandArgs) -> Failure {
    let file = match &error {
        CostError::Bake(error) => path_file_of(error, &args.sun, None),
        CostError::NoSun(_) => args.sun.path.as_deref(),
        _ => None,
    };
    in_file(error.into(), file)
}

fn tell(args: &CostCommandArgs, report: &CostReport) -> Result<(), Failure> {
    let OutputArgs { json, quiet, .. } = args.printing;
    if !quiet {
        report.warnings.iter().for_each(|sentence| warn(sentence));
    }
    match (json, quiet) {
        (true, _) => print_json(report),
        (false, true) => Ok(()),
        (false, false) => print(&text(args, report)),
    }
}

/// The advice, and with -v every row.
fn text(args: &CostCommandArgs, report: &CostReport) -> String {
    let mut text = format!("{} -> {}\n", args.scene.display(), args.output.display());
    for sentence in &report.advice {
        // Writing to a string does not fail.
        let _ = writeln!(text, "  {}", sentence.replace('`', ""));
    }
    let rows = || report.sweeps.iter().flat_map(|sweep| &sweep.rows);
    let unmeasured = rows().filter(|row| !row.is_measured()).count();
    if args.printing.verbose {
        rows().for_each(|row| text += &line(row));
    } else if unmeasured > 0 {
        let _ =
            writeln!(text, "  {unmeasured} of {} rows were not measured: -v or the report says why", rows().count());
    }
    let _ = writeln!(text, "  {} of {}", with_unit(report.spent_s, "s"), with_unit(report.budget_s, "s"));
    text
}

fn line(row: &CostRow) -> String {
    let seconds = row.seconds.map_or(String::new(), |seconds| format!("{} s", plain(seconds, 3)));
    let sun = row.sun_min.map_or(String::new(), |error| format!("{} min of sun", plain(error.mean, 3)));
    let ambient = row.ambient.map_or(String::new(), |error| format!("{} of the sky", plain(error.mean, 3)));
    let note = row.note.as_deref().unwrap_or_default();
    format!("  {:<18}{seconds:>10}  {sun:<20}{ambient:<20}{note}\n", row.name).trim_end().to_owned() + "\n"
}
