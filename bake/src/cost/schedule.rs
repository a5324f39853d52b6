//! What is measured, in which order, and what came of it.
//!
//! Presets first, since they are what most people choose from; then knobs that are cheap to turn; then page sizes and lanes;
//! then knobs that are dear. A bake is predicted from what its stages take a texel, as far as that is known: engine and sky from the
//! knobs' sample, the rest from reading the scene and laying it out, and all of it corrected by how the standard
//! preset turned out, or else the last bake.

use super::budget::Budget;
use super::knee::knee;
use super::metric::{MOMENTS, distribution};
use super::playback;
use super::report::{CostRow, How, ReferenceEntry, Sweep};
use super::sparse_bake::around;
use super::sweeps::{self, Knobs, Turned};
use super::truth::{self, Truth};
use super::workload::Workload;
use super::{CostError, CostSettings};
use crate::disk::manifest::{Manifest, StageSeconds};
use crate::disk::read;
use crate::maps::Bits;
use crate::progress::Progress;
use crate::settings::{BakeSettings, EngineChoice};
use crate::{BakeError, bake};
use std::path::{Path, PathBuf};

/// Points that whole bakes are compared at, at most.
const MOST_POINTS: usize = 4096;
/// At least.
const LEAST_POINTS: usize = 256;
/// Share of the budget that finding out what is true there may take.
const TRUTH_SHARE: f64 = 0.1;
/// Share of the time left that a whole bake may take: sampling it is cheap, and there is more to measure.
const WHOLE_SHARE: f64 = 0.4;
/// How much longer a scattered point takes than one among its neighbours.
const SCATTERED: f64 = 2.0;
/// Seconds that a texel takes besides its engine and its rays: sampling, encoding, writing.
const TEXEL_S: f64 = 3e-6;

/// A measurement.
struct Job {
    sweep: &'static str,
    curve: &'static str,
    name: String,
    kind: Kind,
    /// What comes first: the least.
    rank: u32,
    row: Option<CostRow>,
}

/// What is measured.
#[derive(Clone)]
enum Kind {
    Bake(Box<BakeSettings>),
    Engine(EngineChoice),
    Stored(Bits, usize),
    Lanes(usize),
    Sky(u32),
}

/// All measurements of a scene.
pub(super) struct Jobs<'a> {
    workload: &'a Workload,
    settings: &'a CostSettings,
    work_folder: PathBuf,
    budget: &'a Budget<'a>,
    knobs: Option<Knobs<'a>>,
    truth: Option<Truth>,
    jobs: Vec<Job>,
    /// Bakes that were measured: settings that occur in several sweeps are baked once.
    baked: Vec<(BakeSettings, CostRow)>,
    /// How much longer a texel of the standard preset took than predicted or, before it was baked, one of the last bake.
    correction: f64,
    /// Whether the standard preset has told.
    is_settled: bool,
    /// Seconds that a bake takes before its first texel.
    fixed_s: f64,
}

impl<'a> Jobs<'a> {
    pub fn new(
        workload: &'a Workload,
        settings: &'a CostSettings,
        work_folder: &Path,
        budget: &'a Budget,
    ) -> Result<Self, CostError> {
        let mut jobs = Self {
            workload,
            settings,
            work_folder: work_folder.to_owned(),
            budget,
            knobs: None,
            truth: None,
            jobs: planned(settings),
            baked: Vec::new(),
            correction: 1.2,
            is_settled: false,
            fixed_s: workload.fixed_s,
        };
        jobs.knobs = Knobs::new(workload, budget);
        jobs.check_interrupted()?;
        let Some(knobs) = &jobs.knobs else { return Ok(jobs) };
        let a_point_s =
            SCATTERED * (knobs.exact_texel_s() * truth::LANES as f64 + knobs.sky_ray_s * f64::from(truth::RAYS));
        let affordable = (TRUTH_SHARE * budget.seconds() / a_point_s.max(1e-9)) as usize;
        jobs.truth = Truth::find(workload, affordable.clamp(LEAST_POINTS, MOST_POINTS), budget);
        jobs.check_interrupted()?;
        Ok(jobs)
    }

