//! What accuracy costs on a scene and a machine: every setting that trades time or bytes for error, measured.
//!
//! **Two kinds of measurement.** *Whole bakes* (presets, page sizes, lanes) are real calls of [`crate::bake`] into a
//! folder that is removed again. Their error is measured at points of surfaces against the exact answer there
//! (`truth.rs`, `playback.rs`), and includes everything: texels, codes, layers, lanes, filter. *Sweeps at texels*
//! (engines, bits, layers, lanes, rays of sky) change one setting at a time on a sample of the page's texels, in runs
//! of neighbours, because engines are faster on neighbours. Their time is scaled to the whole page. Their error is
//! measured against the best answer for the same texel, so it is that of the setting alone (`sweeps.rs`).
//!
//! **The error of the sun** at a point is the number of minutes of the day at which visibility is wrong, weighted by
//! how much of the disc is wrong: `duration * integral of |V - V_reference| dt`. For hard times that is the symmetric
//! difference of two lists. **The error of the sky** is the difference of ambient visibility.
//!
//! **The budget** is wall-clock time. The most useful runs come first. Each is predicted from earlier ones, and one
//! that would not fit is not started. One that exceeds the budget by more than a tenth is stopped. A bake that would
//! take too long becomes a sparse bake: only the texels that the points read are baked, which gives its error, and its
//! time is predicted (`sparse_bake.rs`). The report lists what was not run, with the prediction. So a small budget
//! gives a short report, not a wrong one.
//!
//! Read on: `schedule.rs` (what is run, and in which order), `workload.rs` (the scene), `metric.rs` (errors),
//! `knee.rs`, `advice.rs` (recommendations), `html.rs` (the page), `report.rs` (the file).

mod advice;
mod budget;
mod cpu_share;
mod error;
mod html;
mod knee;
mod metric;
mod playback;
pub mod report;
mod schedule;
mod settings;
mod sparse_bake;
mod sweeps;
#[cfg(test)]
mod tests;
mod truth;
mod workload;

pub use error::CostError;
pub use html::html;
pub use report::CostReport;
pub use settings::CostSettings;

use crate::progress::Progress;
use crate::report::Machine;
use budget::Budget;
use report::{MeasuredScene, MeasuredSun};
use std::path::Path;
use workload::Workload;

/// Measures what accuracy costs on `scene_file`. Bakes go into `work_folder`, one at a time, and are removed again.
pub fn cost(
    scene_file: &Path,
    settings: &CostSettings,
    work_folder: &Path,
    progress: &dyn Progress,
) -> Result<CostReport, CostError> {
    let budget = Budget::new(settings.budget_s, progress);
    let workload = Workload::new(scene_file, settings, &budget)?;
    let mut schedule = schedule::Schedule::new(&workload, settings, work_folder, &budget)?;
    schedule.run_all()?;
    let (sweeps, reference) = schedule.finish();
    let mut report = CostReport {
        format: report::FORMAT.into(),
        version: report::VERSION,
        generator: concat!("sunbake ", env!("CARGO_PKG_VERSION")).into(),
        scene: MeasuredScene {
            file: workload.scene().source.file_name.clone(),
            sha256: workload.scene().source.sha256.clone(),
            triangles: workload.scene().triangle_count() as u64,
        },
        sun: sun_entry(&workload),
        machine: Machine::here(settings.threads),
        budget_s: settings.budget_s,
        spent_s: budget.spent_s(),
        cores_share: workload.cores_share(),
        reference,
        sweeps,
        advice: Vec::new(),
        warnings: workload.warnings().iter().map(ToString::to_string).collect(),
    };
    report.warnings.extend(busy_machine(&report));
    report.advice = advice::sentences(&report);
    Ok(report)
}

/// Share of the cores' time below which something else must have run.
const BUSY_MACHINE: f64 = 0.85;

/// A warning where other processes used the machine.
fn busy_machine(report: &CostReport) -> Option<String> {
    let share = report.cores_share.filter(|share| *share < BUSY_MACHINE)?;
    Some(format!(
        "this process got {:.0} % of the time of its threads, so something else ran: seconds are longer than on an \
         idle machine, and compare with one another only roughly",
        100.0 * share
    ))
}

fn sun_entry(workload: &Workload) -> MeasuredSun {
    let path = workload.path();
    let local = [0.0, 1.0].map(|t| path.local_text(t));
    let local = match local {
        [Some(start), Some(end)] => Some([start, end]),
        _ => None,
    };
    MeasuredSun { local, duration_min: path.duration_min, angular_radius_deg: path.angular_radius_rad.to_degrees() }
}
