//! The pages of a bake, one after the other, so that only one is in memory.

use super::{BakeError, check_cancelled, timed};
use crate::atlas::{self, Atlas, PageSamples};
use crate::disk::manifest::{AtlasEntry, StageSeconds, Stats};
use crate::disk::write::SetWriter;
use crate::loss::LossTally;
use crate::loss_map::LossMap;
use crate::maps::{EncodeLoss, Lane, LaneMaps, PageEncoder, PageMaps};
use crate::progress::{Progress, Stage};
use crate::scene::{Geometry, Scene};
use crate::settings::BakeSettings;
use crate::visibility::{self, Engine, IntervalTable, Intervals, Work};
use std::time::Instant;

/// Who answers when texels see the sun.
#[derive(Clone, Copy)]
pub(super) struct Sun<'a> {
    /// Answers for as many lanes as there are.
    pub engine: &'a dyn Engine,
    /// The lanes across the disc.
    pub lanes: &'a [Lane],
    /// Minutes of the path.
    pub duration_min: f64,
}

/// Bakes pages, and keeps the account.
pub(super) struct PageBaker<'a> {
    scene: &'a Scene,
    geometry: &'a Geometry,
    atlas: &'a Atlas,
    settings: &'a BakeSettings,
    sun: Option<Sun<'a>>,
    progress: &'a dyn Progress,
    pub stats: Stats,
    pub loss: LossTally,
    /// Of the page at hand, if it was asked for.
    loss_map: Option<LossMap>,
}

impl<'a> PageBaker<'a> {
    pub fn new(
        scene: &'a Scene,
        geometry: &'a Geometry,
        atlas: &'a Atlas,
        settings: &'a BakeSettings,
        sun: Option<Sun<'a>>,
        progress: &'a dyn Progress,
        seconds: StageSeconds,
    ) -> Self {
        let stats = Stats {
            triangles: scene.triangle_count() as u64,
            dropped_triangles: scene.dropped.total(),
            charts: atlas.chart_count as u64,
            engine: sun.map_or("none".into(), |sun| sun.engine.name()),
            threads: rayon::current_num_threads(),
            seconds,
            ..Stats::default()
        };
        Self { scene, geometry, atlas, settings, sun, progress, stats, loss: LossTally::default(), loss_map: None }
    }

    pub fn bake_all(&mut self, writer: &mut SetWriter) -> Result<Vec<AtlasEntry>, BakeError> {
        let mut entries = Vec::with_capacity(self.atlas.pages.len());
        for index in 0..self.atlas.pages.len() {
            let maps = self.bake(index)?;
            self.progress.start(Stage::Write, 0);
            let loss_map = self.loss_map.take();
            let write = || {
                let entry = writer.write_page(index, &maps, self.settings.bits)?;
                let loss_map = loss_map.map(|map| writer.write_loss_map(index, &map)).transpose()?;
                Ok::<_, BakeError>(AtlasEntry { loss_map, ..entry })
            };
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
        let lanes = match self.sun {
            None => Vec::new(),
            Some(sun) => {
                let order = atlas::by_tiles(&samples, size);
                let (tables, work) = self.find_lit(sun.engine, &samples, &order).ok_or(BakeError::Cancelled)?;
                self.stats.rays += work.rays;
                self.stats.node_tests += work.nodes;
                self.stats.triangle_tests += work.triangles;
                self.encode(index, sun, &samples, &order, &tables)
            }
        };
        check_cancelled(self.progress)?;
        Ok(PageMaps { width: size.width, height: size.height, lanes, ao: None })
    }

    /// Answers in the given order of samples.
    fn find_lit(
        &mut self,
        engine: &dyn Engine,
        PageSamples { samples }: &PageSamples,
        order: &[u32],
    ) -> Option<(Vec<IntervalTable>, Work)> {
        self.progress.start(Stage::Visibility, samples.len() as u64);
        let (scene, geometry, progress) = (self.scene, self.geometry, self.progress);
        timed(&mut self.stats.seconds.visibility, || {
            let point = |i: usize| atlas::surface_point(scene, geometry, &samples[order[i] as usize]);
            visibility::find_lit(engine, samples.len(), point, |count| {
                progress.advance(count as u64);
                !progress.is_cancelled()
            })
        })
    }

    fn encode(
        &mut self,
        page: usize,
        sun: Sun,
        samples: &PageSamples,
        order: &[u32],
        tables: &[IntervalTable],
    ) -> Vec<LaneMaps> {
        let PageSamples { samples: texels } = samples;
        self.progress.start(Stage::Encode, texels.len() as u64);
        let started = Instant::now();
        let size = self.atlas.pages[page];
        let texel_count = size.width as usize * size.height as usize;
        let encoder = |&lane| (lane, PageEncoder::new(texel_count, self.settings.bits, self.settings.layer_cap));
        let mut encoders: Vec<(Lane, PageEncoder)> = sun.lanes.iter().map(encoder).collect();
        self.loss_map = self.settings.loss_map.then(|| LossMap::new(size.width, size.height));
        let mut answers = tables.iter().flat_map(IntervalTable::iter);
        for sample in order.iter().map(|&i| &texels[i as usize]) {
            let loss = self.encode_texel(&mut encoders, sample.texel as usize, &mut answers);
            if let Some(map) = &mut self.loss_map {
                map.set(sample.texel as usize, &loss, sun.duration_min);
            }
            self.loss.add(loss, [page as u32, sample.texel % size.width, sample.texel / size.width]);
        }
        for copy in atlas::gutter(size, samples, self.settings.padding_texels) {
            let source = texels[copy.sample as usize].texel as usize;
            encoders.iter_mut().for_each(|(_, encoder)| encoder.copy(copy.texel as usize, source));
        }
        self.stats.seconds.encode += started.elapsed().as_secs_f64();
        encoders.into_iter().map(|(lane, encoder)| LaneMaps { lane, layers: encoder.finish() }).collect()
    }

    /// Stores a texel's answers, one a lane; its loss is the lanes' mean by weight.
    fn encode_texel(
        &mut self,
        encoders: &mut [(Lane, PageEncoder)],
        texel: usize,
        answers: &mut impl Iterator<Item = Intervals>,
    ) -> EncodeLoss {
        let mut loss = EncodeLoss::default();
        let mut found = 0;
        for ((lane, encoder), lit) in encoders.iter_mut().zip(answers) {
            let count = lit.as_slice().len() as u64;
            found += count;
            self.stats.most_intervals = self.stats.most_intervals.max(count);
            loss.add_lane(&encoder.set(texel, &lit), lane.weight);
        }
        self.stats.intervals += found;
        self.stats.dark_texels += u64::from(found == 0);
        loss
    }
}
