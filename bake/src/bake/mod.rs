//! A bake from end to end: the flow of the crate, one stage after the other.

mod ambient;
mod baked;
mod entries;
mod layout;
mod leave_out;
mod light;
mod pages;

use crate::ambient::AmbientEngine;
use crate::atlas::AtlasError;
use crate::disk::manifest::{AtlasEntry, LampEntry, Manifest, SceneEntry, StageSeconds, Stats};
use crate::disk::write::{SetWriter, WriteError};
use crate::glb::{self, GlbTooLarge, Occlusion};
use crate::lamp::{self, LampError, LampFileError, LampPath};
use crate::maps::Lane;
use crate::plan::{Effect, EffectPlan, LayersNeeded, NoSun};
use crate::progress::{BakeStage, Progress};
use crate::remedy::Setting;
use crate::scene::{self, Geometry, LoadError, LoadLimits, Scene, ShadingNormals};
use crate::settings::{AmbientRequest, BakeSettings, EngineChoice, SunRequest};
use crate::sun::{self, DayError, DayOutcome, KeyedError, LightError, SunPath};
use crate::trace::Tracer;
use crate::visibility::Engine;
use crate::warning::Warning;
use ambient::Sky;
pub use baked::Bake;
use baked::{PageFiles, PageSink, Rest, stored_bits, write_rest};
use entries::{instance_entries, loss_warnings, manifest_of};
pub(crate) use layout::unwrap_somehow;
use layout::{BYTES_PER_SAMPLE, check_memory};
use leave_out::{darkness_warning, leave_out};
use light::{Account, LightJob};
use pages::{Lights, PageBaker};
use std::path::Path;
use std::time::Instant;

