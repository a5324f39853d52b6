//! The pages of a bake, one after the other, each given to a sink.

use super::baked::PageSink;
use super::error::BakeError;
use super::light::{AmbientAccount, LaneEncoders, LightAccount, LightJob, Lights};
use super::timing::{check_cancelled, timed};
use super::tracks::TrackBaker;
use crate::atlas::{self, Atlas, GutterTexel, PageSamples, WallFinder};
use crate::disk::BakedPage;
use crate::disk::manifest::{AtlasEntry, Stats};
use crate::glb::OcclusionPage;
use crate::loss_map::LossMap;
use crate::maps::{AmbientMaps, GpuTexel, LaneMaps, PageMaps};
use crate::progress::{BakeStep, Progress};
use crate::scene::{Geometry, Scene};
use crate::settings::BakeSettings;
use crate::trace::Tracer;
use crate::tracks::PageTracks;
use crate::visibility::{self, Answers, BuriedPoints, IntervalTable, Intervals, Solved, fill_buried};
use std::time::Instant;

/// The texels of a page.
#[derive(Clone, Copy)]
pub(super) struct PageTexels<'a> {
    /// Those that surfaces cover.
    pub samples: &'a PageSamples,
    /// Their order, tile by tile.
    pub order: &'a [u32],
    /// Those that copy them.
    pub gutter: &'a [GutterTexel],
    /// What stands between them: walls, and borders of charts.
    pub walls: Option<&'a [[u8; 2]]>,
    /// Borders of charts alone.
    pub borders: Option<&'a [[u8; 2]]>,
}

/// Bakes pages, and keeps the statistics.
pub(super) struct PageBaker<'a> {
    pub(super) scene: &'a Scene,
    pub(super) geometry: &'a Geometry,
    walls: WallFinder<'a>,
    buried: BuriedPoints<'a>,
    pub atlas: &'a Atlas,
    pub(super) settings: &'a BakeSettings,
    pub(super) lights: Lights<'a>,
    pub(super) progress: &'a dyn Progress,
    pub stats: Stats,
    pub sun: LightAccount,
    pub lamp: LightAccount,
    pub ambient_account: AmbientAccount,
    /// The viewers' occlusion textures of the pages so far, if ambient light is baked.
    pub occlusion: Vec<OcclusionPage>,
    /// The loss map of the current page, if it was asked for.
    loss_map: Option<LossMap>,
}

impl<'a> PageBaker<'a> {
    pub fn new(
        scene: &'a Scene,
        geometry: &'a Geometry,
        tracer: &'a Tracer,
        atlas: &'a Atlas,
        settings: &'a BakeSettings,
        lights: Lights<'a>,
        progress: &'a dyn Progress,
    ) -> Self {
        let stats = Stats {
            triangles: scene.triangle_count() as u64,
            dropped_triangles: scene.dropped.total(),
            charts: atlas.chart_count as u64,
            engine: lights.sun.map_or("none".into(), |sun| sun.engine.name()),
            threads: rayon::current_num_threads(),
            ..Stats::default()
        };
        let (sun, lamp, ambient_account) =
            (LightAccount::default(), LightAccount::default(), AmbientAccount::default());
        let occlusion = Vec::new();
        Self {
            scene,
            geometry,
            walls: WallFinder::new(scene, geometry, atlas, tracer),
            buried: BuriedPoints { scene, geometry, tracer, texel_m: atlas.texel_widths_m(scene) },
            atlas,
            settings,
            lights,
            progress,
            stats,
            sun,
            lamp,
            ambient_account,
            occlusion,
            loss_map: None,
        }
    }

    /// Bakes every page into `sink`, and says what the manifest should say of each.
    pub fn bake_all(&mut self, sink: &mut dyn PageSink) -> Result<Vec<AtlasEntry>, BakeError> {
        let mut entries = Vec::with_capacity(self.atlas.pages.len());
        for index in 0..self.atlas.pages.len() {
            let page = self.bake(index)?;
            self.progress.start(BakeStep::Write, 0);
            let entry = page.entry(index);
            timed(&mut self.stats.seconds.write, || sink.take(page, &entry))?;
            entries.push(entry);
        }
        Ok(entries)
    }

    fn bake(&mut self, index: usize) -> Result<BakedPage, BakeError> {
        let size = self.atlas.pages[index];
        let started = Instant::now();
        let samples = atlas::sample_page(self.scene, self.geometry, self.atlas, index as u32);
        self.stats.seconds.unwrap += started.elapsed().as_secs_f64();
        self.stats.texels += samples.samples.len() as u64;
        self.stats.page_texels += u64::from(size.width) * u64::from(size.height);
        self.loss_map = self.settings.loss_map.then(|| LossMap::new(size.width, size.height));
        let order = atlas::in_tile_order(&samples, size);
        let padding = self.settings.padding_texels;
        let gutter = timed(&mut self.stats.seconds.unwrap, || {
            atlas::gutter(self.scene, self.geometry, self.atlas, index as u32, &samples, padding)
        });
        let finder = &self.walls;
        let walls = timed(&mut self.stats.seconds.unwrap, || atlas::find_walls(finder, size, &samples, &gutter));
        let beside = |walls| atlas::walls_and_borders(finder, size, &samples, &gutter, walls);
        let (parted, borders) = timed(&mut self.stats.seconds.unwrap, || (beside(walls.as_deref()), beside(None)));
        let texels = PageTexels {
            samples: &samples,
            order: &order,
            gutter: &gutter,
            walls: parted.as_deref(),
            borders: borders.as_deref(),
        };
        let Lights { sun, lamp, .. } = self.lights;
        let mut account = std::mem::take(&mut self.sun);
        let sun = sun.map(|sun| self.bake_light(index, &sun, &mut account, texels)).transpose()?;
        self.sun = account;
        let mut account = std::mem::take(&mut self.lamp);
        let lamp = lamp.map(|lamp| self.bake_light(index, &lamp, &mut account, texels)).transpose()?;
        self.lamp = account;
        check_cancelled(self.progress)?;
        let (lanes, tracks) = sun.unwrap_or_default();
        let lamp = lamp.map(|(lanes, _)| lanes.into_iter().flat_map(|lane| lane.layers).collect());
        let numbers = self.bake_ambient(index, texels)?;
        let request = self.settings.ambient.as_ref();
        let ambient =
            numbers.as_ref().zip(request).map(|(page, request)| AmbientMaps::of(page).rounded_to(request.bits));
        self.occlusion.extend(ambient.as_ref().map(|ambient| OcclusionPage::new(size, ambient)));
        let maps = PageMaps { width: size.width, height: size.height, lanes, lamp, ambient, walls, tracks };
        let ambient_numbers = numbers.filter(|_| request.is_some_and(|request| request.exr));
        Ok(BakedPage { maps, ambient_numbers, loss_map: self.loss_map.take() })
    }

