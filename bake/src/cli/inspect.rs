//! `sunbake inspect`.

use super::args::InspectArgs;
use super::exit::Failure;
use std::fmt::Write;
use sunbake::disk::manifest::{EffectEntry, Manifest, PathEntry};
use sunbake::disk::read::{read, read_manifest};

/// Prints a set's manifest, whole or in words. The textures are read too, so that a broken set does not pass.
pub fn run(args: &InspectArgs) -> Result<(), Failure> {
    let manifest = match args.json {
        true => read_manifest(&args.set)?,
        false => read(&args.set)?.manifest,
    };
    if args.json {
        let text = serde_json::to_string_pretty(&manifest).map_err(|e| Failure::io(e.to_string()))?;
        println!("{text}");
        return Ok(());
    }
    println!("{}: baked from {} by {}", args.set.display(), manifest.source.file, manifest.generator);
    print!("{}{}", summary(&manifest), effects(&manifest.effects));
    Ok(())
}

/// The set in a few lines: the day, the texels, the bytes, the time, the losses.
pub fn summary(manifest: &Manifest) -> String {
    let stats = &manifest.stats;
    let seconds = &stats.seconds;
    let mut text = String::new();
    // Writing to a string does not fail.
    let mut line = |label: &str, value: String| writeln!(text, "  {label:<12}{value}").unwrap_or(());
    line("sun", manifest.path.as_ref().map_or("does not rise".into(), sun));
    let dropped = match stats.dropped_triangles {
        0 => String::new(),
        n => format!(", {n} degenerate ones left out"),
    };
    line("scene", format!("{} triangles{dropped}, {} instances", stats.triangles, manifest.instances.len()));
    let pages: Vec<_> = manifest.atlases.iter().map(|a| format!("{} x {}", a.width, a.height)).collect();
    let filled = 100.0 * stats.texels as f64 / (stats.page_texels as f64).max(1.0);
    let density = manifest.scene.texels_per_metre;
    line("atlas", format!("{} at {density:.3} texels/m, {filled:.0} % filled", pages.join(", ")));
    let layers = manifest.atlases.iter().flat_map(|a| &a.lanes).map(|lane| lane.layers.len()).max().unwrap_or(0);
    let per_texel = stats.intervals as f64 / (stats.texels as f64).max(1.0);
    let (bits, most) = (manifest.bits, stats.most_intervals);
    line("times", format!("{bits} bits, {layers} layer(s); {per_texel:.2} intervals a texel, {most} at most"));
    let [round, merge] = [&manifest.error.quantisation_min, &manifest.error.merge_min];
    line("rounding", format!("{:.4} min a texel, 99 % under {:.4}, worst {:.4}", round.mean, round.p99, round.worst));
    line(
        "merging",
        format!("{:.4} min a texel, worst {:.2}, {} texels", merge.mean, merge.worst, manifest.error.merged_texels),
    );
    let total = seconds.load
        + seconds.unwrap
        + seconds.bvh
        + seconds.visibility
        + seconds.ambient
        + seconds.encode
        + seconds.write;
    let rate = stats.rays as f64 / seconds.visibility.max(1e-9) / 1e6;
    let threads = stats.threads;
    line(
        "engine",
        format!("{}, {:.1} M rays at {rate:.1} M/s on {threads} thread(s)", stats.engine, stats.rays as f64 / 1e6),
    );
    line(
        "cost",
        format!(
            "{total:.1} s ({:.1} of them sun), {:.1} MiB",
            seconds.visibility,
            stats.bytes as f64 / f64::from(1 << 20)
        ),
    );
    text
}

/// The effects, one a line.
pub fn effects(entries: &[EffectEntry]) -> String {
    let row = |e: &EffectEntry| format!("  {:<4}{:<20}{}\n", if e.on { "on" } else { "off" }, e.effect, e.why);
    entries.iter().map(row).collect()
}

fn sun(path: &PathEntry) -> String {
    match (&path.place, &path.local, path.utc_offset_h) {
        (Some(place), Some([start, end]), Some(offset)) => format!(
            "{start} to {end} (UTC{offset:+}) at {}, {}; within {:.4} degrees of the ephemeris",
            place.latitude_deg,
            place.longitude_deg,
            path.ephemeris_error_deg.unwrap_or(0.0)
        ),
        _ => format!("{} arc(s), {:.0} minutes", path.arcs.len(), path.duration_min),
    }
}
