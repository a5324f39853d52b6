//! `sunbake bake`.

use super::args::{BakeArgs, Preset};
use super::exit::Failure;
use super::inspect;
use super::terminal::TerminalProgress;
use sunbake::atlas::Density;
use sunbake::disk::manifest::StageSeconds;
use sunbake::maps::Bits;
use sunbake::progress::{Progress, Silent};
use sunbake::settings::{BakeSettings, SunRequest};
use sunbake::sun::{Date, DayRequest};

/// Where the sun stands if nothing says.
const DEFAULT_PLACE_DEG: [f64; 2] = [40.0, 0.0];
/// The day that is baked if none is given: the northern summer solstice.
const DEFAULT_DATE: [i32; 3] = [2026, 6, 21];

/// Bakes, and tells what came of it.
pub fn run(args: &BakeArgs) -> Result<(), Failure> {
    let settings = settings(args)?;
    let terminal = TerminalProgress::new(args.output_manners.quiet);
    let progress: &dyn Progress = terminal.as_ref().map_or(&Silent, |t| t as &dyn Progress);
    if args.explain {
        return explain(args, &settings, progress);
    }
    let report = sunbake::bake(&args.scene, &args.output, args.force, &settings, progress)?;
    drop(terminal);
    if !args.output_manners.quiet {
        for warning in &report.warnings {
            eprintln!("warning: {warning}");
        }
    }
    if args.output_manners.json {
        print_json(&report.manifest)?;
    } else if !args.output_manners.quiet {
        println!("{} -> {}", args.scene.display(), args.output.display());
        print!("{}", inspect::summary(&report.manifest));
        if args.output_manners.verbose {
            print!("{}", stages(&report.manifest.stats.seconds));
        }
    }
    Ok(())
}

fn explain(args: &BakeArgs, settings: &BakeSettings, progress: &dyn Progress) -> Result<(), Failure> {
    let prepared = sunbake::prepare(&args.scene, settings, progress)?;
    for warning in &prepared.warnings {
        eprintln!("warning: {warning}");
    }
    let entries = prepared.plan.entries();
    match args.output_manners.json {
        true => print_json(&entries)?,
        false => print!("{}", inspect::effects(&entries)),
    }
    Ok(())
}

fn print_json(value: &impl serde::Serialize) -> Result<(), Failure> {
    let text = serde_json::to_string_pretty(value).map_err(|e| Failure::io(e.to_string()))?;
    println!("{text}");
    Ok(())
}

fn settings(args: &BakeArgs) -> Result<BakeSettings, Failure> {
    let sun = sun(args)?;
    let preset = match args.preset {
        Preset::Draft => BakeSettings::draft(sun),
        Preset::Standard => BakeSettings::standard(sun),
        Preset::Final => BakeSettings::last(sun),
    };
    let cost = &args.cost;
    let bits = match cost.bits {
        None => preset.bits,
        Some(count) => Bits::from_count(count).ok_or_else(|| Failure::usage("--bits is 8 or 16, nothing between"))?,
    };
    Ok(BakeSettings {
        density: cost.texels_per_metre.map_or(preset.density, Density::TexelsPerMetre),
        page_size_texels: cost.size.unwrap_or(preset.page_size_texels),
        padding_texels: cost.padding.unwrap_or(preset.padding_texels),
        bits,
        layer_cap: cost.layers.map_or(preset.layer_cap, |n| n as usize),
        engine: cost.engine.unwrap_or(preset.engine),
        threads: cost.threads,
        max_memory_bytes: cost.max_memory.unwrap_or(preset.max_memory_bytes),
        ..preset
    })
}

fn sun(args: &BakeArgs) -> Result<SunRequest, Failure> {
    let given = &args.sun;
    if let Some(file) = &given.path {
        let json = std::fs::read_to_string(file)
            .map_err(|e| Failure::io(format!("cannot read the sun path {}: {e}", file.display())))?;
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
    let names_a_day = given.place.is_some() || given.date.is_some() || given.window.is_some();
    Ok(if names_a_day { SunRequest::Day(request) } else { SunRequest::SceneOr(request) })
}

fn stages(seconds: &StageSeconds) -> String {
    let rows = [
        ("load", seconds.load),
        ("unwrap", seconds.unwrap),
        ("bvh", seconds.bvh),
        ("visibility", seconds.visibility),
        ("encode", seconds.encode),
        ("write", seconds.write),
    ];
    rows.iter().map(|(name, s)| format!("  {name:<12}{s:8.2} s\n")).collect()
}
