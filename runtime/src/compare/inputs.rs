//! What is compared: sets that are there, or that are baked for as long as the comparison lasts.

use super::comparison::SetOnDisk;
use super::report::LeftOut;
use super::settings::{CompareProgress, CompareSettings, CompareSource};
use super::technique::{TechniqueSpec, selected};
use super::viewpoints::check_request;
use super::{CompareError, Playback};
use crate::stage::{MAX_SCENE_BYTES, Stage, StageError};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use sunbake::disk::read::read_manifest;
use sunbake::maps::Bits;
use sunbake::scene::{LoadLimits, ObjectWishes, Scene};
use sunbake::settings::{BakeSettings, SunRequest, TrackChoice};
use sunbake::{BakeError, Prepared};
use sunbake_shaders::Filter;
use tempfile::TempDir;

/// Lanes of the sets that are baked of a scene.
const LANES: [usize; 2] = [1, 3];
/// Why a light without width has one lane.
const NO_DISC: &str = "a light without width has no disc to cut into lanes";
/// Why it has no tracks.
const NO_WIDTH: &str = "tracks are read as shares of a light's width, and this one has none";
/// Edge of the page that a scene is baked into, unless told.
const PAGE_SIZE_TEXELS: u32 = 2048;

/// Sets, and the stage that all techniques draw.
pub(super) struct ComparisonInputs {
    /// The set's folder, or the scene's file.
    pub source: PathBuf,
    pub sets: Vec<SetOnDisk>,
    pub stage: Stage,
    pub techniques: Vec<TechniqueSpec>,
    pub left_out: Vec<LeftOut>,
    /// Of the file that was baked.
    pub source_sha256: String,
    /// Holds what was baked for this comparison.
    _baked: Option<TempDir>,
}

/// How a scene is baked for a comparison.
struct SceneBake<'a> {
    file: &'a Path,
    sun: &'a SunRequest,
    page_size_texels: u32,
    objects: &'a ObjectWishes,
    threads: usize,
}

impl ComparisonInputs {
    pub fn of(settings: &CompareSettings, progress: &dyn CompareProgress) -> Result<Self, CompareError> {
        match &settings.source {
            CompareSource::Set { folder, scene } => Self::of_set(settings, folder, scene.as_deref()),
            CompareSource::Scene { file, sun, page_size_texels, objects } => {
                let bake = SceneBake {
                    file,
                    sun,
                    page_size_texels: page_size_texels.unwrap_or(PAGE_SIZE_TEXELS),
                    objects,
                    threads: settings.threads,
                };
                Self::of_scene(settings, &bake, progress)
            }
        }
    }

    /// A set as it was baked; fewer bits and lanes are made of those that it has.
    fn of_set(settings: &CompareSettings, folder: &Path, scene: Option<&Path>) -> Result<Self, CompareError> {
        let set = SetOnDisk::read(folder).map_err(StageError::Set)?;
        let manifest = read_manifest(folder).map_err(StageError::Set)?;
        if let Some(scene) = scene {
            check_source(scene, &manifest.source.sha256)?;
        }
        let lanes = set.entry.lanes as usize;
        let bits = Bits::from_count(set.entry.bits).unwrap_or(Bits::Sixteen);
        let lane_counts = match lanes {
            0 => vec![],
            1 => vec![1],
            lanes => vec![1, lanes],
        };
        let is_point = manifest.path.as_ref().is_some_and(|path| path.angular_radius_deg == 0.0);
        let has_tracks = set.entry.tracks.is_some();
        let left_out = not_in_set(bits, lanes, is_point, has_tracks);
        let all = TechniqueSpec::all(bits, &lane_counts, has_tracks);
        let techniques = selected(&all, &settings.techniques)?;
        if let TechniqueSpec::Baked(_) = settings.against
            && !all.contains(&settings.against)
        {
            return Err(CompareError::ReferenceNotInSet(settings.against.to_string()));
        }
        let stage = Stage::read_without_looks(folder)?.without_lamp().without_times();
        let source_sha256 = manifest.source.sha256;
        Ok(Self { source: folder.into(), sets: vec![set], stage, techniques, left_out, source_sha256, _baked: None })
    }

