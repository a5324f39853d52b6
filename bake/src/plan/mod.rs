//! The effect plan: which effects this scene and request call for, decided before anything runs.
//!
//! Each effect is on or off for a reason, with what it costs and what turns it over; and what is off costs nothing: no
//! ray, no texture, no loop. One effect cannot be known before: how many layers texels need. It is on where they may have
//! several, and [`EffectPlan::settled`] says how it came out.

mod ambient;
mod times;
mod wording;

pub use wording::{in_words, said};

use crate::disk::manifest::EffectEntry;
use crate::lamp::LampPath;
use crate::scene::Scene;
use crate::settings::BakeSettings;
use crate::sun::SunPath;

/// An effect that a bake may hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effect {
    /// Times at which texels see the sun.
    SunIntervals,
    /// Times at which texels see a lamp that moves through the scene.
    LampIntervals,
    /// A light of some width: edges soften as it crosses them.
    Penumbra,
    /// Several paths across the sun's disc.
    DiscLanes,
    /// Room for more than four intervals a texel.
    SeveralLayers,
    /// Times of 16 bits, not 8.
    SixteenBitTimes,
    /// Where storing lost minutes.
    LossMap,
    /// Rays look up alpha.
    AlphaCut,
    /// Surfaces that are lit from both sides.
    DoubleSided,
    /// Share of the sky that texels see.
    AmbientOcclusion,
    /// Nothing beyond a distance hides the sky.
    AmbientDistance,
    /// From where texels see the sky.
    BentNormals,
    /// How a sky of any brightness adds up at texels.
    SkyHarmonics,
    /// Openness of vertices.
    VertexAmbient,
    /// Ambient light as numbers, beside its textures.
    AmbientNumbers,
}

impl Effect {
    /// Its name in the manifest.
    pub fn name(self) -> &'static str {
        match self {
            Self::SunIntervals => "sun-intervals",
            Self::LampIntervals => "lamp-intervals",
            Self::Penumbra => "penumbra",
            Self::DiscLanes => "disc-lanes",
            Self::SeveralLayers => "several-layers",
            Self::SixteenBitTimes => "16-bit-times",
            Self::LossMap => "loss-map",
            Self::AlphaCut => "alpha-cut",
            Self::DoubleSided => "double-sided",
            Self::AmbientOcclusion => "ambient-occlusion",
            Self::AmbientDistance => "ambient-distance",
            Self::BentNormals => "bent-normals",
            Self::SkyHarmonics => "sky-sh2",
            Self::VertexAmbient => "vertex-ambient",
            Self::AmbientNumbers => "ambient-exr",
        }
    }
}

/// One effect's verdict.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Decision {
    /// Which effect.
    pub effect: Effect,
    /// Whether it is part of the bake.
    pub is_on: bool,
    /// Why.
    pub why: String,
    /// What it costs while it is on; of what is off, what it would.
    pub cost: String,
    /// The flag, or the property of the scene, that would turn it over.
    pub toggled_by: String,
}

/// All verdicts, in the order of [`Effect`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EffectPlan {
    /// One per effect.
    pub decisions: Vec<Decision>,
}

/// What texels turned out to need.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LayersNeeded {
    /// Most layers of a lane, or of the lamp, on any page.
    pub layers: usize,
    /// Texels with more than four intervals along a lane, or of the lamp.
    pub crowded_texels: u64,
    /// All texels.
    pub texels: u64,
}

impl EffectPlan {
    /// Decides from the scene, the paths and what is asked for; `no_sun` says why there is no sun's path.
    pub fn new(
        scene: &Scene,
        path: Option<&SunPath>,
        lamp: Option<&LampPath>,
        settings: &BakeSettings,
        no_sun: &str,
    ) -> Self {
        let is_asked = settings.bakes_intervals;
        let path = path.filter(|_| is_asked);
        let no_sun = if is_asked { no_sun } else { times::NOT_ASKED };
        let of_times = times::Times { path, lamp, settings, no_sun }.decisions();
        let decisions = of_times.into_iter().chain(times::of_surfaces(scene)).chain(ambient::decisions(settings));
        Self { decisions: decisions.collect() }
    }

    /// How many lanes the bake has, of as many as were asked for.
    pub fn lane_count(&self, asked: usize) -> usize {
        if self.is_on(Effect::DiscLanes) { asked } else { 1 }
    }

    /// Whether an effect is part of the bake.
    pub fn is_on(&self, effect: Effect) -> bool {
        self.decisions.iter().any(|d| d.effect == effect && d.is_on)
    }

    /// The plan as it came out.
    pub fn settled(mut self, needed: LayersNeeded) -> Self {
        let has_times = self.is_on(Effect::SunIntervals) || self.is_on(Effect::LampIntervals);
        let layers = self.decisions.iter_mut().filter(|d| d.effect == Effect::SeveralLayers && has_times);
        layers.for_each(|decision| times::settle(decision, needed));
        self
    }

    /// For the manifest.
    pub fn entries(&self) -> Vec<EffectEntry> {
        let entry = |d: &Decision| EffectEntry {
            effect: d.effect.name().into(),
            on: d.is_on,
            why: d.why.clone(),
            cost: d.cost.clone(),
            toggled_by: d.toggled_by.clone(),
        };
        self.decisions.iter().map(entry).collect()
    }
}
