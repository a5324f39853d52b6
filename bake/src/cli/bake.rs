//! `sunbake bake`.

use super::args::{AmbientArgs, BakeArgs, Only, OutputArgs, PathArgs, Preset};
use super::summary;
use std::path::Path;
use sunbake::atlas::Density;
use sunbake::console::{Command, Failure, ProgressLine, print, print_json, warn_all};
use sunbake::lamp::is_lamp;
use sunbake::settings::{AmbientRequest, BakeSettings, SunRequest, TrackChoice};
use sunbake::sun::KeyedError;
use sunbake::{BakeError, BakeReport};

/// Bakes, and tells what came of it.
pub fn run(args: &BakeArgs) -> Result<(), Failure> {
    let settings = settings(args)?;
    let progress = ProgressLine::new(args.printing.quiet).listening().telling(Command::Sunbake);
    let target = match &args.output {
        Some(target) if !args.explain => target,
        _ => return explain(args, &settings, &progress),
    };
    let baked = sunbake::bake(&args.scene, target, args.force, &settings, &progress);
    progress.clear();
    let report = baked.map_err(|error| failure(error, args).after_signal(progress.signal_code()))?;
    tell(args, target, &report, &progress)
}

fn tell(args: &BakeArgs, target: &Path, report: &BakeReport, progress: &ProgressLine) -> Result<(), Failure> {
    let OutputArgs { json, quiet, verbose } = args.printing;
    let manifest = &report.manifest;
    if !quiet {
        warn_all(&progress.not_told(&report.warnings), Command::Sunbake);
    }
    if json {
        return print_json(manifest);
    }
    if quiet {
        return Ok(());
    }
    let mut text = format!("{} -> {}\n{}", args.scene.display(), target.display(), summary::of(manifest));
    if verbose {
        text += &summary::step_seconds(&manifest.stats.seconds);
        text += &summary::effects(&manifest.effects);
    }
    print(&text)
}

/// Reads the scene and says what a bake of it would do.
fn explain(args: &BakeArgs, settings: &BakeSettings, progress: &ProgressLine) -> Result<(), Failure> {
    let prepared = sunbake::prepare(&args.scene, settings, progress);
    progress.clear();
    let prepared = prepared.map_err(|error| failure(error, args).after_signal(progress.signal_code()))?;
    let OutputArgs { json, quiet, .. } = args.printing;
    if !quiet {
        warn_all(&prepared.warnings, Command::Sunbake);
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
    let sun = sun(&args.sun)?;
    let preset = match args.preset {
        Preset::Draft => BakeSettings::draft(sun.clone()),
        Preset::Standard => BakeSettings::standard(sun.clone()),
        Preset::Final => BakeSettings::final_quality(sun.clone()),
    };
    let cost = &args.cost;
    let engine = cost.engine.unwrap_or(preset.engine);
    if cost.edge_seconds.is_some() && !engine.searches() {
        return Err(Failure::usage(format!(
            "--edge-seconds has no effect with --engine {engine}: leave it out, or give --engine bisect:N"
        )));
    }
    let bakes_intervals = args.only.is_empty() || args.only.contains(&Only::Intervals);
    if let Some(flag) = times_flag(args).filter(|_| !bakes_intervals) {
        return Err(Failure::usage(format!("{flag} is about times and --only asks for none: add intervals to --only")));
    }
    let lamp = args.lamp.lamp.as_deref().map(|file| path_file(file, "--lamp")).transpose()?;
    if matches!(&sun, SunRequest::Keyed { json, .. } if is_lamp(json)) {
        check_lamp_alone(args, bakes_intervals)?;
    }
    Ok(BakeSettings {
        lamp,
        objects: args.objects.wishes_with(&args.densities),
        density: cost.texels_per_metre.map_or(preset.density, Density::TexelsPerMetre),
        page_size_texels: cost.size.unwrap_or(preset.page_size_texels),
        padding_texels: cost.padding.unwrap_or(preset.padding_texels),
        bits: cost.bits.unwrap_or(preset.bits),
        layer_cap: cost.layers.map_or(preset.layer_cap, |n| n as usize),
        lane_count: cost.lanes,
        tracks: cost.tracks.unwrap_or(preset.tracks),
        smooth_terminator: !args.flat_terminator,
        bakes_intervals,
        ambient: ambient(args, preset.ambient)?,
        loss_map: args.loss_map,
        engine,
        edge_seconds: cost.edge_seconds.unwrap_or(preset.edge_seconds),
        threads: cost.threads,
        max_memory_bytes: cost.max_memory.unwrap_or(preset.max_memory_bytes),
        ..preset
    })
}

fn finds_tracks(args: &BakeArgs) -> bool {
    args.cost.tracks.is_some_and(|choice| choice != TrackChoice::Off)
}

/// Refuses what is about a sun where the path is a lamp's.
fn check_lamp_alone(args: &BakeArgs, bakes_intervals: bool) -> Result<(), Failure> {
    let of_sun =
        [(args.cost.lanes > 1, "--lanes"), (finds_tracks(args), "--tracks"), (args.sun.day.north.is_some(), "--north")];
    if let Some((_, option)) = of_sun.into_iter().find(|(is_given, _)| *is_given) {
        return Err(Failure::usage(format!(
            "{option} is about the sun, and --path is of a lamp that is baked instead: leave {option} out, or give the \
             lamp with --lamp"
        )));
    }
    if !bakes_intervals {
        return Err(Failure::usage(
            "--path is of a lamp and --only asks for no times: add intervals to --only, or leave --path out",
        ));
    }
    Ok(())
}

/// Most rays of a texel that has an error to keep, unless told otherwise.
const MOST_RAYS: u32 = 4096;

fn ambient(args: &BakeArgs, preset: Option<AmbientRequest>) -> Result<Option<AmbientRequest>, Failure> {
    let given = &args.ambient;
    let is_wanted = args.only.is_empty() || args.only.contains(&Only::Ao);
    let Some(mut request) = preset.filter(|_| is_wanted) else {
        return match flag_given(given) {
            Some(flag) => {
                Err(Failure::usage(format!("{flag} asks for ambient light and --only for none: add ao to --only")))
            }
            None => Ok(None),
        };
    };
    let estimate = &mut request.estimate;
    let usual = if given.ao_error.is_some() { MOST_RAYS } else { estimate.rays };
    estimate.rays = given.ao_rays.unwrap_or(usual);
    estimate.distance_m = given.ao_distance;
    estimate.error = given.ao_error;
    estimate.wants_bent = given.bent;
    estimate.wants_sky = given.sky.is_some();
    request.supersample = given.ao_supersample;
    request.bits = given.ao_bits.unwrap_or(request.bits);
    request.vertices = given.ao_vertices;
    request.exr = given.exr;
    Ok(Some(request))
}

/// A flag about times, if one is given.
fn times_flag(args: &BakeArgs) -> Option<&'static str> {
    let cost = &args.cost;
    let flags = [
        ("--lamp", args.lamp.lamp.is_some()),
        ("--bits", cost.bits.is_some()),
        ("--layers", cost.layers.is_some()),
        ("--lanes", cost.lanes > 1),
        ("--tracks", finds_tracks(args)),
        ("--engine", cost.engine.is_some()),
        ("--edge-seconds", cost.edge_seconds.is_some()),
        ("--flat-terminator", args.flat_terminator),
        ("--loss-map", args.loss_map),
    ];
    flags.into_iter().find(|(_, is_given)| *is_given).map(|(flag, _)| flag)
}

