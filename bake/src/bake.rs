//! A bake from end to end: the flow of the crate, one stage after the other.

use crate::atlas::{self, Atlas, AtlasError, AtlasSettings, PageSamples};
use crate::disk::manifest::{self, ArcEntry, InstanceEntry, Manifest, PathEntry, StageSeconds, Stats};
use crate::disk::write::{SCENE_FILE, SetWriter, WriteError};
use crate::glb::{self, GlbTooLarge};
use crate::loss::LossTally;
use crate::maps::{Lane, LaneMaps, LayerMaps, PageEncoder, PageMaps};
use crate::plan::{Effect, EffectPlan};
use crate::progress::{Progress, Stage};
use crate::scene::{self, Alpha, Geometry, LoadError, LoadLimits, Scene};
use crate::settings::{BakeSettings, EngineChoice, SunRequest};
use crate::sun::{self, DayError, DayOutcome, KeyedError, LightError, SunPath};
use crate::trace::Tracer;
use crate::visibility::{self, Engine, IntervalTable, RayEngine, Work};
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
    /// The scene's light makes no path.
    #[error(transparent)]
    Light(#[from] LightError),
    /// The scene cannot be laid out.
    #[error("{0}; give another --size, --padding or --texels-per-metre")]
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
    #[error(
        "{what} needs about {needed_mib} MiB of memory and {allowed_mib} MiB are allowed: \
         give a smaller {smaller}, or a larger --max-memory"
    )]
    Memory {
        /// What needs it.
        what: String,
        /// The flag that makes it need less.
        smaller: &'static str,
        /// How much, in MiB.
        needed_mib: u64,
        /// How much is allowed, in MiB.
        allowed_mib: u64,
    },
    /// The threads cannot be started.
    #[error("cannot start {threads} threads: {reason}; give a smaller --threads")]
    Threads {
        /// How many were asked for.
        threads: usize,
        /// What the system says.
        reason: String,
    },
}