    fn check_interrupted(&self) -> Result<(), CostError> {
        if self.budget.is_interrupted() { Err(BakeError::Cancelled.into()) } else { Ok(()) }
    }

    /// Runs whatever the budget allows, the most useful first.
    pub fn run_all(&mut self) -> Result<(), CostError> {
        let mut order: Vec<usize> = (0..self.jobs.len()).collect();
        order.sort_by_key(|&index| self.jobs[index].rank);
        for (done, index) in order.into_iter().enumerate() {
            let Job { name, curve, kind, .. } = &self.jobs[index];
            let (name, curve, kind) = (name.clone(), *curve, kind.clone());
            self.budget.task(&format!("{} of {}: {name}", done + 1, self.jobs.len()));
            let row = self.run(&name, curve, &kind)?;
            self.check_interrupted()?;
            self.jobs[index].row = Some(row);
        }
        Ok(())
    }

    fn run(&mut self, name: &str, curve: &str, kind: &Kind) -> Result<CostRow, CostError> {
        let stopped = || CostRow::not_run(name, "stopped: it took longer than predicted, and the budget was spent");
        if let Kind::Bake(settings) = kind {
            if let Some((_, row)) = self.baked.iter().find(|(baked, _)| baked == settings.as_ref()) {
                return Ok(CostRow { name: name.into(), ..row.clone() });
            }
            return Ok(self.bake_or_sample(name, settings)?.unwrap_or_else(stopped));
        }
        let Some(predicted_s) = self.predicted_s(kind) else { return Ok(stopped()) };
        let row = match self.budget.refusal(predicted_s) {
            Some(why) => CostRow::not_run(name, &why),
            None => self.turn(kind).map_or_else(stopped, |turned| measured(name, turned)),
        };
        Ok(CostRow { curve: curve.into(), predicted_s: Some(predicted_s), ..row })
    }

    /// Turns a knob. None if it was stopped.
    fn turn(&mut self, kind: &Kind) -> Option<Turned> {
        let layer_cap = self.settings.preset(BakeSettings::standard).layer_cap;
        let (knobs, budget) = (self.knobs.as_mut()?, self.budget);
        match kind {
            Kind::Bake(_) => None,
            Kind::Engine(choice) => knobs.engine(*choice, layer_cap, budget),
            Kind::Stored(bits, layers) => Some(knobs.stored(*bits, *layers)),
            Kind::Lanes(count) => knobs.lanes(*count, layer_cap, budget),
            Kind::Sky(rays) => knobs.sky(*rays, budget),
        }
    }

    /// A bake, whole if there is time for it, or else of the texels that are read. None if it was stopped.
    fn bake_or_sample(&mut self, name: &str, settings: &BakeSettings) -> Result<Option<CostRow>, CostError> {
        let Some(predicted_s) = self.bake_s(settings) else { return Ok(None) };
        let refusal = self.budget.refusal(predicted_s / WHOLE_SHARE);
        let row = match refusal {
            None => self.bake(settings)?,
            Some(_) => self.sample(settings)?,
        };
        let row = row.map(|row| CostRow { name: name.into(), predicted_s: Some(predicted_s), ..row });
        self.baked.extend(row.iter().filter(|row| row.is_measured()).map(|row| (settings.clone(), row.clone())));
        Ok(row)
    }

