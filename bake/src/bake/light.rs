//! The lights of a bake (the sun, a lamp, the sky) and their statistics over all pages.

use super::tracks::TrackJob;
use crate::ambient::{AmbientEngine, Mismatch};
use crate::disk::manifest::{ErrorEntry, LampStats};
use crate::loss::LossStatistics;
use crate::maps::{EncodeLoss, Lane, LaneMaps, PageEncoder};
use crate::progress::BakeStep;
use crate::scene::ShadingNormals;
use crate::settings::{AmbientRequest, BakeSettings};
use crate::visibility::{Engine, Intervals, Work};

/// What a bake is lit by.
#[derive(Clone, Copy)]
pub(super) struct Lights<'a> {
    /// None where the sun does not rise, or is not asked for.
    pub sun: Option<LightJob<'a>>,
    /// A lamp that moves through the scene.
    pub lamp: Option<LightJob<'a>>,
    /// Ambient light.
    pub ambient: Option<AmbientJob<'a>>,
}

/// How ambient light is found.
#[derive(Clone, Copy)]
pub(super) struct AmbientJob<'a> {
    pub engine: &'a AmbientEngine<'a>,
    pub request: &'a AmbientRequest,
    pub normals: &'a ShadingNormals,
}

/// Statistics of ambient light so far, over all pages.
#[derive(Debug, Default)]
pub(super) struct AmbientAccount {
    pub rays: u64,
    pub buried_texels: u64,
    pub unconverged_texels: u64,
    /// Points along the edge of a texel, where pages were too large for as many as were asked for.
    pub supersample: Option<u32>,
    /// Of each page and side, before and after its seams were stitched.
    pub seams: Vec<[Mismatch; 2]>,
}

/// How the times of a light are found.
#[derive(Clone, Copy)]
pub(super) struct LightJob<'a> {
    /// Finds the lit intervals along every lane.
    pub engine: &'a dyn Engine,
    /// The lanes across the disc; one for a lamp.
    pub lanes: &'a [Lane],
    /// Minutes of the path.
    pub duration_min: f64,
    /// The step that is reported while its intervals are found.
    pub step: BakeStep,
    /// How its shadow tracks are found, if they are.
    pub tracks: Option<TrackJob<'a>>,
}

/// Statistics of the sun or a lamp so far, over all pages.
#[derive(Default)]
pub(super) struct LightAccount {
    pub work: Work,
    pub intervals: u64,
    pub dark_texels: u64,
    pub most_intervals: u64,
    /// Buried texels that show what their neighbours agree on.
    pub filled_texels: u64,
    /// Texels that one layer does not hold, along some lane.
    pub crowded_texels: u64,
    pub loss: LossStatistics,
}

/// The encoders of a page, one a lane.
pub(super) struct LaneEncoders(Vec<(Lane, PageEncoder)>);

impl LaneEncoders {
    pub fn new(light: &LightJob, texel_count: usize, settings: &BakeSettings) -> Self {
        let encoder = |&lane| (lane, PageEncoder::new(texel_count, settings.bits, settings.layer_cap));
        Self(light.lanes.iter().map(encoder).collect())
    }

    /// Stores a texel's answers, one a lane; its loss is the lanes' mean by weight.
    pub fn set(&mut self, texel: usize, answers: &[Intervals], account: &mut LightAccount) -> EncodeLoss {
        let mut loss = EncodeLoss::default();
        let (mut found, mut most) = (0, 0);
        for ((lane, encoder), lit) in self.0.iter_mut().zip(answers) {
            let count = lit.as_slice().len() as u64;
            found += count;
            most = most.max(count);
            loss.add_lane(&encoder.set(texel, lit), lane.weight);
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

impl LightAccount {
    /// What the manifest says of a lamp.
    pub fn of_lamp(self, light: &LightJob) -> (LampStats, ErrorEntry) {
        let Self { work, intervals, dark_texels, most_intervals, loss, .. } = self;
        let stats = LampStats { engine: light.engine.name(), rays: work.rays, intervals, dark_texels, most_intervals };
        (stats, loss.finish(light.duration_min))
    }
}
