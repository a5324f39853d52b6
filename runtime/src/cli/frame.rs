//! `sunplay frame`.

use super::args::FrameArgs;
use super::draw::{Picture, draw, explain, kind_of, moment, open_gpu, stage, technique, view};
use super::files::{in_words, kind, write_color, write_visibility};
use serde_json::json;
use std::time::Instant;
use sunbake::console::{Failure, print, print_json, set_threads};
use sunbake_runtime::Shot;
use sunbake_runtime::light::clock_label;

/// Draws one picture.
pub fn run(args: &FrameArgs) -> Result<(), Failure> {
    kind(&args.output_file)?;
    set_threads(args.look.threads)?;
    let stage = stage(&args.set, &args.sun, &args.objects, &args.look, args.output)?;
    let t = args.at.on(stage.path.as_ref())?;
    let shot = Shot::new(&stage, view(&stage, &args.look, args.output)?);
    let moment = moment(&stage, &args.look, t)?;
    let samples = args.look.samples(args.output);
    let gpu = open_gpu(&args.look, args.printing.quiet)?;
    let mut technique = technique(gpu.as_ref(), &stage, &args.look)?;
    let start = Instant::now();
    match draw(technique.as_mut(), &shot, &moment, args.output)? {
        Picture::Color(light) => write_color(&args.output_file, &light, samples)?,
        Picture::Visibility(seen) => write_visibility(&args.output_file, &seen, samples)?,
    }
    let seconds = start.elapsed().as_secs_f64();
    let renderer = gpu.as_ref().map_or("the CPU", |gpu| &gpu.name);
    let clock = clock_label(stage.path.as_ref(), t);
    let effects = technique.draw_plan(&shot, kind_of(&moment, args.output));
    if args.printing.explain {
        explain(technique.as_ref(), &effects);
    }
    if args.printing.json {
        let report = json!({
            "file": args.output_file, "t": t, "clock": clock, "size": args.look.size,
            "samples_per_pixel": samples * samples, "seconds": seconds,
            "technique": technique.name(), "renderer": renderer, "bytes": technique.bytes(),
            "gpu": technique.census(), "effects": effects.entries(), "plan": technique.notes(),
            "details": technique.details(),
        });
        print_json(&report)?;
    } else if !args.printing.quiet {
        let (set, file) = (args.set.display(), args.output_file.display());
        print(&format!("{set} at {clock} -> {file} ({seconds:.2} s on {renderer}, {})\n", in_words(samples)))?;
    }
    Ok(())
}
