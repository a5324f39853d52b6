//! A light of a bake, the sun or a lamp, and the account of what came of it.

use crate::disk::manifest::{ErrorEntry, LampStats};
use crate::loss::LossTally;
use crate::maps::{EncodeLoss, Lane, LaneMaps, PageEncoder};
use crate::progress::BakeStage;
use crate::settings::BakeSettings;
use crate::visibility::{Engine, Intervals, Work};

/// Who answers when texels see a light.
#[derive(Clone, Copy)]
pub(super) struct LightJob<'a> {
    /// Answers for as many lanes as there are.
    pub engine: &'a dyn Engine,
    /// The lanes across the disc; one for a lamp.
    pub lanes: &'a [Lane],
    /// Minutes of the path.
    pub duration_min: f64,
    /// What to tell a listener while its intervals are found.
    pub stage: BakeStage,
}

/// What came of a light so far, over all pages.
#[derive(Default)]
pub(super) struct Account {
    pub work: Work,
    pub intervals: u64,
    pub dark_texels: u64,
    pub most_intervals: u64,
    /// Texels that one layer does not hold, along some lane.
    pub crowded_texels: u64,
    pub loss: LossTally,
}

/// The encoders of a page, one a lane.
pub(super) struct LaneEncoders(Vec<(Lane, PageEncoder)>);

impl LaneEncoders {
    pub fn new(light: &LightJob, texel_count: usize, settings: &BakeSettings) -> Self {
        let encoder = |&lane| (lane, PageEncoder::new(texel_count, settings.bits, settings.layer_cap));
        Self(light.lanes.iter().map(encoder).collect())
    }

    /// Stores a texel's answers, one a lane; its loss is the lanes' mean by weight.
    pub fn set(
        &mut self,
        texel: usize,
        answers: &mut impl Iterator<Item = Intervals>,
        account: &mut Account,
    ) -> EncodeLoss {
        let mut loss = EncodeLoss::default();
        let (mut found, mut most) = (0, 0);
        for ((lane, encoder), lit) in self.0.iter_mut().zip(answers) {
            let count = lit.as_slice().len() as u64;
            found += count;
            most = most.max(count);
            loss.add_lane(&encoder.set(texel, &lit), lane.weight);
        }
        account.intervals += found;
        account.most_intervals = account.most_intervals.max(most);
        account.crowded_texels += u64::from(most > 4);
        account.dark_texels += u64::from(found == 0);
        loss
    }

    /// Gives `texel` the codes of `source`: a gutter.
    pub fn copy(&mut self, texel: usize, source: usize) {
        self.0.iter_mut().for_each(|(_, encoder)| encoder.copy(texel, source));
    }

    pub fn finish(self) -> Vec<LaneMaps> {
        self.0.into_iter().map(|(lane, encoder)| LaneMaps { lane, layers: encoder.finish() }).collect()
    }
}

impl Account {
    /// What the manifest says of a lamp.
    pub fn of_lamp(self, light: &LightJob) -> (LampStats, ErrorEntry) {
        let Self { work, intervals, dark_texels, most_intervals, loss, .. } = self;
        let stats = LampStats { engine: light.engine.name(), rays: work.rays, intervals, dark_texels, most_intervals };
        (stats, loss.finish(light.duration_min))
    }
}
