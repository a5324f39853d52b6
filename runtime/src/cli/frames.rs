//! `sunplay frames`.

use super::args::FramesArgs;
use super::draw::{Picture, draw, explain, kind_of, moment, open_gpu, stage, technique, view};
use super::files::{displayed_visibility, in_words, make_folder, write_animation, write_rgb};
use serde_json::json;
use std::time::Instant;
use sunbake::console::{Failure, ProgressLine, print, print_json, set_threads};
use sunbake::words::counted;
use sunbake_runtime::light::{clock_label, displayed};
use sunbake_runtime::sheet::{contact_sheet, thumbnail};
use sunbake_runtime::{Raster, Shot};

/// Widest picture on the contact sheet, in pixels.
const SHEET_PICTURE_WIDTH: u32 = 400;
/// Widest picture of the animation, in pixels.
const ANIMATION_WIDTH: u32 = 960;
/// How long the animation takes, in milliseconds, and the longest that it stays on one picture.
const ANIMATION_MS: [u32; 2] = [6000, 400];

/// Draws a day.
pub fn run(args: &FramesArgs) -> Result<(), Failure> {
    set_threads(args.look.threads)?;
    let stage = stage(&args.set, &args.sun, &args.objects, &args.look, args.output)?;
    let shot = Shot::new(&stage, view(&stage, &args.look, args.output)?);
    let samples = args.look.samples(args.output);
    let gpu = open_gpu(&args.look, args.printing.quiet)?;
    let mut technique = technique(gpu.as_ref(), &stage, &args.look)?;
    make_folder(&args.output_folder)?;
    let progress = ProgressLine::new(args.printing.quiet);
    progress.begin("drawing the day", u64::from(args.count));
    let start = Instant::now();
    let mut small: Vec<(Raster<[u8; 3]>, String)> = Vec::new();
    let mut moving = Vec::new();
    let mut drawn = Vec::new();
    for i in 0..args.count {
        let t = (f64::from(i) + 0.5) / f64::from(args.count);
        let moment = moment(&stage, &args.look, t)?;
        let picture = match draw(technique.as_mut(), &shot, &moment, args.output)? {
            Picture::Color(light) => displayed(&light, samples),
            Picture::Visibility(seen) => displayed_visibility(&seen, samples),
        };
        let name = format!("frame_{i:04}.png");
        write_rgb(&args.output_folder.join(&name), &picture)?;
        let clock = clock_label(stage.path.as_ref(), t);
        drawn.push(json!({ "file": name, "t": t, "clock": clock }));
        small.push((thumbnail(&picture, SHEET_PICTURE_WIDTH), clock));
        moving.push(thumbnail(&picture, ANIMATION_WIDTH));
        progress.step(1);
    }
    let seconds = start.elapsed().as_secs_f64();
    write_rgb(&args.output_folder.join("contact.png"), &contact_sheet(&small, columns(args.count)))?;
    let delay_ms = (ANIMATION_MS[0] / args.count).clamp(20, ANIMATION_MS[1]) as u16;
    write_animation(&args.output_folder.join("day.png"), &moving, delay_ms)?;
    drop(progress);
    let renderer = gpu.as_ref().map_or("the CPU", |gpu| &gpu.name);
    let last = moment(&stage, &args.look, (f64::from(args.count) - 0.5) / f64::from(args.count))?;
    let effects = technique.draw_plan(&shot, kind_of(&last, args.output));
    if args.printing.explain {
        explain(technique.as_ref(), &effects);
    }
    if args.printing.json {
        let report = json!({
            "folder": args.output_folder, "frames": drawn, "contact": "contact.png", "animation": "day.png",
            "size": args.look.size, "samples_per_pixel": samples * samples, "seconds": seconds,
            "technique": technique.name(), "renderer": renderer,
            "bytes": technique.bytes(), "gpu": technique.census(), "effects": effects.entries(),
            "plan": technique.notes(), "details": technique.details(),
        });
        print_json(&report)?;
    } else if !args.printing.quiet {
        let folder = args.output_folder.display();
        print(&format!(
            "{} in {seconds:.1} s on {renderer}, {}\n  {folder}/contact.png   all of them small\n  \
             {folder}/day.png       an animated PNG\n",
            counted(args.count.into(), "picture"),
            in_words(samples)
        ))?;
    }
    Ok(())
}

/// Columns of a sheet of `count` pictures: somewhat wider than high.
fn columns(count: u32) -> u32 {
    ((f64::from(count) * 1.2).sqrt().round() as u32).max(1)
}
