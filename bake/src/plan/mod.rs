//! The effect plan: which effects this scene and request call for, decided before anything runs.
//!
//! `times.rs`, `surfaces.rs` and `ambient.rs` decide and keep the facts they decided by; `wording.rs` puts a decision
//! into sentences; `columns.rs` sets them in columns. What is off costs nothing: no ray, no texture, no loop. One
//! effect is known only afterwards: how many layers texels need. It is on where there may be several, and
//! [`EffectPlan::after_bake`] corrects it.

mod ambient;
mod columns;
mod surfaces;
mod times;
mod wording;

pub use columns::{in_words, labelled};

use crate::disk::manifest::{EffectEntry, SMOOTH_TERMINATOR};
use crate::lamp::LampPath;
use crate::maps::Bits;
use crate::scene::Scene;
use crate::settings::{AmbientRequest, BakeSettings, EngineChoice, TrackChoice};
use crate::sun::SunPath;

/// An effect that a bake may hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effect {
    /// Times at which texels see the sun.
    SunIntervals,
    /// Times at which texels see a lamp that moves through the scene.
    LampIntervals,
    /// A light with a width: shadow edges are soft along its path.
    Penumbra,
    /// Several paths across the sun's disc.
    DiscLanes,
    /// The shade of each occluder by itself, beside lit intervals.
    ShadowTracks,
    /// More than one layer of four intervals.
    SeveralLayers,
    /// Times of 16 bits, not 8.
    SixteenBitTimes,
    /// Minutes that storing lost, texel by texel.
    LossMap,
    /// Alpha-masked surfaces: rays look up alpha.
    AlphaMask,
    /// Surfaces that are lit from both sides.
    DoubleSided,
    /// Light that ends on smooth surfaces where their shading normals say.
    SmoothTerminator,
    /// Walls between neighbouring texels, which filters must not blend across.
    Walls,
    /// Share of the sky that texels see.
    AmbientOcclusion,
    /// Nothing beyond a distance hides the sky.
    AmbientDistance,
    /// The mean direction in which texels see the sky.
    BentNormals,
    /// Sky visibility in spherical harmonics.
    SkyHarmonics,
    /// Ambient visibility of vertices.
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
            Self::ShadowTracks => "shadow-tracks",
            Self::SeveralLayers => "several-layers",
            Self::SixteenBitTimes => "16-bit-times",
            Self::LossMap => "loss-map",
            // Sets are read by this name: the word is older than the variant's.
            Self::AlphaMask => "alpha-cut",
            Self::DoubleSided => "double-sided",
            Self::SmoothTerminator => SMOOTH_TERMINATOR,
            Self::Walls => "walls",
            Self::AmbientOcclusion => "ambient-occlusion",
            Self::AmbientDistance => "ambient-distance",
            Self::BentNormals => "bent-normals",
            Self::SkyHarmonics => "sky-sh2",
            Self::VertexAmbient => "vertex-ambient",
            Self::AmbientNumbers => "ambient-exr",
        }
    }
}

/// Why there is no sun in a bake.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NoSun {
    /// The request asks for no times.
    NotAsked,
    /// A lamp is baked instead.
    LampInstead,
    /// The sun does not rise.
    DoesNotRise,
}

