//! `sunplay compare`.

pub mod args;

use super::draw::open_adapter;
use super::files::png_bytes;
use args::CompareArgs;
use sunbake::Warning;
use sunbake::console::{Command, Failure, ProgressLine, print, print_json, set_threads, warn_all};
use sunbake::progress::{BakeStep, Progress};
use sunbake::report::folder;
use sunbake_runtime::compare::report::{LimitEntry, Report};
use sunbake_runtime::compare::{self, CompareProgress, CompareSettings, CompareSource, Compared, TechniqueSpec};

/// Name of the sheet.
const SHEET: &str = "sheet.png";

/// Compares, and writes the report.
pub fn run(args: &CompareArgs) -> Result<(), Failure> {
    set_threads(args.threads)?;
    let settings = settings(args)?;
    let folder = folder::begin(&args.output, args.force, folder::REPORT_JSON)?;
    let gpu = open_adapter(args.renderer, args.quiet)?;
    let progress = ProgressLine::new(args.quiet).listening();
    let listener = Listener { progress: &progress, is_quiet: args.quiet };
    let compared = compare::run(&settings, gpu.as_ref(), &listener)
        .map_err(|error| Failure::from(error).after_signal(progress.signal_code()))?;
    progress.begin("writing the report", 0);
    folder::finish(folder, &files(&compared)?)?;
    progress.clear();
    print_report(args, &compared.report)
}

fn settings(args: &CompareArgs) -> Result<CompareSettings, Failure> {
    let against = TechniqueSpec::named(&args.against).map_err(|error| Failure::usage(format!("--against: {error}")))?;
    check_map_size(args, against)?;
    Ok(CompareSettings {
        source: source(args)?,
        techniques: args.techniques.clone(),
        against,
        cameras: args.camera.clone(),
        times: args.at.clone(),
        size: args.size,
        rounds: args.rounds,
        map_size_texels: args.map_size,
        limits: args.fail_above.clone(),
        threads: args.threads,
    })
}

/// Refuses a size of shadow maps where none is drawn.
fn check_map_size(args: &CompareArgs, against: TechniqueSpec) -> Result<(), Failure> {
    let is_map = |name: &String| name.split(':').next() == Some("map");
    let draws_maps = args.techniques.is_empty() || args.techniques.iter().any(is_map) || against.family() == "map";
    match args.map_size {
        Some(_) if !draws_maps => Err(Failure::usage(
            "--map-size has no effect without shadow maps, and --techniques names none: leave it out, or add map",
        )),
        _ => Ok(()),
    }
}

/// The set or the scene, with the options that are for it.
fn source(args: &CompareArgs) -> Result<CompareSource, Failure> {
    let from = &args.source;
    if !from.exists() {
        return Err(Failure::io(format!("{} is not there: check its name", from.display())));
    }
    if !from.is_dir() {
        if args.scene.is_some() {
            return Err(Failure::usage("--scene is for sets: leave it out"));
        }
        return Ok(CompareSource::Scene {
            file: from.clone(),
            sun: args.sun.request(None)?,
            page_size_texels: args.page_size,
            objects: args.objects.wishes_with(&args.densities),
        });
    }
    if args.sun.is_given() || args.page_size.is_some() || args.objects.is_given() || args.densities.is_given() {
        return Err(Failure::usage(
            "a set has the sun, the texels and the objects that it was baked with: leave --place, --date, \
             --utc-offset, --north, --page-size, --leave-out, --no-cast, --no-receive and --density out, or compare \
             the scene",
        ));
    }
    Ok(CompareSource::Set { folder: from.clone(), scene: args.scene.clone() })
}

/// Shows how far a comparison is.
struct Listener<'a> {
    progress: &'a ProgressLine,
    is_quiet: bool,
}

impl Progress for Listener<'_> {
    fn start(&self, step: BakeStep, total: u64) {
        self.progress.start(step, total);
    }

    fn advance(&self, by: u64) {
        self.progress.advance(by);
    }

    fn is_cancelled(&self) -> bool {
        self.progress.is_cancelled()
    }
}

impl CompareProgress for Listener<'_> {
    fn start_drawing(&self, frame_count: u64) {
        self.progress.begin("comparing", frame_count);
    }

    fn baked(&self, warnings: &[Warning]) {
        if !self.is_quiet {
            self.progress.clear();
            warn_all(warnings, Command::Sunplay);
        }
    }
}

/// The files of the report.
fn files(compared: &Compared) -> Result<Vec<(&'static str, Vec<u8>)>, Failure> {
    let failed = |error: &dyn std::fmt::Display| Failure::io(format!("cannot make the report: {error}"));
    let json = serde_json::to_vec_pretty(&compared.report).map_err(|e| failed(&e))?;
    let html = compared.html().map_err(|e| failed(&e))?;
    let mut files = vec![(folder::REPORT_JSON, json), (folder::REPORT_HTML, html.into_bytes())];
    if let Some(picture) = compared.sheet() {
        files.push((SHEET, png_bytes(&picture).map_err(|e| failed(&e))?));
    }
    Ok(files)
}

fn print_report(args: &CompareArgs, report: &Report) -> Result<(), Failure> {
    let printed = if args.json {
        print_json(report)
    } else if !args.quiet {
        print(&format!("{}{}\n", report.text(), args.output.join(folder::REPORT_HTML).display()))
    } else {
        Ok(())
    };
    // A limit that was passed fails the command even if printing failed.
    let passed: Vec<String> = report.limits.iter().filter(|limit| !limit.is_kept()).map(LimitEntry::text).collect();
    if passed.is_empty() { printed } else { Err(Failure::limit(passed.join("; "))) }
}

#[cfg(test)]
mod tests {
    use super::super::args;
    use super::*;
    use clap::Parser;

    #[test]
    fn a_size_of_maps_is_refused_where_no_map_is_drawn() {
        let is_refused = |options: &str| {
            let command = format!("sunplay compare set -o report --map-size 512 {options}");
            let parsed =
                args::Args::try_parse_from(command.split_whitespace()).unwrap_or_else(|error| panic!("{error}"));
            let args::Command::Compare(args) = parsed.command else { unreachable!() };
            let failure = settings(&args).err().map(|failure| failure.message).unwrap_or_default();
            failure.contains("--map-size has no effect")
        };
        assert!(is_refused("--techniques baked,volumes"));
        assert!(!is_refused("") && !is_refused("--techniques map:pcf4,baked"));
        assert!(!is_refused("--techniques baked --against map:pcss"));
    }
}