/// Why a bake did not finish. Nothing was left behind.
#[derive(Debug, thiserror::Error)]
pub enum BakeError {
    /// The scene cannot be read.
    #[error(transparent)]
    Load(#[from] LoadError),
    /// The day is impossible.
    #[error(transparent)]
    Day(#[from] DayError),
    /// The path file is wrong.
    #[error(transparent)]
    Keyed(#[from] KeyedError),
    /// The lamp's path file is wrong.
    #[error(transparent)]
    LampFile(#[from] LampFileError),
    /// The lamp's path cannot last as long as the sun's.
    #[error(transparent)]
    Lamp(#[from] LampError),
    /// Two lamps are asked for.
    #[error("the path file and the lamp file both bring a lamp, and a set holds one")]
    TwoLamps,
    /// The engine finds no lamps.
    #[error("the engine {0} does not find when a lamp is seen")]
    LampEngine(EngineChoice),
    /// The scene's light makes no path.
    #[error(transparent)]
    Light(#[from] LightError),
    /// A material to be left out is not there.
    #[error("the scene has no material named {name:?} to leave out; it has: {known}")]
    NoSuchMaterial {
        /// The name given.
        name: String,
        /// Names there are, as far as fits.
        known: String,
    },
    /// The scene cannot be laid out.
    #[error(transparent)]
    Atlas(AtlasError),
    /// The listener asked to stop.
    #[error("stopped before the end; nothing was written")]
    Cancelled,
    /// The scene cannot be written again.
    #[error(transparent)]
    TooLarge(#[from] GlbTooLarge),
    /// The set cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// More memory is needed than allowed.
    #[error("{what} needs about {needed_mib} MiB of memory and {allowed_mib} MiB are allowed")]
    Memory {
        /// What needs it.
        what: String,
        /// Settings of which a smaller value makes it need less.
        smaller: Vec<Setting>,
        /// How much, in MiB.
        needed_mib: u64,
        /// How much is allowed, in MiB.
        allowed_mib: u64,
    },
    /// The threads cannot be started.
    #[error("cannot start {threads} threads: {reason}")]
    Threads {
        /// How many were asked for.
        threads: usize,
        /// What the system says.
        reason: String,
    },
    /// OpenEXR is asked for, and the feature `exr` is off.
    #[error("this build writes no OpenEXR, which ambient numbers and loss maps are stored as")]
    NoExr,
}

impl From<AtlasError> for BakeError {
    fn from(error: AtlasError) -> Self {
        match error {
            AtlasError::Cancelled => Self::Cancelled,
            AtlasError::TooDense { density_per_metre, texels, most } => Self::Memory {
                what: format!("a density of {density_per_metre} texels a metre (about {texels} texels)"),
                smaller: vec![Setting::TexelsPerMetre],
                needed_mib: texels.saturating_mul(BYTES_PER_SAMPLE) >> 20,
                allowed_mib: most.saturating_mul(BYTES_PER_SAMPLE) >> 20,
            },
            other => Self::Atlas(other),
        }
    }
}

/// What a finished bake has to say.
#[derive(Debug, Clone)]
pub struct BakeReport {
    /// The manifest as written.
    pub manifest: Manifest,
    /// What a caller should know.
    pub warnings: Vec<Warning>,
}

/// A scene read and its plan made: what `--explain` shows, before anything is spent.
#[derive(Debug)]
pub struct Prepared {
    /// The scene.
    pub scene: Scene,
    /// The sun's path, if it rises.
    pub path: Option<SunPath>,
    /// The lamp's path, world space, if one is asked for.
    pub lamp: Option<LampPath>,
    /// What will be baked and why.
    pub plan: EffectPlan,
    /// What a caller should know.
    pub warnings: Vec<Warning>,
    pub(crate) load_seconds: f64,
}

/// Reads the scene and decides what to bake.
pub fn prepare(scene_file: &Path, settings: &BakeSettings, progress: &dyn Progress) -> Result<Prepared, BakeError> {
    progress.start(BakeStage::Load, 0);
    let started = Instant::now();
    if !cfg!(feature = "exr") && (settings.loss_map || settings.ambient.is_some_and(|request| request.exr)) {
        return Err(BakeError::NoExr);
    }
    let limits = LoadLimits { max_memory_bytes: settings.max_memory_bytes };
    let prepared = prepare_scene(scene::load(scene_file, &limits)?, settings)?;
    Ok(Prepared { load_seconds: started.elapsed().as_secs_f64(), ..prepared })
}

/// Decides what to bake of a scene.
fn prepare_scene(mut scene: Scene, settings: &BakeSettings) -> Result<Prepared, BakeError> {
    leave_out(&mut scene, &settings.leave_out)?;
    let mut warnings: Vec<Warning> = scene.warnings.iter().cloned().map(Warning::Scene).collect();
    let is_lamp_alone = matches!(&settings.sun, SunRequest::Keyed { json, .. } if lamp::is_lamp(json));
    let path = if is_lamp_alone { None } else { sun_path(&settings.sun, &scene, &mut warnings)? };
    let lamp = lamp_path(settings, path.as_ref())?.filter(|_| settings.bakes_intervals);
    let no_sun = if is_lamp_alone { NoSun::LampInstead } else { NoSun::DoesNotRise };
    let plan = EffectPlan::new(&scene, path.as_ref(), lamp.as_ref(), settings, no_sun);
    Ok(Prepared { scene, path, lamp, plan, warnings, load_seconds: 0.0 })
}

/// The lamp that is asked for, beside the sun or instead of it. Beside a sun it takes as long as that.
fn lamp_path(settings: &BakeSettings, sun: Option<&SunPath>) -> Result<Option<LampPath>, BakeError> {
    let instead = match &settings.sun {
        SunRequest::Keyed { json, .. } if lamp::is_lamp(json) => Some(json),
        _ => None,
    };
    let json = match (&settings.lamp, instead) {
        (None, None) => return Ok(None),
        (Some(_), Some(_)) => return Err(BakeError::TwoLamps),
        (Some(json), None) | (None, Some(json)) => json,
    };
    if !settings.engine.finds_lamps() {
        return Err(BakeError::LampEngine(settings.engine));
    }
    let lamp = lamp::parse_lamp(json)?;
    Ok(Some(match sun {
        Some(sun) => lamp.lasting(sun.duration_min)?,
        None => lamp,
    }))
}

/// Bakes `scene_file` into the folder `target`. `force` allows an older set there to be replaced.
pub fn bake(
    scene_file: &Path,
    target: &Path,
    force: bool,
    settings: &BakeSettings,
    progress: &dyn Progress,
) -> Result<BakeReport, BakeError> {
    // First of all the folder: nobody should wait for a bake that cannot be kept.
    let mut writer = SetWriter::begin(target, force)?;
    in_pool(settings.threads, || {
        let prepared = prepare(scene_file, settings, progress)?;
        let mut files = PageFiles { writer: &mut writer, bits: stored_bits(settings) };
        let Rest { manifest, scene_glb, vertices_glb, warnings } =
            bake_prepared(&prepared, &mut files, settings, progress)?;
        let manifest = write_rest(writer, manifest, &scene_glb, vertices_glb.as_deref())?;
        Ok(BakeReport { manifest, warnings })
    })?
}

/// Bakes a scene in memory: what [`bake`] makes, kept instead of written. All pages are held at once, where [`bake`] holds one.
/// The scene is copied, because [`BakeSettings::leave_out`] changes its materials.
///
/// # Errors
///
/// As [`bake`], save those of reading and writing files.
pub fn bake_scene(scene: &Scene, settings: &BakeSettings, progress: &dyn Progress) -> Result<Bake, BakeError> {
    in_pool(settings.threads, || {
        let prepared = prepare_scene(scene.clone(), settings)?;
        let mut pages = Vec::new();
        let rest = bake_prepared(&prepared, &mut pages, settings, progress)?;
        let Rest { manifest, scene_glb, vertices_glb, warnings } = rest;
        let Prepared { path, lamp, .. } = prepared;
        Ok(Bake { manifest, path, lamp, bits: stored_bits(settings), pages, scene_glb, vertices_glb, warnings })
    })?
}

fn in_pool<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> Result<T, BakeError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    Ok(pool.map_err(|e| BakeError::Threads { threads, reason: e.to_string() })?.install(work))
}

fn bake_prepared(
    prepared: &Prepared,
    sink: &mut dyn PageSink,
    settings: &BakeSettings,
    progress: &dyn Progress,
) -> Result<Rest, BakeError> {
    let Prepared { scene, path, lamp, plan, .. } = prepared;
    let settings = &BakeSettings {
        lane_count: plan.lane_count(settings.lane_count),
        loss_map: plan.is_on(Effect::LossMap),
        ..settings.clone()
    };
    check_memory(scene, settings, settings.page_size_texels)?;
    check_cancelled(progress)?;
    let mut seconds = StageSeconds { load: prepared.load_seconds, ..StageSeconds::default() };
    let mut warnings = prepared.warnings.clone();
    let (atlas, settings) = &timed(&mut seconds.unwrap, || unwrap_somehow(scene, settings, &mut warnings, progress))?;

    progress.start(BakeStage::Bvh, 0);
    let geometry = Geometry::new(scene);
    let tracer = timed(&mut seconds.bvh, || Tracer::new(scene, &geometry));
    let path = path.as_ref().filter(|_| plan.is_on(Effect::SunIntervals));
    let (lanes, lane_paths) = path.map(|path| lanes_of(path, settings.lane_count)).unwrap_or_default();
    let engine = path.map(|_| settings.engine.engine(&tracer, &lane_paths, settings.edge_seconds));
    let duration_min = path.map_or(0.0, |p| p.duration_min);
    let sun =
        engine.as_deref().map(|engine| LightJob { engine, lanes: &lanes, duration_min, stage: BakeStage::Visibility });
    let lamp_engine = lamp.as_ref().map(|path| lamp_engine(settings.engine, &tracer, path, scene)).transpose()?;
    let lamp = lamp.as_ref().zip(lamp_engine.as_deref()).map(|(path, engine)| {
        let duration_min = path.duration_min();
        LightJob { engine, lanes: &[Lane::CENTRE], duration_min, stage: BakeStage::Lamp }
    });
    let normals = ShadingNormals::new(scene);
    let request = settings.ambient.as_ref();
    let engine = |request: &AmbientRequest| AmbientEngine::new(scene, &geometry, &tracer, request.estimate);
    let engine = timed(&mut seconds.bvh, || request.map(engine));
    let sky = request.zip(engine.as_ref()).map(|(request, engine)| Sky { engine, request, normals: &normals });
    let lights = Lights { sun, lamp, sky };
    let mut pages = PageBaker::new(scene, &geometry, atlas, settings, lights, progress, seconds);
    let atlases = pages.bake_all(sink)?;
    let occlusion = (!pages.occlusion.is_empty()).then(|| Occlusion { atlas, pages: &pages.occlusion });
    let written = glb::write_glb(scene, &atlas.layouts, occlusion)?;
    let (vertices_glb, vertices) = pages.bake_vertices()?.unzip();
    let needed = layers_needed(&pages, &atlases);
    let mut manifest = finished(pages, prepared, &lights, settings);
    if let Some(ambient) = &mut manifest.ambient {
        ambient.vertices = vertices;
    }
    let manifest = Manifest {
        scene: SceneEntry { sha256: Some(scene::sha256(&written.bytes)), ..manifest.scene },
        atlases,
        instances: instance_entries(scene, atlas, &written),
        effects: plan.clone().after_bake(needed).entries(),
        ..manifest
    };
    check_cancelled(progress)?;
    warnings.extend(atlas.warnings.iter().cloned());
    warnings.extend(path.and_then(|_| darkness_warning(manifest.stats.dark_texels, manifest.stats.texels)));
    warnings.extend(loss_warnings(&manifest, settings));
    let of_sky = manifest.ambient.as_ref().zip(settings.ambient.as_ref());
    warnings.extend(of_sky.into_iter().flat_map(|(entry, request)| ambient::warnings(entry, request)));
    Ok(Rest { manifest, scene_glb: written.bytes, vertices_glb, warnings })
}

fn lamp_engine<'a>(
    choice: EngineChoice,
    tracer: &'a Tracer,
    path: &LampPath,
    scene: &Scene,
) -> Result<Box<dyn Engine + 'a>, BakeError> {
    let engine = choice.lamp_engine(tracer, &path.relative_to(scene.centre_m));
    engine.ok_or(BakeError::LampEngine(choice))
}

/// How many layers texels turned out to need; of two lights, those of the light that needs more.
fn layers_needed(pages: &PageBaker, atlases: &[AtlasEntry]) -> LayersNeeded {
    let of_sun = atlases.iter().flat_map(|page| &page.lanes).map(|lane| lane.layers.len());
    let of_lamp = atlases.iter().flat_map(|page| &page.lamp).map(|lamp| lamp.layers.len());
    LayersNeeded {
        layers: of_sun.chain(of_lamp).max().unwrap_or(0),
        crowded_texels: pages.sun.crowded_texels.max(pages.lamp.crowded_texels),
        texels: pages.stats.texels,
    }
}

/// The manifest with what baking its lights took and lost.
fn finished(pages: PageBaker, prepared: &Prepared, lights: &Lights, settings: &BakeSettings) -> Manifest {
    let PageBaker { stats, sun, lamp, atlas, sky_account, .. } = pages;
    let manifest = manifest_of(prepared, atlas, settings);
    let Account { work, intervals, dark_texels, most_intervals, loss, .. } = sun;
    let lamp = manifest.lamp.zip(lights.lamp).map(|(entry, light)| {
        let (stats, error) = lamp.of_lamp(&light);
        LampEntry { stats, error, ..entry }
    });
    Manifest {
        lamp,
        ambient: settings.ambient.as_ref().map(|request| ambient::entry(request, &sky_account)),
        stats: Stats {
            rays: work.rays,
            node_tests: work.nodes,
            triangle_tests: work.triangles,
            intervals,
            dark_texels,
            most_intervals,
            ..stats
        },
        error: loss.finish(lights.sun.map_or(0.0, |sun| sun.duration_min)),
        ..manifest
    }
}

/// So many lanes across the sun's disc, and the path of each.
fn lanes_of(path: &SunPath, count: usize) -> (Vec<Lane>, Vec<SunPath>) {
    let lanes = Lane::across_disc(count, path.angular_radius_rad);
    let paths = lanes.iter().map(|lane| path.lane(lane.offset_rad)).collect();
    (lanes, paths)
}

fn check_cancelled(progress: &dyn Progress) -> Result<(), BakeError> {
    if progress.is_cancelled() { Err(BakeError::Cancelled) } else { Ok(()) }
}

fn timed<T>(seconds: &mut f64, work: impl FnOnce() -> T) -> T {
    let started = Instant::now();
    let value = work();
    *seconds += started.elapsed().as_secs_f64();
    value
}

/// The sun that is asked for, over a scene; none, with a warning that says so, where it does not rise.
pub fn sun_path(
    request: &SunRequest,
    scene: &Scene,
    warnings: &mut Vec<Warning>,
) -> Result<Option<SunPath>, BakeError> {
    let request = match (request, scene.sun_direction) {
        (SunRequest::Keyed { json, north_deg }, _) => return Ok(Some(sun::parse_keyed(json, *north_deg)?)),
        (SunRequest::SceneOr(_), Some(direction)) => {
            let radius_rad = sun::SUN_ANGULAR_RADIUS_DEG.to_radians();
            return Ok(Some(sun::fixed_light(direction, radius_rad)?));
        }
        (SunRequest::Day(request) | SunRequest::SceneOr(request), _) => request,
    };
    match sun::day(request)? {
        DayOutcome::Path(path) => Ok(Some(path)),
        DayOutcome::NoSun { highest_elevation_deg, .. } => {
            let (latitude_deg, date) = (request.latitude_deg, request.date);
            warnings.push(Warning::NoSunrise { latitude_deg, date, highest_elevation_deg });
            Ok(None)
        }
    }
}
