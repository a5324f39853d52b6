//! What is compared: sets that are there, or that are baked for as long as it takes.

use super::super::draw::sun_request;
use super::super::exit::Failure;
use super::super::terminal::Terminal;
use super::args::CompareArgs;
use super::viewpoints::check;
use std::collections::BTreeSet;
use std::path::Path;
use sunbake::disk::read::read_manifest;
use sunbake::maps::Bits;
use sunbake::scene::LoadLimits;
use sunbake::settings::BakeSettings;
use sunbake::{BakeError, Prepared};
use sunbake_runtime::Stage;
use sunbake_runtime::compare::report::LeftOut;
use sunbake_runtime::compare::{SetOnDisk, TechniqueSpec, selected};
use sunbake_runtime::stage::{MAX_SCENE_BYTES, StageError};
use tempfile::TempDir;

/// Lanes of the sets that are baked of a scene.
const LANES: [usize; 2] = [1, 3];
/// Why a light without width has one lane.
const NO_DISC: &str = "a light without width has no disc to cut into lanes";
/// Edge of the page that a scene is baked into, unless told.
const PAGE_SIZE_TEXELS: u32 = 2048;

/// What is compared: sets, and the stage that all look at.
pub struct ComparisonInputs {
    pub sets: Vec<SetOnDisk>,
    pub stage: Stage,
    pub techniques: Vec<TechniqueSpec>,
    pub left_out: Vec<LeftOut>,
    /// Of the file that was baked.
    pub source_sha256: String,
    /// Holds what was baked for this comparison.
    _baked: Option<TempDir>,
}

impl ComparisonInputs {
    pub fn of(args: &CompareArgs, against: TechniqueSpec, terminal: &Terminal) -> Result<Self, Failure> {
        let from = &args.source;
        if !from.exists() {
            return Err(Failure::io(format!("{} is not there: check its name", from.display())));
        }
        if from.is_dir() { Self::of_set(args, against) } else { Self::of_scene(args, against, terminal) }
    }

    /// A set as it was baked; fewer bits and lanes are made of those that it has.
    fn of_set(args: &CompareArgs, against: TechniqueSpec) -> Result<Self, Failure> {
        let set = SetOnDisk::read(&args.source).map_err(StageError::Set)?;
        if args.sun.is_given() || args.page_size.is_some() || !args.leave_out.is_empty() {
            return Err(Failure::usage(
                "a set has the sun, the texels and the materials that it was baked with: leave --place, --date, --utc-offset, \
                 --north, --page-size and --leave-out out, or compare the scene",
            ));
        }
        let manifest = read_manifest(&args.source).map_err(StageError::Set)?;
        if let Some(scene) = &args.scene {
            check_source(scene, &manifest.source.sha256)?;
        }
        let lanes = set.entry.lanes as usize;
        let bits = Bits::from_count(set.entry.bits).unwrap_or(Bits::Sixteen);
        let lane_counts = match lanes {
            0 => vec![],
            1 => vec![1],
            lanes => vec![1, lanes],
        };
        let mut left_out = Vec::new();
        if bits == Bits::Eight {
            left_out.push(left("baked:16", "the set has times of 8 bits: bake it with --bits 16"));
        }
        let is_point = manifest.path.as_ref().is_some_and(|path| path.angular_radius_deg == 0.0);
        match lanes {
            0 => left_out.push(left("baked", "the set holds no times of the sun: bake it with --only intervals,ao")),
            1 if is_point => left_out.push(left("baked:lanes3", NO_DISC)),
            1 => left_out.push(left("baked:lanes3", "the set has one lane across the sun: bake it with --lanes 3")),
            _ => {}
        }
        let all = TechniqueSpec::all(bits, &lane_counts);
        let techniques = selected(&all, &args.techniques).map_err(Failure::usage)?;
        if let TechniqueSpec::Baked(_) = against
            && !all.contains(&against)
        {
            return Err(Failure::usage(format!("this set cannot be played back as {against}: give another --against")));
        }
        let stage = Stage::read(&args.source)?.without_lamp().without_times();
        Ok(Self { sets: vec![set], stage, techniques, left_out, source_sha256: manifest.source.sha256, _baked: None })
    }

