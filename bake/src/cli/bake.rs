//! `sunbake bake`.

use super::args::{BakeArgs, OutputArgs, Preset};
use super::exit::Failure;
use super::out::{print, print_json, warn};
use super::summary;
use super::terminal::TerminalProgress;
use std::path::Path;
use sunbake::BakeReport;
use sunbake::atlas::Density;
use sunbake::settings::{BakeSettings, SunRequest};
use sunbake::sun::{Date, DayRequest};

/// Where the sun stands if nothing says.
const DEFAULT_PLACE_DEG: [f64; 2] = [40.0, 0.0];
/// The day that is baked if none is given: the northern summer solstice.
const DEFAULT_DATE: [i32; 3] = [2026, 6, 21];

/// Bakes, and tells what came of it.
pub fn run(args: &BakeArgs) -> Result<(), Failure> {
    let settings = settings(args)?;
    let progress = TerminalProgress::new(args.output_manners.quiet);
    let target = match &args.output {
        Some(target) if !args.explain => target,
        _ => return explain(args, &settings, &progress),
    };
    let baked = sunbake::bake(&args.scene, target, args.force, &settings, &progress);
    progress.clear();
    let report = baked.map_err(|error| Failure::of_bake(error, progress.signal_code()))?;
    tell(args, target, &report)
}

fn tell(args: &BakeArgs, target: &Path, report: &BakeReport) -> Result<(), Failure> {
    let OutputArgs { json, quiet, verbose } = args.output_manners;
    let manifest = &report.manifest;
    if !quiet {
        warn(&report.warnings);
    }
    if json {
        return print_json(manifest);
    }
    if quiet {
        return Ok(());
    }
    let mut text = format!("{} -> {}\n{}", args.scene.display(), target.display(), summary::of(manifest));
    if verbose {
        text += &summary::stages(&manifest.stats.seconds);
        text += &summary::effects(&manifest.effects);
    }
    print(&text)
}

/// Reads the scene and says what a bake of it would do.
fn explain(args: &BakeArgs, settings: &BakeSettings, progress: &TerminalProgress) -> Result<(), Failure> {
    let prepared = sunbake::prepare(&args.scene, settings, progress);
    progress.clear();
    let prepared = prepared.map_err(|error| Failure::of_bake(error, progress.signal_code()))?;
    let OutputArgs { json, quiet, .. } = args.output_manners;
    if !quiet {
        warn(&prepared.warnings);
    }
    let entries = prepared.plan.entries();
    match (json, quiet) {
        (true, _) => print_json(&entries),
        (false, true) => Ok(()),
        (false, false) => print(&format!(
            "{}, not baked\n{}{}",
            args.scene.display(),
            summary::request(&prepared, settings),
            summary::effects(&entries)
        )),
    }
}

fn settings(args: &BakeArgs) -> Result<BakeSettings, Failure> {
    let sun = sun(args)?;
    let preset = match args.preset {
        Preset::Draft => BakeSettings::draft(sun),
        Preset::Standard => BakeSettings::standard(sun),
        Preset::Final => BakeSettings::last(sun),
    };
    let cost = &args.cost;
    let engine = cost.engine.unwrap_or(preset.engine);
    if cost.edge_seconds.is_some() && !engine.searches() {
        return Err(Failure::usage(format!(
            "--edge-seconds means nothing to --engine {engine}, whose edges lie between its suns: leave it out, or give \
             --engine bisect:N"
        )));
    }
    let lamp = args.sun.lamp.as_deref().map(|file| path_file(file, "--lamp")).transpose()?;
    Ok(BakeSettings {
        lamp,
        leave_out: args.leave_out.clone(),
        density: cost.texels_per_metre.map_or(preset.density, Density::TexelsPerMetre),
        page_size_texels: cost.size.unwrap_or(preset.page_size_texels),
        padding_texels: cost.padding.unwrap_or(preset.padding_texels),
        bits: cost.bits.unwrap_or(preset.bits),
        layer_cap: cost.layers.map_or(preset.layer_cap, |n| n as usize),
        lane_count: cost.lanes,
        loss_map: args.loss_map,
        engine,
        edge_seconds: cost.edge_seconds.unwrap_or(preset.edge_seconds),
        threads: cost.threads,
        max_memory_bytes: cost.max_memory.unwrap_or(preset.max_memory_bytes),
        ..preset
    })
}

/// The text of a path file that a flag names.
fn path_file(file: &Path, flag: &str) -> Result<String, Failure> {
    std::fs::read_to_string(file)
        .map_err(|e| Failure::io(format!("cannot read the path {}: {e}; check {flag}", file.display())))
}

fn sun(args: &BakeArgs) -> Result<SunRequest, Failure> {
    let given = &args.sun;
    if let Some(file) = &given.path {
        let json = path_file(file, "--path")?;
        return Ok(SunRequest::Keyed { json, north_deg: given.north });
    }
    let [latitude_deg, longitude_deg] = given.place.unwrap_or(DEFAULT_PLACE_DEG);
    let [year, month, day] = DEFAULT_DATE;
    let default_date = Date::new(year, month as u32, day as u32).map_err(|e| Failure::usage(e.to_string()))?;
    let request = DayRequest {
        latitude_deg,
        longitude_deg,
        date: given.date.unwrap_or(default_date),
        utc_offset_h: given.utc_offset,
        north_deg: given.north,
        window: given.window,
    };
    let names_a_day =
        given.place.is_some() || given.date.is_some() || given.window.is_some() || given.utc_offset.is_some();
    Ok(if names_a_day { SunRequest::Day(request) } else { SunRequest::SceneOr(request) })
}
