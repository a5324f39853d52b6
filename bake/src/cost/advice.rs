//! Recommendations in sentences. Every number in them is in the report. What was not measured is either named as such
//! or left out.

use super::report::{CostReport, CostRow, ErrorSummary, How, Sweep};
use crate::report::{plain, with_unit};

/// Relative change of error below which a setting is said to change next to nothing.
const NEGLIGIBLE: f64 = 0.02;

/// All sentences that the measurements allow.
pub(super) fn sentences(report: &CostReport) -> Vec<String> {
    let sentences = [
        standard(report),
        presets(report),
        filters(report),
        density(report),
        lanes(report),
        error_sources(report),
        engines(report),
        sky(report),
    ];
    sentences.into_iter().flatten().collect()
}

/// What the standard preset gives.
fn standard(report: &CostReport) -> Option<String> {
    let row = report.sweep("presets")?.measured("--preset standard")?;
    let error = row.sun_min.as_ref()?;
    let ambient = row
        .ambient
        .as_ref()
        .map_or(String::new(), |error| format!("; ambient occlusion is within {} on average", plain(error.mean, 2)));
    let takes = if row.how == How::Baked { "It takes" } else { "It would take about" };
    Some(format!(
        "`--preset standard` is within {} minutes of sun a point on average, 99 in 100 within {}{ambient}. \
         {takes} {} here, and {} on the GPU.",
        plain(error.mean, 2),
        plain(error.p99, 2),
        with_unit(row.seconds?, "s"),
        with_unit(row.gpu_bytes? as f64, "bytes"),
    ))
}

/// What the other presets give, or why that is not known.
fn presets(report: &CostReport) -> Option<String> {
    let sweep = report.sweep("presets")?;
    let from = sweep.measured("--preset standard")?;
    let sentence = |name: &str| {
        let row = sweep.rows.iter().find(|row| row.name == name)?;
        let why = || row.note.as_ref().map(|note| format!("`{name}` was {note}."));
        if row.is_measured() { against(sweep, name, from) } else { why() }
    };
    let sentences: Vec<String> = ["--preset draft", "--preset final"].into_iter().filter_map(sentence).collect();
    (!sentences.is_empty()).then(|| sentences.join(" "))
}

/// What other filters gain, and tracks.
fn filters(report: &CostReport) -> Option<String> {
    let sweep = report.sweep("filters")?;
    let from = sweep.measured("--filter bilinear")?;
    let same_set = |name: &str| {
        let row = sweep.measured(name)?;
        Some(format!("`{name}` draws the same set and {}.", change(from.sun_min.as_ref()?, row.sun_min.as_ref()?)))
    };
    let tracks = sweep.rows.iter().find(|row| row.name == "--tracks").and_then(|row| match row.is_measured() {
        true => against(sweep, "--tracks", from),
        false => row.note.as_ref().map(|note| format!("`--tracks`: {note}.")),
    });
    let sentences: Vec<String> = [same_set("--filter sharp"), tracks].into_iter().flatten().collect();
    (!sentences.is_empty()).then(|| sentences.join(" "))
}

/// What more texels gain, and fewer save.
fn density(report: &CostReport) -> Option<String> {
    let sweep = report.sweep("sizes")?;
    let standard = report.sweep("presets")?.measured("--preset standard")?;
    let is_standard =
        |row: &&CostRow| row.is_measured() && row.texels == standard.texels && row.seconds == standard.seconds;
    let from = sweep.rows.iter().find(is_standard)?;
    let place = sweep.rows.iter().position(|row| row.name == from.name)?;
    let finer = sweep.rows.get(place + 1).and_then(|row| against(sweep, &row.name, from));
    let coarser = place.checked_sub(1).and_then(|k| against(sweep, &sweep.rows[k].name, from));
    let knee = sweep.knee.as_ref().map(|name| format!("The knee of the curve lies at `{name}`."));
    let sentences: Vec<String> = [finer, coarser, knee].into_iter().flatten().collect();
    (!sentences.is_empty()).then(|| sentences.join(" "))
}

/// What more lanes gain.
fn lanes(report: &CostReport) -> Option<String> {
    let sweep = report.sweep("disc")?;
    let from = sweep.measured("--lanes 1")?;
    let sentences: Vec<String> =
        ["--lanes 3", "--lanes 5"].iter().filter_map(|name| against(sweep, name, from)).collect();
    (!sentences.is_empty()).then(|| sentences.join(" "))
}

/// Where the standard preset's error comes from.
fn error_sources(report: &CostReport) -> Option<String> {
    let all = report.sweep("presets")?.measured("--preset standard")?.sun_min?.mean;
    let of = |sweep: &str, name: &str| Some(report.sweep(sweep)?.measured(name)?.sun_min?.mean);
    let layers = of("layers", "--layers 4")?;
    let lane = of("lanes", "--lanes 1")?;
    let bits = of("bits", "--bits 16")?;
    let rest = match layers + lane {
        known if known < 0.5 * all => {
            "most of it comes from texels that are larger than the details they show, so more of them (`--size`, \
             `--texels-per-metre`) help most"
        }
        _ if layers > lane && layers > 2.0 * bits => "more layers (`--layers`) help most",
        _ if layers > lane => "little is left to gain",
        _ => "more lanes (`--lanes`) help most",
    };
    Some(format!(
        "`--preset standard` is off by {} minutes; at single texels, four layers of 16 bits are off by {} (rounding \
         alone by {}), and taking the sun as a line by {}, part of which filtering evens out: {rest}.",
        plain(all, 2),
        plain(layers, 2),
        plain(bits, 2),
        plain(lane, 2),
    ))
}

