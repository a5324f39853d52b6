//! The pages of a bake, one after the other, so that only one is in memory.

use super::{BakeError, check_cancelled, timed};
use crate::atlas::{self, Atlas, PageSamples};
use crate::disk::manifest::{AtlasEntry, StageSeconds, Stats};
use crate::disk::write::SetWriter;
use crate::loss::LossTally;
use crate::maps::{Lane, LaneMaps, LayerMaps, PageEncoder, PageMaps};
use crate::progress::{Progress, Stage};
use crate::scene::{Geometry, Scene};
use crate::settings::BakeSettings;
use crate::visibility::{self, Engine, IntervalTable, Work};
use std::time::Instant;

/// Bakes pages, and keeps the account.
pub(super) struct PageBaker<'a> {
    scene: &'a Scene,
    geometry: &'a Geometry,
    atlas: &'a Atlas,
    settings: &'a BakeSettings,
    engine: Option<&'a dyn Engine>,
    progress: &'a dyn Progress,
    pub stats: Stats,
    pub loss: LossTally,
}

impl<'a> PageBaker<'a> {
    pub fn new(
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

    pub fn bake_all(&mut self, writer: &mut SetWriter) -> Result<Vec<AtlasEntry>, BakeError> {
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
                let order = atlas::by_tiles(&samples, size);
                let (tables, work) = self.find_lit(engine, &samples, &order).ok_or(BakeError::Cancelled)?;
                self.stats.rays += work.rays;
                vec![LaneMaps { lane: Lane::CENTRE, layers: self.encode(index, &samples, &order, &tables) }]
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
        samples: &PageSamples,
        order: &[u32],
        tables: &[IntervalTable],
    ) -> Vec<LayerMaps> {
        let PageSamples { samples: texels } = samples;
        self.progress.start(Stage::Encode, texels.len() as u64);
        let started = Instant::now();
        let size = self.atlas.pages[page];
        let texel_count = size.width as usize * size.height as usize;
        let mut encoder = PageEncoder::new(texel_count, self.settings.bits, self.settings.layer_cap);
        let in_order = order.iter().map(|&i| &texels[i as usize]);
        for (sample, lit) in in_order.zip(tables.iter().flat_map(IntervalTable::iter)) {
            let found = lit.as_slice().len() as u64;
            self.stats.intervals += found;
            self.stats.dark_texels += u64::from(found == 0);
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