    /// Bakes, compares, and removes what was baked.
    fn bake(&mut self, settings: &BakeSettings) -> Result<Option<CostRow>, CostError> {
        let Some(truth) = &self.truth else { return Ok(None) };
        let folder = self.work_folder.join("baked");
        let manifest = match bake(&self.workload.scene_file, &folder, true, settings, self.budget) {
            Ok(report) => report.manifest,
            Err(BakeError::Cancelled) => return Ok(None),
            Err(error @ BakeError::Memory { .. }) => {
                return Ok(Some(CostRow::not_run("", &format!("not run: {error}"))));
            }
            Err(error) => return Err(error.into()),
        };
        let set = read::read(&folder)?;
        let errors = self.workload.on_threads(|| playback::errors(&set, truth, self.workload.scene()));
        // It is removed with the folder around it in any case.
        let _ = std::fs::remove_dir_all(&folder);
        let row = CostRow {
            note: page_note(&manifest, settings),
            seconds: Some(total_s(&manifest.stats.seconds)),
            disk_bytes: Some(manifest.stats.bytes),
            gpu_bytes: Some(set.pages.iter().map(|page| page.gpu_bytes(set.bits)).sum()),
            texels: Some(manifest.stats.texels),
            ..self.with_errors(How::Baked, errors?)
        };
        self.correct(settings, &manifest);
        Ok(Some(row))
    }

    /// Bakes the texels that are read, and predicts the rest.
    fn sample(&mut self, settings: &BakeSettings) -> Result<Option<CostRow>, CostError> {
        let Some((truth, sample_s)) = self.truth.as_ref().zip(self.sample_s(settings)) else { return Ok(None) };
        if let Some(why) = self.budget.refusal(sample_s) {
            return Ok(Some(CostRow::not_run("", &why)));
        }
        let Some(found) = around(self.workload, truth, settings, self.budget)? else { return Ok(None) };
        Ok(Some(CostRow {
            note: Some("texels around the points only; time predicted".into()),
            seconds: self.bake_s_of(settings, found.texels as f64),
            gpu_bytes: Some(found.gpu_bytes),
            texels: Some(found.texels),
            ..self.with_errors(How::Sampled, found.errors)
        }))
    }

    fn with_errors(&self, how: How, errors: playback::Errors) -> CostRow {
        let minutes = errors.sun_t.into_iter().map(|t| t * self.workload.path().duration_min).collect();
        let open = errors.open.and_then(distribution);
        CostRow { how, note: None, sun_min: distribution(minutes), open, ..CostRow::not_run("", "") }
    }

    /// Learns from how long a bake's texels took.
    fn correct(&mut self, settings: &BakeSettings, manifest: &Manifest) {
        let StageSeconds { load, unwrap, bvh, .. } = manifest.stats.seconds;
        let took_s = total_s(&manifest.stats.seconds) - load - unwrap - bvh;
        let is_standard = *settings == self.settings.preset(BakeSettings::standard);
        if let Some(texel_s) = self.texel_s(settings).filter(|_| is_standard || !self.is_settled) {
            self.is_settled |= is_standard;
            let predicted_s = texel_s * manifest.stats.texels as f64;
            self.correction = (took_s / predicted_s.max(1e-9)).clamp(0.2, 5.0);
        }
        self.fixed_s = self.fixed_s.max(load + unwrap + bvh);
    }

    /// Seconds that a measurement may take; unknown where nothing could be measured.
    fn predicted_s(&self, kind: &Kind) -> Option<f64> {
        let knobs = self.knobs.as_ref()?;
        let sun_s = |which: usize| knobs.sun_s[which].unwrap_or(knobs.exact_s / 60.0);
        Some(match kind {
            Kind::Bake(settings) => self.bake_s(settings)?,
            Kind::Engine(EngineChoice::Exact) => 3.0 * knobs.exact_s,
            Kind::Engine(EngineChoice::Rays(count)) => sun_s(0) * *count as f64,
            Kind::Engine(EngineChoice::Bisect(count)) => sun_s(1) * *count as f64,
            Kind::Stored(..) => knobs.exact_s,
            Kind::Lanes(count) => 1.5 * knobs.exact_s * *count as f64 + knobs.disc_ready_s(),
            Kind::Sky(rays) => knobs.sky_s(*rays),
        })
    }

    /// Seconds that a texel of a bake takes, uncorrected.
    fn texel_s(&self, settings: &BakeSettings) -> Option<f64> {
        let knobs = self.knobs.as_ref()?;
        let rays = settings.ambient.map_or(0, |request| request.estimate.rays);
        let lanes = settings.lane_count as f64;
        Some(lanes * (knobs.exact_texel_s() + TEXEL_S) + f64::from(rays) * knobs.sky_ray_s)
    }