impl From<AtlasError> for BakeError {
    fn from(error: AtlasError) -> Self {
        match error {
            AtlasError::Cancelled => Self::Cancelled,
            AtlasError::TooDense { density_per_metre, texels, most } => Self::Memory {
                what: format!("a density of {density_per_metre} texels a metre (about {texels} texels)"),
                smaller: "--texels-per-metre",
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
    /// What a user should know: one sentence each.
    pub warnings: Vec<String>,
}

/// A scene read and its plan made: what `--explain` shows, before anything is spent.
#[derive(Debug)]
pub struct Prepared {
    /// The scene.
    pub scene: Scene,
    /// The sun's path, if it rises.
    pub path: Option<SunPath>,
    /// What will be baked and why.
    pub plan: EffectPlan,
    /// What a user should know.
    pub warnings: Vec<String>,
    load_seconds: f64,
}

/// Reads the scene and decides what to bake.
pub fn prepare(scene_file: &Path, settings: &BakeSettings, progress: &dyn Progress) -> Result<Prepared, BakeError> {
    progress.start(Stage::Load, 0);
    let started = Instant::now();
    let limits = LoadLimits { max_memory_bytes: settings.max_memory_bytes };
    let scene = scene::load(scene_file, &limits)?;
    let mut warnings = scene.warnings.clone();
    let path = sun_path(settings, &scene, &mut warnings)?;
    let plan = EffectPlan::new(&scene, path.as_ref(), "the sun does not rise");
    Ok(Prepared { scene, path, plan, warnings, load_seconds: started.elapsed().as_secs_f64() })
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
    let writer = SetWriter::begin(target, force)?;
    in_pool(settings.threads, || {
        let prepared = prepare(scene_file, settings, progress)?;
        bake_prepared(&prepared, writer, settings, progress)
    })?
}

fn in_pool<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> Result<T, BakeError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    Ok(pool.map_err(|e| BakeError::Threads { threads, reason: e.to_string() })?.install(work))
}

fn bake_prepared(
    prepared: &Prepared,
    mut writer: SetWriter,
    settings: &BakeSettings,
    progress: &dyn Progress,
) -> Result<BakeReport, BakeError> {
    let Prepared { scene, path, plan, .. } = prepared;
    check_memory(scene, settings, settings.page_size_texels)?;
    check_cancelled(progress)?;
    let mut seconds = StageSeconds { load: prepared.load_seconds, ..StageSeconds::default() };
    let mut warnings = prepared.warnings.clone();
    let (atlas, settings) = &timed(&mut seconds.unwrap, || unwrap_somehow(scene, settings, &mut warnings, progress))?;

    progress.start(Stage::Bvh, 0);
    let geometry = Geometry::new(scene);
    let tracer = timed(&mut seconds.bvh, || Tracer::new(scene, &geometry));
    let engine = path.as_ref().filter(|_| plan.is_on(Effect::SunIntervals)).map(|path| match settings.engine {
        EngineChoice::Rays(count) => RayEngine::new(&tracer, path, count),
    });

    let engine = engine.as_ref().map(|e| e as &dyn Engine);
    let mut pages = PageBaker::new(scene, &geometry, atlas, settings, engine, progress, seconds);
    let atlases = pages.bake_all(&mut writer)?;
    let written = glb::write_glb(scene, &atlas.layouts)?;
    timed(&mut pages.stats.seconds.write, || writer.write_scene(&written.bytes))?;

    let PageBaker { mut stats, loss, .. } = pages;
    stats.bytes = writer.bytes();
    let duration_min = path.as_ref().map_or(0.0, |p| p.duration_min);
    let manifest = Manifest {
        stats,
        atlases,
        instances: instance_entries(scene, atlas, &written.places),
        error: loss.finish(duration_min),
        ..manifest_of(prepared, atlas, settings)
    };
    check_cancelled(progress)?;
    writer.finish(&manifest)?;
    warnings.extend(atlas.warnings.iter().cloned());
    warnings.extend(loss_warning(&manifest, settings));
    Ok(BakeReport { manifest, warnings })
}

/// What the manifest says of the request; the rest is left empty.
fn manifest_of(prepared: &Prepared, atlas: &Atlas, settings: &BakeSettings) -> Manifest {
    let Prepared { scene, path, plan, .. } = prepared;
    Manifest {
        format: manifest::FORMAT.into(),
        version: manifest::VERSION,
        generator: concat!("sunbake ", env!("CARGO_PKG_VERSION")).into(),
        source: manifest::SourceEntry { file: scene.source.file_name.clone(), sha256: scene.source.sha256.clone() },
        scene: manifest::SceneEntry {
            file: SCENE_FILE.into(),
            centre_m: scene.centre_m.to_array(),
            texels_per_metre: atlas.texels_per_metre,
        },
        path: path.as_ref().map(path_entry),
        bits: settings.bits.count(),
        atlases: Vec::new(),
        instances: Vec::new(),
        effects: plan.entries(),
        stats: Stats::default(),
        error: manifest::ErrorEntry::default(),
    }
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

fn sun_path(settings: &BakeSettings, scene: &Scene, warnings: &mut Vec<String>) -> Result<Option<SunPath>, BakeError> {
    let request = match (&settings.sun, scene.sun_direction) {
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
            warnings.push(format!(
                "the sun does not rise at latitude {} on {}: its centre stays at least {:.1} degrees below the horizon, so no \
                 sun is baked; choose another --date for one",
                request.latitude_deg, request.date, -highest_elevation_deg
            ));
            Ok(None)
        }
    }
}

/// Unwraps as asked, or, where a mesh has too many charts for a page, with less around each, or on larger pages. Gives the
/// settings that it came to.
fn unwrap_somehow(
    scene: &Scene,
    asked: &BakeSettings,
    warnings: &mut Vec<String>,
    progress: &dyn Progress,
) -> Result<(Atlas, BakeSettings), BakeError> {
    let mut settings = asked.clone();
    loop {
        let error = match unwrap(scene, &settings, progress) {
            Ok(atlas) => {
                if settings != *asked {
                    warnings.push(settled_for(&settings, asked));
                }
                return Ok((atlas, settings));
            }
            Err(error @ AtlasError::PageTooSmall { .. }) => error,
            Err(error) => return Err(error.into()),
        };
        if settings.padding_texels > 1 {
            settings.padding_texels = 1;
        } else {
            settings.padding_texels = asked.padding_texels;
            settings.page_size_texels *= 2;
        }
        let is_possible = settings.page_size_texels <= LARGEST_PAGE_TEXELS;
        if !is_possible || check_memory(scene, &settings, settings.page_size_texels).is_err() {
            return Err(error.into());
        }
    }
}

/// Largest page that is tried.
const LARGEST_PAGE_TEXELS: u32 = 16_384;

/// What the user asked for and did not get, with the flag that spares the search.
fn settled_for(settings: &BakeSettings, asked: &BakeSettings) -> String {
    let [padding, edge] = [settings.padding_texels, settings.page_size_texels];
    let had = format!("a mesh has too many charts for a page of {} texels", asked.page_size_texels);
    if edge == asked.page_size_texels {
        return format!("{had} with --padding {}: it was baked with --padding {padding}", asked.padding_texels);
    }
    format!("{had}: it was baked on pages of {edge}; give --size {edge} or more, or simplify the mesh")
}

fn unwrap(scene: &Scene, settings: &BakeSettings, progress: &dyn Progress) -> Result<Atlas, AtlasError> {
    progress.start(Stage::Unwrap, 1000);
    let told = std::sync::atomic::AtomicU64::new(0);
    let atlas_settings = AtlasSettings {
        density: settings.density,
        page_size_texels: settings.page_size_texels,
        padding_texels: settings.padding_texels,
        most_texels: settings.max_memory_bytes / BYTES_PER_SAMPLE,
        ..AtlasSettings::default()
    };
    atlas::build(scene, &atlas_settings, &|share| {
        let now = (share * 1000.0) as u64;
        let before = told.fetch_max(now, std::sync::atomic::Ordering::Relaxed);
        progress.advance(now.saturating_sub(before));
        !progress.is_cancelled()
    })
}

/// Bytes a covered texel takes while its page is baked: its sample, its intervals (three, as a town has on average, and
/// the vectors around them) and its share of the loss tally.
const BYTES_PER_SAMPLE: u64 = 100;
/// Bytes a triangle takes: corners in bake space and in the hierarchy, its box, nodes while building, layout and writing.
const BYTES_PER_TRIANGLE: u64 = 600;

fn check_memory(scene: &Scene, settings: &BakeSettings, page_size_texels: u32) -> Result<(), BakeError> {
    let texels = u64::from(page_size_texels).pow(2);
    // Codes are held twice while they are written; two layers are what a scene usually needs.
    let codes = texels * 16 * settings.layer_cap.min(2) as u64 * 2;
    let triangles = scene.triangle_count() as u64 * BYTES_PER_TRIANGLE;
    let needed = codes + texels * BYTES_PER_SAMPLE + triangles;
    if needed <= settings.max_memory_bytes {
        return Ok(());
    }
    Err(BakeError::Memory {
        what: format!("a page of {page_size_texels} x {page_size_texels} texels"),
        smaller: "--size",
        needed_mib: needed >> 20,
        allowed_mib: settings.max_memory_bytes >> 20,
    })
}

/// Bakes pages, one after the other, so that only one is in memory.
struct PageBaker<'a> {
    scene: &'a Scene,
    geometry: &'a Geometry,
    atlas: &'a Atlas,
    settings: &'a BakeSettings,
    engine: Option<&'a dyn Engine>,
    progress: &'a dyn Progress,
    stats: Stats,
    loss: LossTally,
}

impl<'a> PageBaker<'a> {
    fn new(
        scene: &'a Scene,
        geometry: &'a Geometry,
        atlas: &'a Atlas,
        settings: &'a BakeSettings,
        engine: Option<&'a dyn Engine>,
        progress: &'a dyn Progress,
        seconds: StageSeconds,
    ) -> Self {
        let stats = Stats {
            triangles: scene.triangle_count() as u64,
            dropped_triangles: scene.dropped.total(),
            charts: atlas.chart_count as u64,
            engine: engine.map_or("none".into(), Engine::name),
            threads: rayon::current_num_threads(),
            seconds,
            ..Stats::default()
        };
        Self { scene, geometry, atlas, settings, engine, progress, stats, loss: LossTally::default() }
    }