    /// Finds and encodes when the texels of a page see a light.
    fn bake_light(
        &mut self,
        page: usize,
        light: &LightJob,
        account: &mut LightAccount,
        texels: PageTexels,
    ) -> Result<(Vec<LaneMaps>, Option<PageTracks>), BakeError> {
        let solved = self.solve_visibility(light, texels.samples, texels.order).ok_or(BakeError::Cancelled)?;
        account.work = account.work + solved.work;
        Ok(self.encode(page, light, account, texels, &solved))
    }

    /// Lit intervals, in the given order of samples.
    fn solve_visibility(
        &mut self,
        light: &LightJob,
        PageSamples { samples }: &PageSamples,
        order: &[u32],
    ) -> Option<Solved> {
        self.progress.start(light.step, samples.len() as u64);
        let (scene, geometry, progress) = (self.scene, self.geometry, self.progress);
        timed(&mut self.stats.seconds.visibility, || {
            let point = |i: usize| atlas::surface_point(scene, geometry, &samples[order[i] as usize]);
            visibility::solve_visibility(light.engine, samples.len(), point, |count| {
                progress.advance(count as u64);
                !progress.is_cancelled()
            })
        })
    }

    /// The tracks of a page, which take no more bytes than `lanes`.
    fn find_tracks(&mut self, baker: TrackBaker, lanes: &[LaneMaps]) -> Option<PageTracks> {
        let started = Instant::now();
        let layers: usize = lanes.iter().map(|lane| lane.layers.len()).sum();
        let texel = GpuTexel { layers: layers as u32, bits: self.settings.bits.count(), ..GpuTexel::default() };
        let most_bytes = baker.texel_count() * texel.bytes();
        let (tracks, counts) = baker.find(self.scene, self.geometry, most_bytes, self.progress);
        let seconds = started.elapsed().as_secs_f64();
        let stats = self.stats.tracks.get_or_insert_default();
        self.stats.seconds.visibility += seconds;
        stats.seconds += seconds;
        stats.texels += counts.texels;
        stats.crowded_texels += counts.crowded_texels;
        stats.spans += tracks.as_ref().map_or(0, |tracks| tracks.spans.len() as u64);
        stats.gpu_bytes += tracks.as_ref().map_or(0, PageTracks::gpu_bytes);
        tracks
    }

    fn encode(
        &mut self,
        page: usize,
        light: &LightJob,
        account: &mut LightAccount,
        page_texels: PageTexels,
        solved: &Solved,
    ) -> (Vec<LaneMaps>, Option<PageTracks>) {
        let PageTexels { samples, order, gutter, walls, .. } = page_texels;
        let PageSamples { samples: texels } = samples;
        self.progress.start(BakeStep::Encode, texels.len() as u64);
        let started = Instant::now();
        let size = self.atlas.pages[page];
        let mut encoders = LaneEncoders::new(light, size.width as usize * size.height as usize, self.settings);
        let answers = Answers { tables: &solved.tables, lane_count: light.lanes.len() };
        let filled = fill_buried(&self.buried, size, samples, order, walls, answers);
        account.filled_texels += filled.len() as u64;
        let mut track_baker = light.tracks.map(|job| TrackBaker::new(job, size, page_texels, &solved.hiders));
        let mut answers = solved.tables.iter().flat_map(IntervalTable::iter);
        for (place, sample) in order.iter().map(|&i| &texels[i as usize]).enumerate() {
            let own: Vec<Intervals> = answers.by_ref().take(light.lanes.len()).collect();
            let lists = filled.get(&place).unwrap_or(&own);
            if let Some(baker) = &mut track_baker {
                baker.add(&lists[light.lanes.len() / 2], filled.contains_key(&place));
            }
            let loss = encoders.set(sample.texel as usize, lists, account);
            if let Some(map) = &mut self.loss_map {
                map.add(sample.texel as usize, &loss, light.duration_min);
            }
            account.loss.add(loss, [page as u32, sample.texel % size.width, sample.texel / size.width]);
        }
        for copy in gutter {
            encoders.copy(copy.texel as usize, texels[copy.sample as usize].texel as usize);
        }
        self.stats.seconds.encode += started.elapsed().as_secs_f64();
        let lanes = encoders.finish();
        let tracks = track_baker.and_then(|baker| self.find_tracks(baker, &lanes));
        (lanes, tracks)
    }
}