    /// A scene, baked once for each count of lanes that some technique plays back.
    fn of_scene(
        settings: &CompareSettings,
        bake: &SceneBake,
        progress: &dyn CompareProgress,
    ) -> Result<Self, CompareError> {
        let source = bake.file.to_owned();
        let all = TechniqueSpec::all(Bits::Sixteen, &LANES, true);
        let mut techniques = selected(&all, &settings.techniques)?;
        let mut left_out = Vec::new();
        let mut wanted: BTreeSet<usize> = techniques.iter().chain([&settings.against]).filter_map(lanes_of).collect();
        let Prepared { scene, path, .. } = sunbake::prepare(bake.file, &bake.settings(1, false), progress)?;
        check_request(settings, &scene, path.as_ref())?;
        let mut wants_tracks = techniques.iter().chain([&settings.against]).any(plays_tracks);
        if path.as_ref().is_some_and(|path| path.angular_radius_rad == 0.0) {
            if wanted.contains(&3) {
                wanted = BTreeSet::from([1]);
                techniques.retain(|one| lanes_of(one).is_none_or(|lanes| lanes == 1));
                left_out.push(left("baked:lanes3", NO_DISC));
            }
            if plays_tracks(&settings.against) {
                return Err(CompareError::ReferenceNotInSet(settings.against.to_string()));
            }
            if wants_tracks {
                wants_tracks = false;
                techniques.retain(|one| !plays_tracks(one));
                left_out.push(left("baked:tracks", NO_WIDTH));
            }
        }
        if wanted.is_empty() {
            let source_sha256 = scene.source.sha256.clone();
            // Scores and pictures tell of shadows alone.
            let stage = Stage::plain(Scene { file: None, ..scene }, path);
            return Ok(Self { source, sets: Vec::new(), stage, techniques, left_out, source_sha256, _baked: None });
        }
        drop(scene);
        let work_folder = tempfile::tempdir().map_err(CompareError::WorkFolder)?;
        let sets = bake.sets(&wanted, wants_tracks, work_folder.path(), progress)?;
        let manifest = read_manifest(&sets[0].folder).map_err(StageError::Set)?;
        let stage = Stage::read_without_looks(&sets[0].folder)?.without_times();
        let source_sha256 = manifest.source.sha256;
        Ok(Self { source, sets, stage, techniques, left_out, source_sha256, _baked: Some(work_folder) })
    }
}

impl SceneBake<'_> {
    fn settings(&self, lane_count: usize, wants_tracks: bool) -> BakeSettings {
        BakeSettings {
            page_size_texels: self.page_size_texels,
            objects: self.objects.clone(),
            lane_count,
            tracks: if wants_tracks { TrackChoice::Auto } else { TrackChoice::Off },
            ambient: None,
            threads: self.threads,
            ..BakeSettings::standard(self.sun.clone())
        }
    }

    /// A set for each count of lanes, that of one lane with tracks if they are wanted.
    fn sets(
        &self,
        lane_counts: &BTreeSet<usize>,
        wants_tracks: bool,
        folder: &Path,
        progress: &dyn CompareProgress,
    ) -> Result<Vec<SetOnDisk>, CompareError> {
        let mut sets = Vec::new();
        for &lanes in lane_counts {
            let target = folder.join(format!("lanes{lanes}"));
            let baked =
                sunbake::bake(self.file, &target, false, &self.settings(lanes, wants_tracks && lanes == 1), progress)?;
            sets.push(SetOnDisk::read(&target).map_err(StageError::Set)?);
            if sets.len() == 1 {
                progress.baked(&baked.warnings);
            }
        }
        Ok(sets)
    }
}

fn lanes_of(technique: &TechniqueSpec) -> Option<usize> {
    match technique {
        TechniqueSpec::Baked(Playback { lanes, .. }) => Some(*lanes),
        _ => None,
    }
}

fn plays_tracks(technique: &TechniqueSpec) -> bool {
    matches!(technique, TechniqueSpec::Baked(Playback { filter: Filter::Tracks, .. }))
}

/// Ways to play a set back that it cannot serve, and why.
fn not_in_set(bits: Bits, lanes: usize, is_point: bool, has_tracks: bool) -> Vec<LeftOut> {
    let mut left_out = Vec::new();
    if bits == Bits::Eight {
        left_out.push(left("baked:16", "the set has times of 8 bits"));
    }
    match lanes {
        0 => left_out.push(left("baked", "the set holds no times of the sun: it was baked without intervals")),
        1 if is_point => left_out.push(left("baked:lanes3", NO_DISC)),
        1 => left_out.push(left("baked:lanes3", "the set has one lane across the sun")),
        _ => {}
    }
    if lanes > 0 && !has_tracks {
        left_out.push(left("baked:tracks", if is_point { NO_WIDTH } else { "the set was baked without --tracks" }));
    }
    left_out
}

fn left(name: &str, reason: &str) -> LeftOut {
    LeftOut { name: name.into(), reason: reason.into() }
}

/// Refuses a scene that is not the one that a set was baked of.
fn check_source(scene: &Path, baked: &str) -> Result<(), CompareError> {
    let limits = LoadLimits { max_memory_bytes: MAX_SCENE_BYTES };
    let found = sunbake::scene::load(scene, &limits).map_err(BakeError::Load)?.source.sha256;
    if found == baked {
        return Ok(());
    }
    Err(CompareError::OtherScene { file: scene.display().to_string(), found, baked: baked.to_owned() })
}