    fn bake_all(&mut self, writer: &mut SetWriter) -> Result<Vec<manifest::AtlasEntry>, BakeError> {
        let mut entries = Vec::with_capacity(self.atlas.pages.len());
        for index in 0..self.atlas.pages.len() {
            let maps = self.bake(index)?;
            self.progress.start(Stage::Write, 0);
            let write = || writer.write_page(index, &maps, self.settings.bits);
            entries.push(timed(&mut self.stats.seconds.write, write)?);
        }
        Ok(entries)
    }

    fn bake(&mut self, index: usize) -> Result<PageMaps, BakeError> {
        let size = self.atlas.pages[index];
        let started = Instant::now();
        let samples = atlas::sample_page(self.scene, self.geometry, self.atlas, index as u32);
        self.stats.seconds.unwrap += started.elapsed().as_secs_f64();
        self.stats.texels += samples.samples.len() as u64;
        self.stats.page_texels += u64::from(size.width) * u64::from(size.height);
        let lanes = match self.engine {
            None => Vec::new(),
            Some(engine) => {
                let (tables, work) = self.find_lit(engine, &samples.samples).ok_or(BakeError::Cancelled)?;
                self.stats.rays += work.rays;
                vec![LaneMaps { lane: Lane::CENTRE, layers: self.encode(index, &samples, &tables) }]
            }
        };
        check_cancelled(self.progress)?;
        Ok(PageMaps { width: size.width, height: size.height, lanes, ao: None })
    }

