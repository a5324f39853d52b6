//! A set, or a bake that is still to come, in a few lines: what people read. Programs read the manifest.

use glam::DVec3;
use std::fmt::Write;
use sunbake::Prepared;
use sunbake::atlas::Density;
use sunbake::disk::manifest::{
    AmbientEntry, AtlasEntry, EffectEntry, ErrorEntry, LampEntry, LampKeyEntry, LossEntry, Manifest, PathEntry,
    SeamEntry, StepSeconds, TrackStats,
};
use sunbake::settings::BakeSettings;
use sunbake::words::counted;

/// Lines of a label and a value, in two columns.
#[derive(Default)]
struct Lines(String);

impl Lines {
    fn line(&mut self, label: &str, value: impl std::fmt::Display) {
        // Writing to a string does not fail.
        let _ = writeln!(self.0, "  {label:<12}{value}");
    }
}

/// The set: the day, the texels, the losses, the cost.
pub fn of(manifest: &Manifest) -> String {
    let mut lines = Lines::default();
    match (&manifest.path, &manifest.lamp) {
        (Some(path), _) => lines.line("sun", sun(path)),
        (None, None) => lines.line("sun", "it does not rise: no times are stored"),
        (None, Some(_)) => lines.line("sun", "none: no times of it are stored"),
    }
    if let Some(entry) = &manifest.lamp {
        lines.line("lamp", lamp(entry));
    }
    lines.line("scene", scene(manifest));
    lines.line("atlas", atlas(manifest));
    if has_times(manifest) {
        lines.line("times", times(manifest));
        lines.line("rounding", loss(&manifest.error.quantisation_min));
        lines.line("merging", merging(&manifest.error));
        lines.line("engine", engine(manifest));
        if let Some(stats) = &manifest.stats.tracks {
            lines.line("tracks", tracks(stats, manifest.stats.texels));
        }
    }
    if let Some(entry) = &manifest.lamp {
        lines.line("lamp times", lamp_times(manifest, entry));
        lines.line("  rounding", loss(&entry.error.quantisation_min));
        lines.line("  merging", merging(&entry.error));
    }
    if let Some(entry) = &manifest.ambient {
        lines.line("sky", sky(entry, manifest.stats.seconds.ambient));
        lines.line("seams", seams(&entry.seams));
    }
    if let Some(text) = loss_maps(manifest) {
        lines.line("loss map", text);
    }
    lines.line("cost", cost(manifest));
    lines.0
}

/// What a bake was asked for, before it is baked.
pub fn request(prepared: &Prepared, settings: &BakeSettings) -> String {
    let mut lines = Lines::default();
    let sun = prepared.path.as_ref().map(|path| match (path.local_text(0.0), path.local_text(1.0)) {
        (Some(start), Some(end)) => format!("{start} to {end}, {}", counted(path.arcs().len() as u64, "arc")),
        _ => format!("{}, {:.0} minutes", counted(path.arcs().len() as u64, "arc"), path.duration_min),
    });
    let none = if prepared.lamp.is_some() { "none" } else { "it does not rise: no times would be stored" };
    lines.line("sun", sun.unwrap_or(none.into()));
    if let Some(path) = &prepared.lamp {
        let (keys, length_m) = (path.keys().len(), path.segments().map(|s| s.length_m()).sum());
        lines.line("lamp", lamp_text(keys, length_m, path.radius_m(), path.duration_min()));
    }
    let (triangles, instances) = (prepared.scene.triangle_count(), prepared.scene.instances.len());
    lines
        .line("scene", format!("{}, {}", counted(triangles as u64, "triangle"), counted(instances as u64, "instance")));
    let edge = settings.page_size_texels;
    let pages = match settings.density {
        Density::Pages(n) => format!("{} of {edge} x {edge}, as dense as fits", counted(n.into(), "page")),
        Density::TexelsPerMetre(d) => format!("{d} texels/m, on pages of at most {edge} x {edge}"),
    };
    lines.line("atlas", pages);
    if !settings.bakes_intervals {
        return lines.0;
    }
    let layers = counted(settings.layer_cap as u64, "layer");
    let lanes = in_lanes(prepared.plan.lane_count(settings.lane_count));
    lines.line("times", format!("{} bits, at most {layers}{lanes}", settings.bits.count()));
    let edges = || format!(", edges to {} s", settings.edge_seconds);
    let edges = if settings.engine.searches() { edges() } else { String::new() };
    lines.line("engine", format!("{}{edges}", settings.engine));
    lines.0
}