    /// Seconds of a bake of so many texels.
    fn bake_s_of(&self, settings: &BakeSettings, texels: f64) -> Option<f64> {
        Some(self.fixed_s + self.correction * texels * self.texel_s(settings)?)
    }

    /// Seconds of a bake.
    fn bake_s(&self, settings: &BakeSettings) -> Option<f64> {
        self.bake_s_of(settings, self.texels(settings))
    }

    /// About how many texels a bake has.
    fn texels(&self, settings: &BakeSettings) -> f64 {
        let page = &self.workload.page;
        let finer = f64::from(settings.page_size_texels) / f64::from(page.edge_texels);
        page.samples.len() as f64 * finer * finer
    }

    /// Seconds until the texels that are read are baked.
    fn sample_s(&self, settings: &BakeSettings) -> Option<f64> {
        let read = 4.0 * self.truth.as_ref()?.places.len() as f64;
        Some(2.0 * self.fixed_s + 1e-6 * self.texels(settings) + SCATTERED * read * self.texel_s(settings)?)
    }

    /// The sweeps with their knees, and what they were measured against.
    pub fn finish(self) -> (Vec<Sweep>, ReferenceEntry) {
        let page = &self.workload.page;
        let reference = ReferenceEntry {
            points: self.truth.as_ref().map_or(0, |truth| truth.places.len() as u64),
            buried_points: self.truth.as_ref().map_or(0, |truth| truth.buried as u64),
            lanes: self.workload.lanes(truth::LANES).0.len() as u64,
            moments: MOMENTS as u64,
            point_rays: truth::RAYS.into(),
            page_size_texels: page.edge_texels,
            page_texels: page.samples.len() as u64,
            measured_texels: self.knobs.as_ref().map_or(0, |knobs| knobs.texel_count() as u64),
            texel_rays: sweeps::RAYS.into(),
        };
        let mut rows = self.jobs;
        let sweeps = SWEEPS.iter().map(|&[id, title, measured_on, meaning]| {
            let of_sweep = rows.extract_if(.., |job| job.sweep == id).filter_map(|job| job.row).collect();
            swept([id, title, measured_on, meaning], of_sweep)
        });
        (sweeps.collect(), reference)
    }
}

const BAKES: &str = "whole bakes";
const TEXELS: &str = "texels";
const SEEN: &str = "minutes of sun told wrongly at a point of a surface, of all that a bake loses";

/// Id, title, what it is measured on, and what error is meant.
const SWEEPS: [[&str; 4]; 8] = [
    ["presets", "Presets", BAKES, SEEN],
    ["sizes", "Texels: standard with other page sizes", BAKES, SEEN],
    ["disc", "Lanes: standard with more of them", BAKES, SEEN],
    ["engines", "Engines", TEXELS, "minutes in which a texel's times differ from its exact ones"],
    [
        "bits",
        "Bits of a stored time",
        TEXELS,
        "minutes in which the stored times of a texel differ from its exact ones",
    ],
    ["layers", "Layers", TEXELS, "minutes in which the stored times of a texel differ from its exact ones"],
    ["lanes", "Lanes, at texels", TEXELS, "minutes of the disc's visibility at a texel, before anything is stored"],
    ["sky", "Rays of sky", TEXELS, "difference of openness at a texel, before anything is stored"],
];

fn swept([id, title, measured_on, meaning]: [&str; 4], rows: Vec<CostRow>) -> Sweep {
    // A knee is one curve's: the first, where a sweep has several.
    let curve: Vec<&CostRow> =
        rows.iter().filter(|row| rows.first().is_some_and(|first| first.curve == row.curve)).collect();
    let pair = |row: &&CostRow| Some((row.seconds?, row.error()?.mean));
    let pairs: Vec<(f64, f64)> = curve.iter().map(|row| pair(row).unwrap_or((f64::NAN, f64::NAN))).collect();
    let knee = if matches!(id, "bits" | "layers") { None } else { knee(&pairs) };
    let knee = knee.map(|index| curve[index].name.clone());
    Sweep { id: id.into(), title: title.into(), measured_on: measured_on.into(), meaning: meaning.into(), rows, knee }
}