    fn find_lit(&mut self, engine: &dyn Engine, samples: &[atlas::Sample]) -> Option<(Vec<IntervalTable>, Work)> {
        self.progress.start(Stage::Visibility, samples.len() as u64);
        let (scene, geometry, progress) = (self.scene, self.geometry, self.progress);
        timed(&mut self.stats.seconds.visibility, || {
            let point = |i: usize| atlas::surface_point(scene, geometry, &samples[i]);
            visibility::find_lit(engine, samples.len(), point, |count| {
                progress.advance(count as u64);
                !progress.is_cancelled()
            })
        })
    }

    fn encode(&mut self, page: usize, samples: &PageSamples, tables: &[IntervalTable]) -> Vec<LayerMaps> {
        let PageSamples { samples: texels } = samples;
        self.progress.start(Stage::Encode, texels.len() as u64);
        let started = Instant::now();
        let size = self.atlas.pages[page];
        let texel_count = size.width as usize * size.height as usize;
        let mut encoder = PageEncoder::new(texel_count, self.settings.bits, self.settings.layer_cap);
        for (sample, lit) in texels.iter().zip(tables.iter().flat_map(IntervalTable::iter)) {
            let found = lit.as_slice().len() as u64;
            self.stats.intervals += found;
            self.stats.most_intervals = self.stats.most_intervals.max(found);
            let loss = encoder.set(sample.texel as usize, &lit);
            self.loss.add(loss, [page as u32, sample.texel % size.width, sample.texel / size.width]);
        }
        for copy in atlas::gutter(size, samples, self.settings.padding_texels) {
            encoder.copy(copy.texel as usize, texels[copy.sample as usize].texel as usize);
        }
        self.stats.seconds.encode += started.elapsed().as_secs_f64();
        encoder.finish()
    }
}

fn path_entry(path: &SunPath) -> PathEntry {
    let day = path.day.as_ref();
    let both = |text: &dyn Fn(f64) -> Option<String>| Some([text(0.0)?, text(1.0)?]);
    PathEntry {
        place: day.map(|d| manifest::Place { latitude_deg: d.latitude_deg, longitude_deg: d.longitude_deg }),
        date: day.map(|d| d.date.clone()),
        utc_offset_h: day.map(|d| d.utc_offset_h),
        north_deg: day.map(|d| d.north_deg),
        local: both(&|t| path.local_text(t)),
        utc: both(&|t| path.utc_text(t).map(|text| text + "Z")),
        start_min: day.map(|d| d.start_min),
        duration_min: path.duration_min,
        angular_radius_deg: path.angular_radius_rad.to_degrees(),
        ephemeris_error_deg: day.map(|d| d.ephemeris_error_deg),
        arcs: path.arcs().iter().map(arc_entry).collect(),
    }
}

fn arc_entry(arc: &sun::SunArc) -> ArcEntry {
    ArcEntry {
        axis: arc.axis.to_array(),
        zero: arc.zero.to_array(),
        declination_deg: arc.declination_rad.to_degrees(),
        hour_angle_deg: arc.hour_angle_rad.map(f64::to_degrees),
        t: arc.t,
    }
}

fn instance_entries(scene: &Scene, atlas: &Atlas, written: &[(usize, usize)]) -> Vec<InstanceEntry> {
    let entry = |(index, &(node, primitive)): (usize, &(usize, usize))| {
        let placement = &atlas.placements[index];
        let material = scene.material(index);
        InstanceEntry {
            node,
            primitive,
            atlas: (material.alpha != Alpha::Air).then_some(placement.page),
            uv_set: 1,
            uv_scale: placement.scale.to_array(),
            uv_offset: placement.offset.to_array(),
            double_sided: material.is_double_sided,
        }
    };
    written.iter().enumerate().map(entry).collect()
}

/// Most layers that may be asked for.
const MOST_LAYERS: u64 = 16;

/// Advice where slots ran out, in words that know the flag already given.
fn loss_warning(manifest: &Manifest, settings: &BakeSettings) -> Option<String> {
    let merge = &manifest.error.merge_min;
    let needed = manifest.stats.most_intervals.div_ceil(4);
    let advice = match needed {
        ..=MOST_LAYERS => format!("--layers {needed} keeps them all"),
        _ if settings.layer_cap as u64 >= MOST_LAYERS => "that is as many as there are".into(),
        _ => format!("--layers {MOST_LAYERS} keeps more of them"),
    };
    (manifest.error.merged_texels > 0).then(|| {
        format!(
            "{} texels have more intervals than --layers {} holds: the worst is wrong for {:.1} minutes of the day; {advice}",
            manifest.error.merged_texels, settings.layer_cap, merge.worst
        )
    })
}