/// A flag about ambient light, if one is given.
fn flag_given(given: &AmbientArgs) -> Option<&'static str> {
    let flags = [
        ("--ao-rays", given.ao_rays.is_some()),
        ("--ao-distance", given.ao_distance.is_some()),
        ("--ao-error", given.ao_error.is_some()),
        ("--ao-supersample", given.ao_supersample > 1),
        ("--ao-bits", given.ao_bits.is_some()),
        ("--bent", given.bent),
        ("--sky", given.sky.is_some()),
        ("--ao-vertices", given.ao_vertices.is_some()),
        ("--exr", given.exr),
    ];
    flags.into_iter().find(|(_, is_given)| *is_given).map(|(flag, _)| flag)
}

/// The text of a path file that a flag names.
fn path_file(file: &Path, flag: &str) -> Result<String, Failure> {
    std::fs::read_to_string(file)
        .map_err(|e| Failure::io(format!("cannot read the path {}: {e}; check {flag}", file.display())))
}

fn failure(error: BakeError, args: &BakeArgs) -> Failure {
    let file = path_file_of(&error, &args.sun, args.lamp.lamp.as_deref());
    in_file(error.into(), file)
}

/// The file of a path that an error is about.
pub(super) fn path_file_of<'a>(error: &BakeError, given: &'a PathArgs, lamp: Option<&'a Path>) -> Option<&'a Path> {
    match error {
        // Where both have a lamp, neither is read.
        BakeError::LampFile(_) | BakeError::Lamp(_) => lamp.or(given.path.as_deref()),
        BakeError::Keyed(KeyedError::North(_)) => None,
        BakeError::Keyed(_) => given.path.as_deref(),
        _ => None,
    }
}

/// A failure with the file that it is about, if there is one, before its text.
pub(super) fn in_file(failure: Failure, file: Option<&Path>) -> Failure {
    match file {
        Some(file) => Failure { message: format!("{}: {}", file.display(), failure.message), ..failure },
        None => failure,
    }
}

/// The sun that options ask for.
pub(super) fn sun(given: &PathArgs) -> Result<SunRequest, Failure> {
    match &given.path {
        Some(file) => Ok(SunRequest::Keyed { json: path_file(file, "--path")?, north_deg: given.day.north_deg() }),
        None => given.day.request(given.window),
    }
}