    /// A scene, baked once for each count of lanes that somebody plays back.
    fn of_scene(args: &CompareArgs, against: TechniqueSpec, terminal: &Terminal) -> Result<Self, Failure> {
        if args.scene.is_some() {
            return Err(Failure::usage("--scene is for sets: leave it out"));
        }
        let all = TechniqueSpec::all(Bits::Sixteen, &LANES);
        let mut techniques = selected(&all, &args.techniques).map_err(Failure::usage)?;
        let mut left_out = Vec::new();
        let lanes_of = |one: &TechniqueSpec| match one {
            TechniqueSpec::Baked(playback) => Some(playback.lanes),
            _ => None,
        };
        let mut wanted: BTreeSet<usize> = techniques.iter().chain([&against]).filter_map(lanes_of).collect();
        let settings = |lane_count: usize| {
            Ok::<_, Failure>(BakeSettings {
                page_size_texels: args.page_size.unwrap_or(PAGE_SIZE_TEXELS),
                leave_out: args.leave_out.clone(),
                lane_count,
                ambient: None,
                threads: args.threads,
                ..BakeSettings::standard(sun_request(&args.sun)?)
            })
        };
        let Prepared { scene, path, .. } = sunbake::prepare(&args.source, &settings(1)?, terminal)?;
        check(args, &scene, path.as_ref())?;
        if wanted.contains(&3) && path.as_ref().is_some_and(|path| path.angular_radius_rad == 0.0) {
            wanted = BTreeSet::from([1]);
            techniques.retain(|one| lanes_of(one).is_none_or(|lanes| lanes == 1));
            left_out.push(left("baked:lanes3", NO_DISC));
        }
        if wanted.is_empty() {
            let source_sha256 = scene.source.sha256.clone();
            let stage = Stage::plain(scene, path);
            return Ok(Self { sets: Vec::new(), stage, techniques, left_out, source_sha256, _baked: None });
        }
        drop(scene);
        let desk = tempfile::tempdir().map_err(|e| Failure::io(format!("cannot make a folder to bake into: {e}")))?;
        let mut sets = Vec::new();
        for lanes in wanted {
            let target = desk.path().join(format!("lanes{lanes}"));
            let baked = sunbake::bake(&args.source, &target, false, &settings(lanes)?, terminal)?;
            sets.push(SetOnDisk::read(&target).map_err(StageError::Set)?);
            if !args.quiet && sets.len() == 1 {
                terminal.clear();
                baked.warnings.iter().for_each(|warning| eprintln!("sunplay: {warning}"));
            }
        }
        let manifest = read_manifest(&sets[0].folder).map_err(StageError::Set)?;
        let stage = Stage::read(&sets[0].folder)?.without_times();
        let source_sha256 = manifest.source.sha256;
        Ok(Self { sets, stage, techniques, left_out, source_sha256, _baked: Some(desk) })
    }
}

fn left(name: &str, reason: &str) -> LeftOut {
    LeftOut { name: name.into(), reason: reason.into() }
}

/// Whether a scene is the one that a set was baked of.
fn check_source(scene: &Path, baked: &str) -> Result<(), Failure> {
    let limits = LoadLimits { max_memory_bytes: MAX_SCENE_BYTES };
    let found = sunbake::scene::load(scene, &limits).map_err(|e| Failure::from(BakeError::Load(e)))?.source.sha256;
    if found == baked {
        return Ok(());
    }
    Err(Failure::bad_input(format!(
        "{} is not the scene that the set was baked of: its SHA-256 is {found}, and was {baked}; bake it again",
        scene.display()
    )))
}
