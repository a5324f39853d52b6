//! A bake from end to end: the flow of the crate, one step after the other.

mod ambient;
mod baked;
mod entries;
mod error;
mod layout;
mod light;
mod memory;
mod narrow;
mod occluders;
mod pages;
mod prepare;
mod timing;
mod tracks;

pub use baked::Bake;
pub use error::BakeError;
pub(crate) use layout::fitting_atlas;
pub use prepare::{Prepared, prepare, sun_path};

use crate::ambient::AmbientEngine;
use crate::disk::manifest::{AtlasEntry, LampEntry, Manifest, SceneEntry, Stats, StepSeconds};
use crate::disk::write::SetWriter;
use crate::glb::{self, Occlusion};
use crate::lamp::LampPath;
use crate::maps::Lane;
use crate::plan::{Effect, LayersNeeded};
use crate::progress::{BakeStep, Progress};
use crate::scene::{self, Components, Scene, ShadingNormals};
use crate::settings::{AmbientRequest, BakeSettings, EngineChoice};
use crate::sun::SunPath;
use crate::trace::Tracer;
use crate::visibility::{Engine, ExactEngine, OccluderFinder};
use crate::warning::Warning;
use baked::{PageFiles, PageSink, UnpagedBake, stored_bits, write_unpaged};
use entries::{instance_entries, loss_warnings, manifest_of};
use layout::check_memory;
use light::{AmbientJob, LightAccount, LightJob, Lights};
use narrow::narrow_warning;
use occluders::{darkness_warning, occluder_warnings};
use pages::PageBaker;
use prepare::prepare_scene;
use std::path::Path;
use timing::{check_cancelled, timed};
use tracks::TrackJob;

/// The result of a finished bake.
#[derive(Debug, Clone)]
pub struct BakeReport {
    /// The manifest as written.
    pub manifest: Manifest,
    /// What a caller should know.
    pub warnings: Vec<Warning>,
}

/// Bakes `scene_file` into the folder `target`. `force` allows an older set there to be replaced.
pub fn bake(
    scene_file: &Path,
    target: &Path,
    force: bool,
    settings: &BakeSettings,
    progress: &dyn Progress,
) -> Result<BakeReport, BakeError> {
    // The folder comes first: nobody should wait for a bake that cannot be written.
    let mut writer = SetWriter::begin(target, force)?;
    in_pool(settings.threads, || {
        let prepared = prepare(scene_file, settings, progress)?;
        let mut files = PageFiles { writer: &mut writer, bits: stored_bits(settings) };
        let UnpagedBake { manifest, scene_glb, vertices_glb, warnings } =
            bake_prepared(&prepared, &mut files, settings, progress)?;
        let manifest = write_unpaged(writer, manifest, &scene_glb, vertices_glb.as_deref())?;
        Ok(BakeReport { manifest, warnings })
    })?
}

/// Bakes a scene in memory: the result of [`bake`], kept instead of written. All pages are held at once, where [`bake`]
/// holds one. The scene is copied, because [`BakeSettings::objects`] changes it.
///
/// # Errors
///
/// As [`bake`], except for reading and writing files.
pub fn bake_scene(scene: &Scene, settings: &BakeSettings, progress: &dyn Progress) -> Result<Bake, BakeError> {
    in_pool(settings.threads, || {
        let prepared = prepare_scene(scene.clone(), settings)?;
        let mut pages = Vec::new();
        let rest = bake_prepared(&prepared, &mut pages, settings, progress)?;
        let UnpagedBake { manifest, scene_glb, vertices_glb, warnings } = rest;
        let Prepared { path, lamp, .. } = prepared;
        Ok(Bake { manifest, path, lamp, bits: stored_bits(settings), pages, scene_glb, vertices_glb, warnings })
    })?
}

/// Most threads that are started. A million take minutes to start, and the machine with them.
const MOST_THREADS: usize = 1024;

/// What makes a pool of threads; 0 is one per core.
pub(crate) fn of_threads(threads: usize) -> Result<rayon::ThreadPoolBuilder, BakeError> {
    if threads > MOST_THREADS {
        return Err(BakeError::Threads { threads, reason: format!("{MOST_THREADS} are the most") });
    }
    Ok(rayon::ThreadPoolBuilder::new().num_threads(threads))
}

