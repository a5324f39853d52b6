//! The measurements, their order, and their results.
//!
//! Presets come first, since most people choose among them; then cheap sweeps at texels; then page sizes and lanes;
//! then expensive sweeps. The time of a bake is predicted from the time per texel of its steps: engine and sky from
//! the sweeps' sample, the rest from reading the scene and laying it out. The prediction is corrected by the measured
//! time of the standard preset or, before that is known, of the last bake.

use super::budget::Budget;
use super::error::CostError;
use super::knee::knee;
use super::metric::{MOMENTS, summary};
use super::playback::{self, Filter};
use super::report::{CostReference, CostRow, How, Sweep};
use super::settings::CostSettings;
use super::sparse_bake::sparse_bake;
use super::sweeps::{self, SweepPoint, TexelSweeps};
use super::truth::{self, GroundTruth};
use super::workload::Workload;
use crate::disk::manifest::{Manifest, StepSeconds};
use crate::disk::read;
use crate::maps::{Bits, PageMaps};
use crate::progress::Progress;
use crate::settings::{BakeSettings, EngineChoice, TrackChoice};
use crate::{BakeError, bake};
use std::path::{Path, PathBuf};

/// Most points at which whole bakes are compared.
const MOST_POINTS: usize = 4096;
/// Fewest points at which whole bakes are compared.
const LEAST_POINTS: usize = 256;
/// Share of the budget that finding the exact answers there may take.
const TRUTH_SHARE: f64 = 0.1;
/// Share of the time left that a whole bake may take: a sparse bake is cheap, and there is more to measure.
const WHOLE_SHARE: f64 = 0.4;
/// How many times as long a scattered point takes as one among its neighbours.
const SCATTERED: f64 = 2.0;
/// Time of finding tracks, over that of a lane.
const TRACKS: f64 = 0.5;
/// Seconds of a texel besides its engine and its rays: sampling, encoding, writing.
const TEXEL_S: f64 = 3e-6;

/// A measurement and its result.
struct Job {
    sweep: &'static str,
    curve: &'static str,
    name: String,
    measurement: Measurement,
    /// Jobs are run in the order of their ranks.
    rank: u32,
    row: Option<CostRow>,
}

/// What a job measures: a whole bake, or one setting at texels.
#[derive(Clone)]
enum Measurement {
    Bake(Box<BakeSettings>, Filter),
    Engine(EngineChoice),
    Stored(Bits, usize),
    Lanes(usize),
    Sky(u32),
}

/// What one bake shows by each filter that it allows.
type FilteredRows = Vec<(Filter, CostRow)>;

/// All measurements of a scene, and what predicts their times.
pub(super) struct Schedule<'a> {
    workload: &'a Workload,
    settings: &'a CostSettings,
    work_folder: PathBuf,
    budget: &'a Budget<'a>,
    /// None until the sample is measured.
    sweeps: Option<TexelSweeps<'a>>,
    truth: Option<GroundTruth>,
    jobs: Vec<Job>,
    /// Bakes that were measured, by each filter. Settings that occur in several sweeps are baked once.
    baked: Vec<(BakeSettings, FilteredRows)>,
    /// Measured over predicted time of a texel: of the standard preset or, before it was baked, of the last bake.
    correction: f64,
    /// Whether the correction is that of the standard preset.
    has_standard: bool,
    /// Seconds of a bake before its first texel.
    fixed_s: f64,
}

impl<'a> Schedule<'a> {
    pub fn new(
        workload: &'a Workload,
        settings: &'a CostSettings,
        work_folder: &Path,
        budget: &'a Budget,
    ) -> Result<Self, CostError> {
        let mut schedule = Self {
            workload,
            settings,
            work_folder: work_folder.to_owned(),
            budget,
            sweeps: None,
            truth: None,
            jobs: all_jobs(settings),
            baked: Vec::new(),
            correction: 1.2,
            has_standard: false,
            fixed_s: workload.fixed_s,
        };
        schedule.sweeps = TexelSweeps::new(workload, budget);
        schedule.check_interrupted()?;
        let Some(sweeps) = &schedule.sweeps else { return Ok(schedule) };
        let a_point_s =
            SCATTERED * (sweeps.exact_texel_s() * truth::LANES as f64 + sweeps.sky_ray_s * f64::from(truth::RAYS));
        let affordable = (TRUTH_SHARE * budget.seconds() / a_point_s.max(1e-9)) as usize;
        schedule.truth = GroundTruth::find(workload, affordable.clamp(LEAST_POINTS, MOST_POINTS), budget);
        schedule.check_interrupted()?;
        Ok(schedule)
    }