/// All measurements, in the order of their tables.
fn planned(settings: &CostSettings) -> Vec<Job> {
    let mut jobs = Vec::new();
    let mut add = |sweep, curve, rank, name: String, kind| jobs.push(Job { sweep, curve, name, kind, rank, row: None });
    let standard = settings.preset(BakeSettings::standard);
    let presets: [(&str, fn(_) -> _, u32); 3] = [
        ("draft", BakeSettings::draft, 0),
        ("standard", BakeSettings::standard, 1),
        ("final", BakeSettings::final_quality, 20),
    ];
    for (name, of, rank) in presets {
        add("presets", "", rank, format!("--preset {name}"), Kind::Bake(Box::new(settings.preset(of))));
    }
    for (page_size_texels, rank) in [(256, 25), (512, 24), (1024, 21), (2048, 20), (4096, 23)] {
        let sized = BakeSettings { page_size_texels, ..standard.clone() };
        add("sizes", "", rank, format!("--size {page_size_texels}"), Kind::Bake(Box::new(sized)));
    }
    for (lane_count, rank) in [(1, 20), (3, 22), (5, 26)] {
        let laned = BakeSettings { lane_count, ..standard.clone() };
        add("disc", "", rank, format!("--lanes {lane_count}"), Kind::Bake(Box::new(laned)));
    }
    for count in (4..=12).map(|bits| 1 << bits) {
        let rank = if count > 512 { 40 } else { 10 };
        add("engines", "rays", rank, format!("rays:{count}"), Kind::Engine(EngineChoice::Rays(count)));
    }
    for count in (4..=8).map(|bits| 1 << bits) {
        add("engines", "bisect", 11, format!("bisect:{count}"), Kind::Engine(EngineChoice::Bisect(count)));
    }
    add("engines", "exact", 9, "exact".into(), Kind::Engine(EngineChoice::Exact));
    for bits in [Bits::Eight, Bits::Sixteen] {
        add("bits", "", 12, format!("--bits {}", bits.count()), Kind::Stored(bits, MOST_LAYERS));
    }
    for layers in [1, 2, 4, 8, MOST_LAYERS] {
        add("layers", "", 13, format!("--layers {layers}"), Kind::Stored(Bits::Sixteen, layers));
    }
    for count in [1, 3, 5] {
        add("lanes", "", 14, format!("--lanes {count}"), Kind::Lanes(count));
    }
    for rays in (2..=12).map(|bits| 1u32 << bits) {
        let rank = if rays > 512 { 41 } else { 15 };
        add("sky", "", rank, format!("--ao-rays {rays}"), Kind::Sky(rays));
    }
    jobs
}

/// As many layers as there are.
const MOST_LAYERS: usize = 16;

fn measured(name: &str, turned: Turned) -> CostRow {
    let Turned { seconds, gpu_bytes, sun_min, open } = turned;
    CostRow {
        how: How::Turned,
        note: None,
        seconds: Some(seconds),
        gpu_bytes: Some(gpu_bytes),
        sun_min,
        open,
        ..CostRow::not_run(name, "")
    }
}

fn total_s(seconds: &StageSeconds) -> f64 {
    let StageSeconds { load, unwrap, bvh, visibility, ambient, encode, write } = *seconds;
    load + unwrap + bvh + visibility + ambient + encode + write
}

/// Where a page had to be larger than asked for.
fn page_note(manifest: &Manifest, settings: &BakeSettings) -> Option<String> {
    let edge = manifest.atlases.iter().map(|atlas| atlas.width.max(atlas.height)).max()?;
    (edge > settings.page_size_texels).then(|| format!("a mesh has too many charts: baked on a page of {edge}"))
}