fn in_pool<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> Result<T, BakeError> {
    let pool = of_threads(threads)?.build();
    Ok(pool.map_err(|e| BakeError::Threads { threads, reason: e.to_string() })?.install(work))
}

fn bake_prepared(
    prepared: &Prepared,
    sink: &mut dyn PageSink,
    settings: &BakeSettings,
    progress: &dyn Progress,
) -> Result<UnpagedBake, BakeError> {
    let Prepared { scene, path, lamp, plan, .. } = prepared;
    let settings = &BakeSettings {
        lane_count: plan.lane_count(settings.lane_count),
        loss_map: plan.is_on(Effect::LossMap),
        ..settings.clone()
    };
    check_memory(scene, settings, settings.page_size_texels)?;
    check_cancelled(progress)?;
    let mut seconds = StepSeconds { load: prepared.load_seconds, ..StepSeconds::default() };
    let mut warnings = prepared.warnings.clone();
    let (atlas, settings) = &timed(&mut seconds.unwrap, || fitting_atlas(scene, settings, &mut warnings, progress))?;
    warnings.extend(atlas.warnings.iter().cloned());
    warnings.extend(narrow_warning(scene, atlas));

    progress.start(BakeStep::Bvh, 0);
    let geometry = prepared.geometry();
    let tracer = timed(&mut seconds.bvh, || Tracer::new(scene, &geometry));
    let path = path.as_ref().filter(|_| plan.is_on(Effect::SunIntervals));
    let occluders = path.map(|path| occluder_warnings(scene, &geometry, &tracer, path)).unwrap_or_default();
    let has_occluders = !occluders.is_empty();
    warnings.extend(occluders);
    // Before the long part: who sees that something is wrong can stop here.
    warnings.iter().for_each(|warning| progress.warn(warning));
    let (lanes, lane_paths) = path.map(|path| lanes_of(path, settings.lane_count)).unwrap_or_default();
    let track_path = path.filter(|_| plan.is_on(Effect::ShadowTracks));
    let parts = track_path.map(|_| Components::new(scene, &geometry));
    // Tracks ask the exact engine, along the sun's centre. Where that is the bake's own, one serves both.
    let is_shared = settings.engine == EngineChoice::Exact && lanes.len() == 1;
    let track_engine = track_path.zip(parts.as_ref()).map(|(path, parts)| {
        let engine = ExactEngine::new(&tracer, std::slice::from_ref(path));
        if is_shared { engine.noting(parts) } else { engine }
    });
    let shared = track_engine.as_ref().filter(|_| is_shared).map(|engine| engine as &dyn Engine);
    let own = path.filter(|_| shared.is_none());
    let own = own.map(|_| settings.engine.engine(&tracer, &lane_paths, settings.edge_seconds, parts.as_ref()));
    let engine = shared.or(own.as_deref());
    let duration_min = path.map_or(0.0, |p| p.duration_min);
    let finder = track_engine.as_ref().zip(parts.as_ref()).map(|(engine, parts)| OccluderFinder::new(engine, parts));
    let tracks = finder.as_ref().zip(path).map(|(finder, path)| TrackJob {
        finder,
        width_t: path.width_t(0.5),
        choice: settings.tracks,
        slots: 4 * settings.layer_cap,
    });
    let step = BakeStep::Visibility;
    let sun = engine.map(|engine| LightJob { engine, lanes: &lanes, duration_min, step, tracks });
    let lamp_engine = lamp.as_ref().map(|path| lamp_engine(settings.engine, &tracer, path, scene)).transpose()?;
    let lamp = lamp.as_ref().zip(lamp_engine.as_deref()).map(|(path, engine)| {
        let duration_min = path.duration_min();
        LightJob { engine, lanes: &[Lane::CENTRE], duration_min, step: BakeStep::Lamp, tracks: None }
    });
    let normals = ShadingNormals::new(scene);
    let request = settings.ambient.as_ref();
    let engine = |request: &AmbientRequest| AmbientEngine::new(scene, &geometry, &tracer, request.estimate);
    let engine = timed(&mut seconds.bvh, || request.map(engine));
    let ambient = request.zip(engine.as_ref());
    let ambient = ambient.map(|(request, engine)| AmbientJob { engine, request, normals: &normals });
    let lights = Lights { sun, lamp, ambient };
    let mut pages = PageBaker::new(scene, &geometry, &tracer, atlas, settings, lights, progress);
    pages.stats.seconds = seconds;
    let atlases = pages.bake_all(sink)?;
    let occlusion = (!pages.occlusion.is_empty()).then(|| Occlusion { atlas, pages: &pages.occlusion });
    let written = glb::write_glb(scene, &atlas.layouts, occlusion)?;
    let (vertices_glb, vertices) = pages.bake_vertices()?.unzip();
    let needed = layers_needed(&pages, &atlases);
    let walled = [atlases.iter().filter(|page| page.walls.is_some()).count(), atlases.len()];
    let tracked_texels = pages.stats.tracks.map_or(0, |tracks| tracks.texels);
    let mut manifest = finished(pages, prepared, &lights, settings);
    if let Some(ambient) = &mut manifest.ambient {
        ambient.vertices = vertices;
    }
    let manifest = Manifest {
        scene: SceneEntry { sha256: Some(scene::sha256(&written.bytes)), ..manifest.scene },
        atlases,
        instances: instance_entries(scene, atlas, &written),
        effects: plan.clone().after_bake(needed, walled, tracked_texels).entries(),
        ..manifest
    };
    check_cancelled(progress)?;
    warnings.extend(written.not_kept.iter().cloned().map(Warning::NotKept));
    let darkness = || darkness_warning(manifest.stats.dark_texels, manifest.stats.texels);
    warnings.extend(path.filter(|_| !has_occluders).and_then(|_| darkness()));
    warnings.extend(loss_warnings(&manifest, settings));
    let of_ambient = manifest.ambient.as_ref().zip(settings.ambient.as_ref());
    warnings.extend(of_ambient.into_iter().flat_map(|(entry, request)| ambient::warnings(entry, request)));
    Ok(UnpagedBake { manifest, scene_glb: written.bytes, vertices_glb, warnings })
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

/// How many layers texels turned out to need; the larger number of two lights.
fn layers_needed(pages: &PageBaker, atlases: &[AtlasEntry]) -> LayersNeeded {
    let of_sun = atlases.iter().flat_map(|page| &page.lanes).map(|lane| lane.layers.len());
    let of_lamp = atlases.iter().flat_map(|page| &page.lamp).map(|lamp| lamp.layers.len());
    LayersNeeded {
        layers: of_sun.chain(of_lamp).max().unwrap_or(0),
        crowded_texels: pages.sun.crowded_texels.max(pages.lamp.crowded_texels),
        texels: pages.stats.texels,
    }
}

/// The manifest with the statistics and losses of its lights.
fn finished(pages: PageBaker, prepared: &Prepared, lights: &Lights, settings: &BakeSettings) -> Manifest {
    let PageBaker { stats, sun, lamp, atlas, ambient_account, .. } = pages;
    let manifest = manifest_of(prepared, atlas, settings);
    let LightAccount { work, intervals, dark_texels, most_intervals, filled_texels, loss, .. } = sun;
    let lamp = manifest.lamp.zip(lights.lamp).map(|(entry, light)| {
        let (stats, error) = lamp.of_lamp(&light);
        LampEntry { stats, error, ..entry }
    });
    Manifest {
        lamp,
        ambient: settings.ambient.as_ref().map(|request| ambient::entry(request, &ambient_account)),
        stats: Stats {
            rays: work.rays,
            node_tests: work.nodes,
            triangle_tests: work.triangles,
            intervals,
            dark_texels,
            filled_texels,
            most_intervals,
            ..stats
        },
        error: loss.finish(lights.sun.map_or(0.0, |sun| sun.duration_min)),
        ..manifest
    }
}

/// This many lanes across the sun's disc, and the path of each.
fn lanes_of(path: &SunPath, count: usize) -> (Vec<Lane>, Vec<SunPath>) {
    let lanes = Lane::across_disc(count, path.angular_radius_rad);
    let paths = lanes.iter().map(|lane| path.lane(lane.offset_rad)).collect();
    (lanes, paths)
}
