//! A comparison from settings to report.

use super::inputs::ComparisonInputs;
use super::report::{FORMAT, GENERATOR, PageError, Pictures, Report, VERSION, page};
use super::report_notes::{machine, notes, scene_entry, warnings};
use super::viewpoints::Viewpoints;
use super::{BestPair, CompareError, CompareProgress, CompareSettings, Comparison, Outcome, sheet};
use crate::gpu::Gpu;
use crate::image::Raster;

/// How often each frame is drawn, unless told: a software GPU's times say little of a real one's, however often they
/// are taken.
const ROUNDS: u32 = 3;
const ROUNDS_ON_CPU: u32 = 1;

/// What a comparison found.
pub struct Compared {
    /// The numbers, as they are written to `report.json`.
    pub report: Report,
    /// The pictures that the numbers are of.
    pub outcome: Outcome,
}

/// Compares techniques, as `settings` say. Without a GPU the CPU draws what it can, and the report names the rest as
/// left out.
pub fn run(
    settings: &CompareSettings,
    gpu: Option<&Gpu>,
    progress: &dyn CompareProgress,
) -> Result<Compared, CompareError> {
    let inputs = ComparisonInputs::of(settings, progress)?;
    let viewpoints = Viewpoints::of(settings, &inputs.stage)?;
    let is_real = gpu.is_some_and(|gpu| !gpu.is_software);
    let rounds = settings.rounds.unwrap_or(if is_real { ROUNDS } else { ROUNDS_ON_CPU });
    let comparison = Comparison {
        sets: &inputs.sets,
        gpu,
        techniques: &inputs.techniques,
        against: settings.against,
        views: &viewpoints.views,
        times: &viewpoints.times,
        map_size_texels: settings.map_size_texels,
        rounds,
    };
    let (scene, notes) = (scene_entry(&inputs), notes(&inputs));
    progress.start_drawing(comparison.frame_count());
    let outcome = comparison.run(inputs.stage, &|| {
        progress.advance(1);
        !progress.is_cancelled()
    })?;
    let limits = settings.limits.iter().map(|limit| limit.check(&outcome.techniques, &outcome.left_out)).collect();
    let report = Report {
        format: FORMAT.into(),
        version: VERSION,
        generator: GENERATOR.into(),
        scene,
        machine: machine(settings.threads, gpu),
        reference: outcome.reference.clone(),
        size: settings.size,
        cameras: viewpoints.camera_entries,
        times: viewpoints.time_entries,
        rounds,
        techniques: outcome.techniques.clone(),
        left_out: inputs.left_out.into_iter().chain(outcome.left_out.clone()).collect(),
        limits,
        warnings: warnings(gpu),
        notes,
    };
    Ok(Compared { report, outcome })
}

impl Compared {
    /// The report as one page of HTML that needs no network.
    pub fn html(&self) -> Result<String, PageError> {
        Ok(page(&self.report, &Pictures::new(&self.outcome)?)?)
    }

    /// The best baked and the best live technique side by side, as sRGB codes. None where nothing baked was drawn.
    pub fn sheet(&self) -> Option<Raster<[u8; 3]>> {
        let pair = BestPair::of(&self.outcome.techniques)?;
        let clocks: Vec<String> = self.report.times.iter().map(|time| time.clock.clone()).collect();
        Some(sheet(&self.report.title_lines(pair), &self.outcome, pair, &clocks))
    }
}