    fn check_interrupted(&self) -> Result<(), CostError> {
        if self.budget.is_interrupted() { Err(BakeError::Cancelled.into()) } else { Ok(()) }
    }

    /// Runs what the budget allows, by rank.
    pub fn run_all(&mut self) -> Result<(), CostError> {
        let mut order: Vec<usize> = (0..self.jobs.len()).collect();
        order.sort_by_key(|&index| self.jobs[index].rank);
        for (done, index) in order.into_iter().enumerate() {
            let Job { name, curve, measurement, .. } = &self.jobs[index];
            let (name, curve, measurement) = (name.clone(), *curve, measurement.clone());
            self.budget.task(&format!("{} of {}: {name}", done + 1, self.jobs.len()));
            let row = self.run(&name, curve, &measurement)?;
            self.check_interrupted()?;
            self.jobs[index].row = Some(row);
        }
        Ok(())
    }

    fn run(&mut self, name: &str, curve: &str, measurement: &Measurement) -> Result<CostRow, CostError> {
        let stopped = || CostRow::not_run(name, "stopped: it took longer than predicted, and the budget was spent");
        if let Measurement::Bake(settings, filter) = measurement {
            let known = self.baked.iter().find(|(baked, _)| baked == settings.as_ref());
            let rows = match known {
                Some((_, rows)) => Some(rows.clone()),
                None => self.whole_or_sparse_bake(settings)?,
            };
            let row = rows.map(|rows| row_of(&rows, *filter));
            return Ok(row.map_or_else(stopped, |row| CostRow { name: name.into(), ..row }));
        }
        let Some(predicted_s) = self.predicted_s(measurement) else { return Ok(stopped()) };
        let row = match self.budget.refusal(predicted_s) {
            Some(why) => CostRow::not_run(name, &why),
            None => self.measure(measurement).map_or_else(stopped, |point| measured(name, point)),
        };
        Ok(CostRow { curve: curve.into(), predicted_s: Some(predicted_s), ..row })
    }

    /// Measures a setting at texels. None if it was stopped.
    fn measure(&mut self, measurement: &Measurement) -> Option<SweepPoint> {
        let layer_cap = self.settings.preset(BakeSettings::standard).layer_cap;
        let (sweeps, budget) = (self.sweeps.as_mut()?, self.budget);
        match measurement {
            Measurement::Bake(..) => None,
            Measurement::Engine(choice) => sweeps.engine(*choice, layer_cap, budget),
            Measurement::Stored(bits, layers) => Some(sweeps.stored(*bits, *layers)),
            Measurement::Lanes(count) => sweeps.lanes(*count, layer_cap, budget),
            Measurement::Sky(rays) => sweeps.sky(*rays, budget),
        }
    }

    /// A whole bake if there is time for it, or else a sparse bake. None if it was stopped.
    fn whole_or_sparse_bake(&mut self, settings: &BakeSettings) -> Result<Option<FilteredRows>, CostError> {
        let Some(predicted_s) = self.bake_s(settings) else { return Ok(None) };
        let refusal = self.budget.refusal(predicted_s / WHOLE_SHARE);
        let rows = match refusal {
            None => self.whole_bake(settings)?,
            Some(_) => self.sparse_bake(settings)?,
        };
        let Some(mut rows) = rows else { return Ok(None) };
        rows.iter_mut().for_each(|(_, row)| row.predicted_s = Some(predicted_s));
        if rows.iter().all(|(_, row)| row.is_measured()) {
            self.baked.push((settings.clone(), rows.clone()));
        }
        Ok(Some(rows))
    }