/// The effects, a block each.
pub fn effects(entries: &[EffectEntry]) -> String {
    sunbake::plan::in_words(entries)
}

/// The steps with their seconds, one a line.
pub fn step_seconds(seconds: &StepSeconds) -> String {
    let row = |(name, s): &(&str, f64)| format!("  {name:<12}{s:8.2} s\n");
    by_step(seconds).iter().filter(|(_, s)| *s > 0.0).map(row).collect()
}

fn by_step(seconds: &StepSeconds) -> [(&'static str, f64); 7] {
    let StepSeconds { load, unwrap, bvh, visibility, ambient, encode, write } = *seconds;
    [
        ("load", load),
        ("unwrap", unwrap),
        ("bvh", bvh),
        ("visibility", visibility),
        ("ambient", ambient),
        ("encode", encode),
        ("write", write),
    ]
}

fn sun(path: &PathEntry) -> String {
    let (Some(place), Some([start, end]), Some(offset)) = (&path.place, &path.local, path.utc_offset_h) else {
        return format!("{}, {:.0} minutes", counted(path.arcs.len() as u64, "arc"), path.duration_min);
    };
    let error_deg = path.ephemeris_error_deg.unwrap_or(0.0);
    let (latitude, longitude) = (place.latitude_deg, place.longitude_deg);
    format!(
        "{start} to {end} (UTC{offset:+}) at {latitude},{longitude}; within {error_deg:.4} degrees of the ephemeris"
    )
}

fn lamp(entry: &LampEntry) -> String {
    let apart = |pair: &[LampKeyEntry]| DVec3::from(pair[0].position).distance(pair[1].position.into());
    lamp_text(entry.keys.len(), entry.keys.windows(2).map(apart).sum(), entry.radius_m, entry.duration_min)
}

fn lamp_text(keys: usize, length_m: f64, radius_m: f64, duration_min: f64) -> String {
    format!("{keys} keys, {length_m:.2} m in {duration_min:.0} minutes, a sphere of radius {radius_m} m")
}

fn lamp_times(manifest: &Manifest, entry: &LampEntry) -> String {
    let layers = manifest.atlases.iter().filter_map(|a| a.lamp.as_ref()).map(|l| l.layers.len()).max().unwrap_or(0);
    let stats = &entry.stats;
    let mean = stats.intervals as f64 / (manifest.stats.texels as f64).max(1.0);
    let layers = counted(layers as u64, "layer");
    format!("{layers}; {mean:.2} intervals a texel, {} at most; found by {}", stats.most_intervals, stats.engine)
}

fn tracks(stats: &TrackStats, texels: u64) -> String {
    let share = |count: u64| 100.0 * count as f64 / texels.max(1) as f64;
    format!(
        "{:.0} % of texels have some, {:.1} % too many; {:.1} spans a texel, {:.1} MiB on a GPU, {:.1} s",
        share(stats.texels),
        share(stats.crowded_texels),
        stats.spans as f64 / texels.max(1) as f64,
        stats.gpu_bytes as f64 / f64::from(1 << 20),
        stats.seconds
    )
}

/// Whether times at which the sun is seen are stored.
fn has_times(manifest: &Manifest) -> bool {
    manifest.path.is_some() && manifest.atlases.iter().any(|atlas| !atlas.lanes.is_empty())
}

fn sky(entry: &AmbientEntry, seconds: f64) -> String {
    let millions = entry.rays_traced as f64 / 1e6;
    let rays = match entry.error {
        Some(error) => format!("to {error} by at most {} rays a texel", entry.rays),
        None => format!("{} rays a texel", entry.rays),
    };
    let within = entry.distance_m.map_or(String::new(), |m| format!(", within {m} m"));
    let speed = millions / seconds.max(1e-9);
    let unconverged = match entry.unsettled_texels {
        0 => String::new(),
        count => format!(", {count} not to that error"),
    };
    format!(
        "{rays}{within}; {millions:.1} M rays at {speed:.1} M/s; {} buried{unconverged}",
        counted(entry.buried_texels, "texel")
    )
}

fn seams(entry: &SeamEntry) -> String {
    match entry.points {
        0 => "no surface has any".into(),
        _ => format!(
            "{:.4} apart on average ({:.4} before they were healed), 99 % under {:.4}, worst {:.4}",
            entry.mean, entry.mean_before, entry.p99, entry.worst
        ),
    }
}

fn merging(error: &ErrorEntry) -> String {
    match error.merged_texels {
        0 => "nothing lost".into(),
        merged => format!("{}; {}", loss(&error.merge_min), counted(merged, "texel")),
    }
}

fn scene(manifest: &Manifest) -> String {
    let stats = &manifest.stats;
    let mut text = counted(stats.triangles, "triangle");
    if stats.dropped_triangles > 0 {
        let _ = write!(text, " ({} degenerate left out)", stats.dropped_triangles);
    }
    text + ", " + &counted(manifest.instances.len() as u64, "instance")
}

fn atlas(manifest: &Manifest) -> String {
    let size = |a: &AtlasEntry| format!("{} x {}", a.width, a.height);
    let pages = match &manifest.atlases[..] {
        [] => "no page".into(),
        [page] => format!("1 page of {}", size(page)),
        [first, ..] => format!("{} pages, the first of {}", manifest.atlases.len(), size(first)),
    };
    let (texels, all) = (manifest.stats.texels, manifest.stats.page_texels);
    let filled = 100.0 * texels as f64 / (all as f64).max(1.0);
    format!(
        "{pages}, {} used ({filled:.0} %), {:.3} texels/m",
        counted(texels, "texel"),
        manifest.scene.texels_per_metre
    )
}

/// What several lanes add to a number of layers or intervals.
fn in_lanes(lanes: usize) -> String {
    if lanes > 1 { format!(" in each of {lanes} lanes") } else { String::new() }
}

fn times(manifest: &Manifest) -> String {
    let stats = &manifest.stats;
    let lanes = manifest.atlases.iter().map(|a| a.lanes.len()).max().unwrap_or(0).max(1);
    let layers = manifest.atlases.iter().flat_map(|a| &a.lanes).map(|lane| lane.layers.len()).max().unwrap_or(0);
    let mean = stats.intervals as f64 / (stats.texels as f64 * lanes as f64).max(1.0);
    let layers = counted(layers as u64, "layer") + &in_lanes(lanes);
    let a_texel = if lanes > 1 { "a texel and lane" } else { "a texel" };
    format!("{} bits, {layers}; {mean:.2} intervals {a_texel}, {} at most", manifest.bits, stats.most_intervals)
}

fn loss(loss: &LossEntry) -> String {
    format!("{:.4} min a texel on average, 99 % under {:.4}, worst {:.4}", loss.mean, loss.p99, loss.worst)
}

/// Where the loss maps are, and what their brightest colours stand for.
fn loss_maps(manifest: &Manifest) -> Option<String> {
    let maps = manifest.atlases.iter().filter_map(|atlas| atlas.loss_map.as_ref());
    let texts: Vec<String> =
        maps.map(|map| format!("{} (brightest: {} min)", map.picture, map.scale_max_min)).collect();
    (!texts.is_empty()).then(|| texts.join(", "))
}

fn engine(manifest: &Manifest) -> String {
    let stats = &manifest.stats;
    let seconds = stats.seconds.visibility.max(1e-9);
    let work = if stats.rays > 0 {
        let millions = stats.rays as f64 / 1e6;
        format!("{millions:.1} M rays at {:.1} M/s", millions / seconds)
    } else {
        let a_texel = |count: u64| count as f64 / (stats.texels as f64).max(1.0);
        format!(
            "{:.1} us, {:.0} nodes and {:.0} triangles a texel",
            a_texel((seconds * 1e9) as u64) / 1e3,
            a_texel(stats.node_tests),
            a_texel(stats.triangle_tests)
        )
    };
    format!("{}, {work} on {}", stats.engine, counted(stats.threads as u64, "thread"))
}

fn cost(manifest: &Manifest) -> String {
    let total: f64 = by_step(&manifest.stats.seconds).iter().map(|(_, s)| s).sum();
    let mib = manifest.stats.bytes as f64 / f64::from(1 << 20);
    let seconds = &manifest.stats.seconds;
    format!("{total:.1} s ({:.1} s of it tracing light), {mib:.1} MiB", seconds.visibility + seconds.ambient)
}