/// What the exact engine is worth.
fn engines(report: &CostReport) -> Option<String> {
    let sweep = report.sweep("engines")?;
    let exact_s = sweep.measured("exact")?.seconds?;
    let rays = sweep.rows.iter().filter(|row| row.curve == "rays" && row.is_measured());
    let ratio = |row: &CostRow| row.seconds.map_or(f64::INFINITY, |seconds| (seconds / exact_s).ln().abs());
    let alike = rays.min_by(|a, b| ratio(a).total_cmp(&ratio(b)))?;
    let error = alike.sun_min.as_ref()?;
    Some(format!(
        "`--engine exact` takes {}; the nearest in time, `{}` ({}), is wrong by {} minutes a texel on \
         average, by {} at worst.{}",
        with_unit(exact_s, "s"),
        alike.name,
        with_unit(alike.seconds?, "s"),
        plain(error.mean, 2),
        plain(error.worst, 2),
        cheap_bisection(sweep, exact_s).unwrap_or_default()
    ))
}

/// The bisection with the least error among those that are faster than the exact engine, if there is one.
fn cheap_bisection(sweep: &Sweep, exact_s: f64) -> Option<String> {
    let faster = |row: &&CostRow| row.curve == "bisect" && row.seconds.is_some_and(|seconds| seconds < 0.9 * exact_s);
    let mean = |row: &CostRow| row.sun_min.map_or(f64::INFINITY, |error| error.mean);
    let best = sweep.rows.iter().filter(faster).min_by(|a, b| mean(a).total_cmp(&mean(b)))?;
    let (seconds, error) = (best.seconds?, best.sun_min?);
    Some(format!(
        " `{}` takes {} of its time and is wrong by {} minutes.",
        best.name,
        percent(seconds / exact_s),
        plain(error.mean, 2)
    ))
}

/// What more rays of sky gain.
fn sky(report: &CostReport) -> Option<String> {
    let sweep = report.sweep("sky")?;
    let sentence = |rays: u32| {
        let row = sweep.measured(&format!("--ao-rays {rays}"))?;
        let error = row.ambient.as_ref()?;
        Some(format!(
            "{rays} rays are off by {} (99 in 100 by less than {}) in {}",
            plain(error.mean, 2),
            plain(error.p99, 2),
            with_unit(row.seconds?, "s")
        ))
    };
    let sentences: Vec<String> = [64, 128, 512].into_iter().filter_map(sentence).collect();
    (!sentences.is_empty()).then(|| format!("Ambient occlusion, all texels of the page: {}.", sentences.join("; ")))
}

/// A row compared with another of its sweep, if it was measured.
fn against(sweep: &Sweep, name: &str, from: &CostRow) -> Option<String> {
    let row = sweep.measured(name)?;
    let times = row.seconds? / from.seconds?;
    let bytes = row.gpu_bytes? as f64 / from.gpu_bytes? as f64;
    let sun = change(from.sun_min.as_ref()?, row.sun_min.as_ref()?);
    let is_predicted = [row, from].iter().any(|row| row.how == How::Sampled);
    let takes = if is_predicted { "should take" } else { "takes" };
    Some(format!(
        "`{name}` {takes} {} the time and {} the bytes of `{}` and {sun}.",
        factor(times),
        factor(bytes),
        from.name
    ))
}

/// How an error changes, in minutes.
fn change(from: &ErrorSummary, to: &ErrorSummary) -> String {
    let by = from.mean - to.mean;
    let mean = plain(to.mean, 2);
    match by {
        _ if by.abs() < NEGLIGIBLE * from.mean => format!("changes next to nothing ({mean} minutes)"),
        _ if by > 0.0 => format!("gains {} minutes (down to {mean})", plain(by, 2)),
        _ => format!("loses {} minutes (up to {mean})", plain(-by, 2)),
    }
}

/// `3.9 times`, or of what is less `26 % of`.
fn factor(ratio: f64) -> String {
    if ratio >= 1.0 { format!("{} times", plain(ratio, 2)) } else { format!("{} of", percent(ratio)) }
}

fn percent(share: f64) -> String {
    format!("{} %", plain(100.0 * share, 2))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error(mean: f64) -> ErrorSummary {
        ErrorSummary { mean, rms: mean, p99: 9.0, worst: 20.0 }
    }

    #[test]
    fn a_change_is_worded_by_its_sign() {
        assert_eq!(change(&error(0.5), &error(0.4)), "gains 0.10 minutes (down to 0.40)");
        assert_eq!(change(&error(0.5), &error(0.75)), "loses 0.25 minutes (up to 0.75)");
        assert_eq!(change(&error(0.5), &error(0.501)), "changes next to nothing (0.50 minutes)");
        assert_eq!([factor(3.92), factor(0.25)], ["3.9 times", "25 % of"]);
    }

    #[test]
    fn what_was_not_run_is_not_mentioned() {
        let row = |name: &str, seconds: f64, mean: f64| CostRow {
            how: How::Baked,
            note: None,
            seconds: Some(seconds),
            gpu_bytes: Some(100),
            sun_min: Some(error(mean)),
            ..CostRow::not_run(name, "")
        };
        let rows = vec![row("a", 10.0, 1.0), row("b", 20.0, 0.5), CostRow::not_run("c", "not run: too long")];
        let text = String::new;
        let sweep = Sweep { id: text(), title: text(), measured_on: text(), meaning: text(), knee: None, rows };
        let from = &sweep.rows[0];
        assert_eq!(against(&sweep, "c", from), None);
        let sentence = against(&sweep, "b", from).unwrap();
        assert_eq!(
            sentence,
            "`b` takes 2.0 times the time and 1.0 times the bytes of `a` and gains 0.50 minutes (down to 0.50)."
        );
        assert_eq!(against(&sweep, "d", from), None);
    }
}