    /// Bakes, compares, and removes the set.
    fn whole_bake(&mut self, settings: &BakeSettings) -> Result<Option<FilteredRows>, CostError> {
        let Some(truth) = &self.truth else { return Ok(None) };
        let folder = self.work_folder.join("baked");
        let manifest = match bake(&self.workload.scene_file, &folder, true, settings, self.budget) {
            Ok(report) => report.manifest,
            Err(BakeError::Cancelled) => return Ok(None),
            Err(error @ BakeError::Memory { .. }) => return Ok(Some(not_run(&format!("not run: {error}")))),
            Err(error) => return Err(error.into()),
        };
        let set = read::read(&folder)?;
        let errors = self.workload.on_threads(|| playback::errors(&set, truth, self.workload.scene()));
        // If this fails, the folder around it is removed later.
        let _ = std::fs::remove_dir_all(&folder);
        let gpu_bytes = |of: fn(&PageMaps, Bits) -> u64| set.pages.iter().map(|page| of(page, set.bits)).sum::<u64>();
        let [of_times, with_tracks] = [PageMaps::gpu_bytes, PageMaps::gpu_bytes_with_tracks].map(gpu_bytes);
        let rows = self.with_errors(How::Baked, errors?).into_iter().map(|(filter, row)| {
            let row = CostRow {
                note: page_note(&manifest, settings),
                seconds: Some(total_s(&manifest.stats.seconds)),
                disk_bytes: Some(manifest.stats.bytes),
                gpu_bytes: Some(if filter == Filter::Tracks { with_tracks } else { of_times }),
                texels: Some(manifest.stats.texels),
                ..row
            };
            (filter, row)
        });
        let rows = rows.collect();
        self.correct(settings, &manifest);
        Ok(Some(rows))
    }

    /// Bakes the texels that are read, and predicts the time of all.
    fn sparse_bake(&mut self, settings: &BakeSettings) -> Result<Option<FilteredRows>, CostError> {
        let Some((truth, sparse_s)) = self.truth.as_ref().zip(self.sparse_bake_s(settings)) else { return Ok(None) };
        if let Some(why) = self.budget.refusal(sparse_s) {
            return Ok(Some(not_run(&why)));
        }
        if settings.tracks != TrackChoice::Off {
            return Ok(Some(not_run("not run: tracks need whole pages, and these do not fit the budget")));
        }
        let Some(found) = sparse_bake(self.workload, truth, settings, self.budget)? else { return Ok(None) };
        let rows = self.with_errors(How::Sampled, found.errors).into_iter().map(|(filter, row)| {
            let row = CostRow {
                note: Some("texels around the points only; time predicted".into()),
                seconds: self.bake_s_of(settings, found.texels as f64),
                gpu_bytes: Some(found.gpu_bytes),
                texels: Some(found.texels),
                ..row
            };
            (filter, row)
        });
        Ok(Some(rows.collect()))
    }

    fn with_errors(&self, how: How, errors: playback::PlaybackErrors) -> FilteredRows {
        let ambient = errors.ambient.and_then(summary);
        let rows = errors.sun_t.into_iter().map(|(filter, sun_t)| {
            let minutes = sun_t.into_iter().map(|t| t * self.workload.path().duration_min).collect();
            (filter, CostRow { how, note: None, sun_min: summary(minutes), ambient, ..CostRow::not_run("", "") })
        });
        rows.collect()
    }

    /// Corrects predictions by the time that a bake's texels took.
    fn correct(&mut self, settings: &BakeSettings, manifest: &Manifest) {
        let StepSeconds { load, unwrap, bvh, .. } = manifest.stats.seconds;
        let took_s = total_s(&manifest.stats.seconds) - load - unwrap - bvh;
        let is_standard = *settings == self.settings.preset(BakeSettings::standard);
        if let Some(texel_s) = self.texel_s(settings).filter(|_| is_standard || !self.has_standard) {
            self.has_standard |= is_standard;
            let predicted_s = texel_s * manifest.stats.texels as f64;
            self.correction = (took_s / predicted_s.max(1e-9)).clamp(0.2, 5.0);
        }
        self.fixed_s = self.fixed_s.max(load + unwrap + bvh);
    }

    /// Predicted seconds of a measurement; unknown where nothing could be measured.
    fn predicted_s(&self, measurement: &Measurement) -> Option<f64> {
        let sweeps = self.sweeps.as_ref()?;
        let sun_s = |which: usize| sweeps.sun_s[which].unwrap_or(sweeps.exact_s / 60.0);
        Some(match measurement {
            Measurement::Bake(settings, _) => self.bake_s(settings)?,
            Measurement::Engine(EngineChoice::Exact) => 3.0 * sweeps.exact_s,
            Measurement::Engine(EngineChoice::Rays(count)) => sun_s(0) * *count as f64,
            Measurement::Engine(EngineChoice::Bisect(count)) => sun_s(1) * *count as f64,
            Measurement::Stored(..) => sweeps.exact_s,
            Measurement::Lanes(count) => 1.5 * sweeps.exact_s * *count as f64 + sweeps.disc_ready_s(),
            Measurement::Sky(rays) => sweeps.sky_s(*rays),
        })
    }