/// What an effect was decided by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Facts {
    /// Times of the sun.
    Sun {
        /// Arcs of the sun's path, or why there is none.
        arcs: Result<usize, NoSun>,
        /// Bits of a stored time.
        bits: Bits,
        /// How lit intervals are found.
        engine: EngineChoice,
    },
    /// Times of a lamp.
    Lamp {
        /// Straight segments of its path, if there is a lamp.
        segments: Option<usize>,
        /// Bits of a stored time.
        bits: Bits,
        /// How lit intervals are found.
        engine: EngineChoice,
    },
    /// Penumbras.
    Widths {
        /// Angular radius of the sun, if there is a sun.
        sun_radius_deg: Option<f64>,
        /// Radius of the lamp, if there is a lamp.
        lamp_radius_m: Option<f64>,
    },
    /// Lanes across the sun's disc.
    Lanes {
        /// How many are asked for.
        count: usize,
        /// Whether the sun has a width, if there is a sun.
        has_width: Option<bool>,
    },
    /// Shadow tracks.
    Tracks {
        /// Where they are asked for.
        choice: TrackChoice,
        /// Whether the sun has a width, if there is a sun.
        has_width: Option<bool>,
        /// Texels with tracks, of how many; known after the bake.
        texels: Option<[u64; 2]>,
    },
    /// Layers of four intervals.
    Layers {
        /// How many are allowed.
        cap: usize,
        /// Whether times are stored.
        has_times: bool,
        /// Bits of a stored time.
        bits: Bits,
        /// How many were needed; known after the bake.
        needed: Option<LayersNeeded>,
    },
    /// Bits of times.
    Depth {
        /// Bits of a stored time.
        bits: Bits,
        /// Half the time between two codes, in seconds; none where no times are stored.
        half_step_s: Option<f64>,
    },
    /// Loss maps.
    Losses {
        /// Whether they are asked for.
        is_asked: bool,
        /// Whether times are stored.
        has_times: bool,
    },
    /// Surfaces of a kind.
    Surfaces {
        /// How many are drawn.
        surfaces: usize,
        /// Number of triangles of these surfaces.
        triangles: usize,
    },
    /// Smooth surfaces.
    Smooth {
        /// Whether light is to end where their normals say.
        is_asked: bool,
        /// Whether times are stored.
        has_times: bool,
        /// How many triangles are facets of something smooth.
        triangles: usize,
    },
    /// Walls between neighbouring texels.
    Walls {
        /// Pages with walls, of how many; known after the bake.
        pages: Option<[usize; 2]>,
    },
    /// Ambient light, if it is asked for.
    Ambient(Option<AmbientRequest>),
}

/// Whether one effect is part of the bake.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Decision {
    /// Which effect.
    pub effect: Effect,
    /// Whether it is part of the bake.
    pub is_on: bool,
    /// What this was decided by.
    pub facts: Facts,
}

/// The decisions on all effects, in the order of [`Effect`].
#[derive(Debug, Clone, PartialEq)]
pub struct EffectPlan {
    /// One per effect.
    pub decisions: Vec<Decision>,
}

/// How many layers texels turned out to need.
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
    /// Decides from the scene, the paths and what is asked for; `no_sun` says why there is no sun's path, where there
    /// is none.
    pub fn new(
        scene: &Scene,
        path: Option<&SunPath>,
        lamp: Option<&LampPath>,
        settings: &BakeSettings,
        no_sun: NoSun,
    ) -> Self {
        let is_asked = settings.bakes_intervals;
        let path = path.filter(|_| is_asked);
        let no_sun = if is_asked { no_sun } else { NoSun::NotAsked };
        let has_times = path.is_some() || lamp.is_some();
        let of_times = times::Times { path, lamp, settings, no_sun }.decisions();
        let of_surfaces = surfaces::decisions(scene, settings.smooth_terminator, has_times);
        let of_ambient = ambient::decisions(settings.ambient);
        Self { decisions: of_times.into_iter().chain(of_surfaces).chain(of_ambient).collect() }
    }

    /// How many lanes the bake has, of as many as were asked for.
    pub fn lane_count(&self, asked: usize) -> usize {
        if self.is_on(Effect::DiscLanes) { asked } else { 1 }
    }

    /// Whether an effect is part of the bake.
    pub fn is_on(&self, effect: Effect) -> bool {
        self.decisions.iter().any(|d| d.effect == effect && d.is_on)
    }

    /// The plan corrected by how many layers texels turned out to need, how many of all pages have walls, and how many
    /// texels have tracks.
    pub fn after_bake(mut self, found: LayersNeeded, walled: [usize; 2], tracked_texels: u64) -> Self {
        for decision in &mut self.decisions {
            match &mut decision.facts {
                Facts::Layers { has_times: true, needed, .. } => {
                    (*needed, decision.is_on) = (Some(found), found.layers > 1);
                }
                Facts::Tracks { texels, .. } if decision.is_on => {
                    (*texels, decision.is_on) = (Some([tracked_texels, found.texels]), tracked_texels > 0);
                }
                Facts::Walls { pages } => (*pages, decision.is_on) = (Some(walled), walled[0] > 0),
                _ => {}
            }
        }
        self
    }

    /// For the manifest.
    pub fn entries(&self) -> Vec<EffectEntry> {
        self.decisions.iter().map(wording::entry).collect()
    }
}
