//! `sunplay compare`.

pub mod args;
mod inputs;
mod report_notes;
mod viewpoints;

use super::draw::{open_adapter, set_threads};
use super::exit::Failure;
use super::files::png_bytes;
use super::out::print;
use super::terminal::Terminal;
use args::CompareArgs;
use inputs::ComparisonInputs;
use report_notes::{machine, notes, scene_entry, warnings};
use sunbake::maps::Bits;
use sunbake::progress::Progress;
use sunbake::report::folder;
use sunbake_runtime::compare::report::{FORMAT, LimitEntry, Pictures, Report, VERSION, page};
use sunbake_runtime::compare::{Comparison, Outcome, Pair, TechniqueSpec, selected, sheet};
use viewpoints::Viewpoints;

/// Name of the sheet.
const SHEET: &str = "sheet.png";

/// Compares, and writes the report.
pub fn run(args: &CompareArgs) -> Result<(), Failure> {
    set_threads(args.threads)?;
    let against = reference(args)?;
    let folder = folder::begin(&args.output, args.force, folder::REPORT_JSON)?;
    let gpu = open_adapter(args.renderer, args.quiet)?;
    let terminal = Terminal::new(args.quiet).listening();
    let stopped = |failure: Failure| Failure { code: terminal.signal_code().unwrap_or(failure.code), ..failure };
    let inputs = ComparisonInputs::of(args, against, &terminal).map_err(stopped)?;
    let viewpoints = Viewpoints::of(args, &inputs.stage)?;
    // A CPU's times tell little of a GPU's, however often they are taken.
    let rounds = args.rounds.unwrap_or(if gpu.as_ref().is_some_and(|gpu| !gpu.is_software) { 3 } else { 1 });
    let comparison = Comparison {
        sets: &inputs.sets,
        gpu: gpu.as_ref(),
        techniques: &inputs.techniques,
        against,
        views: &viewpoints.views,
        times: &viewpoints.times,
        map_size_texels: args.map_size,
        rounds,
    };
    let scene = scene_entry(args, &inputs);
    let notes = notes(&inputs);
    terminal.begin("comparing", comparison.frame_count());
    let outcome = comparison.run(inputs.stage, &|| {
        terminal.step(1);
        !terminal.is_cancelled()
    });
    let outcome = outcome.map_err(|error| stopped(error.into()))?;
    terminal.begin("writing the report", 0);
    let limits = args.fail_above.iter().map(|limit| limit.check(&outcome.techniques, &outcome.left_out)).collect();
    let report = Report {
        format: FORMAT.into(),
        version: VERSION,
        generator: concat!("sunplay ", env!("CARGO_PKG_VERSION")).into(),
        scene,
        machine: machine(args, gpu.as_ref()),
        reference: outcome.reference.clone(),
        size: args.size,
        cameras: viewpoints.cameras,
        times: viewpoints.moments,
        rounds,
        techniques: outcome.techniques.clone(),
        left_out: inputs.left_out.into_iter().chain(outcome.left_out.clone()).collect(),
        limits,
        warnings: warnings(gpu.as_ref()),
        notes,
    };
    folder::finish(folder, &files(&report, &outcome)?)?;
    terminal.clear();
    tell(args, &report)
}

/// Whom all are held against.
fn reference(args: &CompareArgs) -> Result<TechniqueSpec, Failure> {
    let all = TechniqueSpec::all(Bits::Sixteen, &[1, 3, 5]);
    let found = selected(&all, std::slice::from_ref(&args.against)).map_err(Failure::usage)?;
    match found.as_slice() {
        [one] => Ok(*one),
        several => {
            let names: Vec<String> = several.iter().map(ToString::to_string).collect();
            Err(Failure::usage(format!(
                "`{}` is several: for --against give one of {}",
                args.against,
                names.join(", ")
            )))
        }
    }
}

/// The files of the report.
fn files(report: &Report, outcome: &Outcome) -> Result<Vec<(&'static str, Vec<u8>)>, Failure> {
    let failed = |error: &dyn std::fmt::Display| Failure::io(format!("cannot make the report: {error}"));
    let json = serde_json::to_vec_pretty(report).map_err(|e| failed(&e))?;
    let pictures = Pictures::new(outcome).map_err(|e| failed(&e))?;
    let html = page(report, &pictures).map_err(|e| failed(&e))?;
    let mut files = vec![(folder::REPORT_JSON, json), (folder::REPORT_HTML, html.into_bytes())];
    if let Some(pair) = Pair::best(&outcome.techniques) {
        let clocks: Vec<String> = report.times.iter().map(|time| time.clock.clone()).collect();
        let picture = sheet(&report.title_lines(pair), outcome, pair, &clocks);
        files.push((SHEET, png_bytes(&picture).map_err(|e| failed(&e))?));
    }
    Ok(files)
}

fn tell(args: &CompareArgs, report: &Report) -> Result<(), Failure> {
    let printed = if args.json {
        let text = serde_json::to_string_pretty(report).map_err(|e| Failure::io(e.to_string()))?;
        print(&(text + "\n"))
    } else if !args.quiet {
        print(&format!("{}{}\n", report.text(), args.output.join(folder::REPORT_HTML).display()))
    } else {
        Ok(())
    };
    // Whether anybody reads it or not, a limit is a limit.
    let passed: Vec<String> = report.limits.iter().filter(|limit| !limit.is_kept()).map(LimitEntry::text).collect();
    if passed.is_empty() { printed } else { Err(Failure::limit(passed.join("; "))) }
}