    /// Seconds that a texel of a bake takes, uncorrected.
    fn texel_s(&self, settings: &BakeSettings) -> Option<f64> {
        let sweeps = self.sweeps.as_ref()?;
        let rays = settings.ambient.map_or(0, |request| request.estimate.rays);
        let lanes = settings.lane_count as f64;
        let tracks = if settings.tracks == TrackChoice::Off { 0.0 } else { TRACKS };
        Some((lanes + tracks) * (sweeps.exact_texel_s() + TEXEL_S) + f64::from(rays) * sweeps.sky_ray_s)
    }

    /// Predicted seconds of a bake of this many texels.
    fn bake_s_of(&self, settings: &BakeSettings, texels: f64) -> Option<f64> {
        Some(self.fixed_s + self.correction * texels * self.texel_s(settings)?)
    }

    /// Predicted seconds of a bake.
    fn bake_s(&self, settings: &BakeSettings) -> Option<f64> {
        self.bake_s_of(settings, self.texels(settings))
    }

    /// About how many texels a bake has.
    fn texels(&self, settings: &BakeSettings) -> f64 {
        let page = &self.workload.page;
        let finer = f64::from(settings.page_size_texels) / f64::from(page.edge_texels);
        page.samples.len() as f64 * finer * finer
    }

    /// Predicted seconds of a sparse bake.
    fn sparse_bake_s(&self, settings: &BakeSettings) -> Option<f64> {
        let read = 4.0 * self.truth.as_ref()?.points.len() as f64;
        Some(2.0 * self.fixed_s + 1e-6 * self.texels(settings) + SCATTERED * read * self.texel_s(settings)?)
    }

    /// The sweeps with their knees, and what they were measured against.
    pub fn finish(self) -> (Vec<Sweep>, CostReference) {
        let page = &self.workload.page;
        let reference = CostReference {
            points: self.truth.as_ref().map_or(0, |truth| truth.points.len() as u64),
            buried_points: self.truth.as_ref().map_or(0, |truth| truth.buried as u64),
            lanes: self.workload.lanes(truth::LANES).0.len() as u64,
            moments: MOMENTS as u64,
            point_rays: truth::RAYS.into(),
            page_size_texels: page.edge_texels,
            page_texels: page.samples.len() as u64,
            measured_texels: self.sweeps.as_ref().map_or(0, |sweeps| sweeps.texel_count() as u64),
            texel_rays: sweeps::RAYS.into(),
        };
        let mut rows = self.jobs;
        let sweeps = SWEEPS.iter().map(|&[id, title, measured_on, meaning]| {
            let of_sweep = rows.extract_if(.., |job| job.sweep == id).filter_map(|job| job.row).collect();
            sweep_of([id, title, measured_on, meaning], of_sweep)
        });
        (sweeps.collect(), reference)
    }
}

const BAKES: &str = "whole bakes";
const TEXELS: &str = "texels";
const SEEN: &str = "minutes of sun wrong at a point of a surface, from everything that a bake loses";

/// Id, title, what it is measured on, and which error.
const SWEEPS: [[&str; 4]; 9] = [
    ["presets", "Presets", BAKES, SEEN],
    ["filters", "Filters: standard, drawn in other ways, and with shadow tracks", BAKES, SEEN],
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
    ["sky", "Rays of sky", TEXELS, "difference of ambient visibility at a texel, before anything is stored"],
];

fn sweep_of([id, title, measured_on, meaning]: [&str; 4], rows: Vec<CostRow>) -> Sweep {
    // The knee is that of the first curve, where a sweep has several.
    let curve: Vec<&CostRow> =
        rows.iter().filter(|row| rows.first().is_some_and(|first| first.curve == row.curve)).collect();
    let pair = |row: &&CostRow| Some((row.seconds?, row.error()?.mean));
    let pairs: Vec<(f64, f64)> = curve.iter().map(|row| pair(row).unwrap_or((f64::NAN, f64::NAN))).collect();
    let knee = if matches!(id, "bits" | "layers" | "filters") { None } else { knee(&pairs) };
    let knee = knee.map(|index| curve[index].name.clone());
    Sweep { id: id.into(), title: title.into(), measured_on: measured_on.into(), meaning: meaning.into(), rows, knee }
}

/// All measurements, in the order of their tables.
fn all_jobs(settings: &CostSettings) -> Vec<Job> {
    let mut jobs = Vec::new();
    let mut add = |sweep, curve, rank, name: String, measurement| {
        jobs.push(Job { sweep, curve, name, measurement, rank, row: None });
    };
    let standard = settings.preset(BakeSettings::standard);
    let presets: [(&str, fn(_) -> _, u32); 3] = [
        ("draft", BakeSettings::draft, 0),
        ("standard", BakeSettings::standard, 1),
        ("final", BakeSettings::final_quality, 20),
    ];
    for (name, of, rank) in presets {
        add("presets", "", rank, format!("--preset {name}"), blended(settings.preset(of)));
    }
    let filters = [("nearest", Filter::Nearest), ("bilinear", Filter::Bilinear), ("sharp", Filter::Sharp)];
    for (name, filter) in filters {
        let measurement = Measurement::Bake(Box::new(standard.clone()), filter);
        add("filters", "", 2, format!("--filter {name}"), measurement);
    }
    let tracked = BakeSettings { tracks: TrackChoice::Auto, ..standard.clone() };
    add("filters", "", 20, "--tracks".into(), Measurement::Bake(Box::new(tracked), Filter::Tracks));
    for (page_size_texels, rank) in [(256, 25), (512, 24), (1024, 21), (2048, 20), (4096, 23)] {
        let sized = BakeSettings { page_size_texels, ..standard.clone() };
        add("sizes", "", rank, format!("--size {page_size_texels}"), blended(sized));
    }
    for (lane_count, rank) in [(1, 20), (3, 22), (5, 26)] {
        let laned = BakeSettings { lane_count, ..standard.clone() };
        add("disc", "", rank, format!("--lanes {lane_count}"), blended(laned));
    }
    for count in (4..=12).map(|bits| 1 << bits) {
        let rank = if count > 512 { 40 } else { 10 };
        add("engines", "rays", rank, format!("rays:{count}"), Measurement::Engine(EngineChoice::Rays(count)));
    }
    for count in (4..=8).map(|bits| 1 << bits) {
        add("engines", "bisect", 11, format!("bisect:{count}"), Measurement::Engine(EngineChoice::Bisect(count)));
    }
    add("engines", "exact", 9, "exact".into(), Measurement::Engine(EngineChoice::Exact));
    for bits in [Bits::Eight, Bits::Sixteen] {
        add("bits", "", 12, format!("--bits {}", bits.count()), Measurement::Stored(bits, MOST_LAYERS));
    }
    for layers in [1, 2, 4, 8, MOST_LAYERS] {
        add("layers", "", 13, format!("--layers {layers}"), Measurement::Stored(Bits::Sixteen, layers));
    }
    for count in [1, 3, 5] {
        add("lanes", "", 14, format!("--lanes {count}"), Measurement::Lanes(count));
    }
    for rays in (2..=12).map(|bits| 1u32 << bits) {
        let rank = if rays > 512 { 41 } else { 15 };
        add("sky", "", rank, format!("--ao-rays {rays}"), Measurement::Sky(rays));
    }
    jobs
}

/// A bake that is drawn as usual.
fn blended(settings: BakeSettings) -> Measurement {
    Measurement::Bake(Box::new(settings), Filter::Bilinear)
}

/// What a bake shows by a filter.
fn row_of(rows: &FilteredRows, filter: Filter) -> CostRow {
    let row = rows.iter().find(|(of, row)| *of == filter || !row.is_measured()).map(|(_, row)| row.clone());
    row.unwrap_or_else(|| CostRow::not_run("", "no texel needs a track: the other filters draw its shadows as well"))
}

/// The same why for every filter.
fn not_run(why: &str) -> FilteredRows {
    vec![(Filter::Bilinear, CostRow::not_run("", why))]
}

/// Most layers that a set can have.
const MOST_LAYERS: usize = 16;

fn measured(name: &str, point: SweepPoint) -> CostRow {
    let SweepPoint { seconds, gpu_bytes, sun_min, ambient } = point;
    CostRow {
        how: How::AtTexels,
        note: None,
        seconds: Some(seconds),
        gpu_bytes: Some(gpu_bytes),
        sun_min,
        ambient,
        ..CostRow::not_run(name, "")
    }
}

fn total_s(seconds: &StepSeconds) -> f64 {
    let StepSeconds { load, unwrap, bvh, visibility, ambient, encode, write } = *seconds;
    load + unwrap + bvh + visibility + ambient + encode + write
}

/// A note where a page had to be larger than asked for.
fn page_note(manifest: &Manifest, settings: &BakeSettings) -> Option<String> {
    let edge = manifest.atlases.iter().map(|atlas| atlas.width.max(atlas.height)).max()?;
    (edge > settings.page_size_texels)
        .then(|| format!("a mesh does not fit the page asked for: baked on a page of {edge}"))
}
