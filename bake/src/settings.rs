//! The settings of a bake. Presets fill every field.

use crate::ambient::AmbientSettings;
use crate::atlas::Density;
use crate::lamp::LampPath;
use crate::maps::Bits;
use crate::scene::{Components, ObjectWishes};
use crate::sun::{DayRequest, SunPath};
use crate::trace::Tracer;
use crate::visibility::{BisectEngine, Engine, ExactEngine, LampEngine, LampRays, RayEngine};

/// Everything that decides the result of a bake, and its cost.
#[derive(Debug, Clone, PartialEq)]
pub struct BakeSettings {
    /// Which sun.
    pub sun: SunRequest,
    /// A lamp beside the sun: the text of its path file, see [`crate::lamp::parse_lamp`]. Takes a light's time and
    /// bytes.
    pub lamp: Option<String>,
    /// What is asked for objects by name; usually nothing.
    pub objects: ObjectWishes,
    /// Density of texels. Time and bytes grow with the number of texels, so with its square.
    pub density: Density,
    /// Edge of a square page, 64 to 16384. Larger pages pack better; some hardware stops at 8192.
    pub page_size_texels: u32,
    /// Width in texels of the gutter around every chart, which repeats the chart's border, 1 to 16. A four-texel filter
    /// needs 1; each mip level below needs twice as many as the one above.
    pub padding_texels: u32,
    /// Bits of a stored time. 8 bits store edges to within 1.7 minutes of a summer day, 16 bits to within 0.4 seconds,
    /// at twice the bytes.
    pub bits: Bits,
    /// Most layers of four intervals, 1 to 16. A texel with more intervals keeps the list that is wrong for the
    /// shortest time. Layers that no texel needs are not written.
    pub layer_cap: usize,
    /// Lanes across the sun's disc: 1 (as in *GPU Gems* chapter 13), 3 or 5. With one lane, edges along the sun's path
    /// are hard; with more they soften in as many steps. Maps, and the reads of playback, grow with the number. A light
    /// without width always has one lane.
    pub lane_count: usize,
    /// Whether light ends on smooth surfaces of few faces where their shading normals say, and not face by face
    /// ([`crate::scene::SmoothPoint`]). Off, light ends where faces do: for scenes whose normals are not to be trusted.
    /// Flat faces are baked alike either way. On, texels of smooth surfaces take a short ray and a second query.
    pub smooth_terminator: bool,
    /// Whether times of the sun and the lamp are baked.
    pub bakes_intervals: bool,
    /// Where shadow tracks are found beside the times of the sun's centre ([`crate::tracks`]). Takes about half
    /// the time of the intervals on top, and bytes where shadows are dense. A light without width has none.
    pub tracks: TrackChoice,
    /// Ambient light, if it is baked.
    pub ambient: Option<AmbientRequest>,
    /// How lit intervals are found.
    pub engine: EngineChoice,
    /// Whether to write, for each page, how many minutes each texel lost by storing. Takes 24 bytes a texel of a page
    /// while it is baked.
    pub loss_map: bool,
    /// How far off an edge may be, in seconds of the path's clock, for engines that search for edges
    /// ([`EngineChoice::searches`]); 0.001 to 3600, usually 1. Halving it costs every edge one ray more.
    pub edge_seconds: f64,
    /// Threads, 0 for one per core. The result does not depend on it.
    pub threads: usize,
    /// Memory that the bake may plan for; more is refused before it is taken.
    pub max_memory_bytes: u64,
}

/// Where shadow tracks are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum TrackChoice {
    /// Nowhere.
    #[default]
    Off,
    /// Where they foretell what texels see better than blending does, those that gain most first, within the bytes of
    /// the textures of lit intervals, in whose place they are read.
    Auto,
    /// Wherever shade moves from texel to texel.
    On,
}

impl TrackChoice {
    /// As the command line takes it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Off => "off",
            Self::Auto => "auto",
            Self::On => "on",
        }
    }
}

/// Which ambient light to bake, and how to store it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AmbientRequest {
    /// What is estimated, with how many rays.
    pub estimate: AmbientSettings,
    /// Points of a texel along each of its edges, 1 to 8, usually 1 or 2, from which its rays start. It takes no more
    /// rays: detail that a single point would miss is traded for noise.
    pub supersample: u32,
    /// Bits of stored ambient visibility; bent normals and the sky always have 16.
    pub bits: Bits,
    /// Whether the unrounded numbers are written as well, as OpenEXR of `f32`.
    pub exr: bool,
    /// Whether, and how, ambient visibility is also stored at vertices.
    pub vertices: Option<VertexAttribute>,
}

/// How ambient visibility is stored at vertices.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VertexAttribute {
    /// Multiplied into `COLOR_0`, which every viewer multiplies into the base colour.
    Color,
    /// As `_AO`, an attribute of its own, for engines that support it.
    Ao,
}

impl VertexAttribute {
    /// Its name in glTF.
    pub fn name(self) -> &'static str {
        match self {
            Self::Color => "COLOR_0",
            Self::Ao => "_AO",
        }
    }
}

impl AmbientRequest {
    /// This many rays a texel, ambient visibility only.
    pub fn with_rays(rays: u32) -> Self {
        let estimate =
            AmbientSettings { rays, distance_m: None, error: None, wants_bent: false, wants_sky: false, seed: 0 };
        Self { estimate, supersample: 1, bits: Bits::Sixteen, exr: false, vertices: None }
    }
}

/// Which sun to bake.
#[derive(Debug, Clone, PartialEq)]
pub enum SunRequest {
    /// A day at a place.
    Day(DayRequest),
    /// Keyed directions, or, of a lamp to be baked instead of a sun, positions: the text of a path file.
    Keyed {
        /// JSON; see [`crate::sun::parse_keyed`] and [`crate::lamp::parse_lamp`].
        json: String,
        /// Degrees that the scene's north is turned from -Z towards +X.
        north_deg: f64,
    },
    /// The scene's own directional light; if it has none, this day.
    SceneOr(DayRequest),
}

/// How lit intervals are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EngineChoice {
    /// In closed form: every edge to a billionth of the path; nothing is missed.
    Exact,
    /// Rays to this many evenly spaced positions of the sun, 2 to 65536. Edges are off by at most half a step, and what
    /// is thinner than a step may be missed. Time grows with the number.
    Rays(usize),
    /// Rays to this many evenly spaced positions of the sun, 2 to 65536, then bisection of every change between two of
    /// them down to [`BakeSettings::edge_seconds`]. What is shorter than a step may be missed. Time grows with the
    /// number, and with the number of edges.
    Bisect(usize),
}

impl EngineChoice {
    /// Whether it searches for edges, and so uses [`BakeSettings::edge_seconds`].
    pub fn searches(self) -> bool {
        matches!(self, Self::Bisect(_))
    }

    /// The engine for a lamp's path, bake space; none where it does not find lamps.
    pub fn lamp_engine<'a>(self, tracer: &'a Tracer, path: &LampPath) -> Option<Box<dyn Engine + 'a>> {
        match self {
            Self::Exact => Some(Box::new(LampEngine::new(tracer, path))),
            Self::Rays(count) => Some(Box::new(LampRays::new(tracer, path, count))),
            Self::Bisect(_) => None,
        }
    }

    /// Whether it finds when texels see a lamp.
    pub fn finds_lamps(self) -> bool {
        !matches!(self, Self::Bisect(_))
    }

    /// The engine, for the lanes of a sun. Given the scene's `parts`, the exact one notes which of them hide it.
    pub fn engine<'a>(
        self,
        tracer: &'a Tracer,
        lanes: &[SunPath],
        edge_seconds: f64,
        parts: Option<&Components>,
    ) -> Box<dyn Engine + 'a> {
        match self {
            Self::Exact => {
                let engine = ExactEngine::new(tracer, lanes);
                Box::new(parts.into_iter().fold(engine, ExactEngine::noting))
            }
            Self::Rays(count) => Box::new(RayEngine::new(tracer, lanes, count)),
            Self::Bisect(count) => Box::new(BisectEngine::new(tracer, lanes, count, edge_seconds)),
        }
    }
}

impl std::fmt::Display for EngineChoice {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self {
            Self::Exact => write!(f, "exact"),
            Self::Rays(count) => write!(f, "rays:{count}"),
            Self::Bisect(count) => write!(f, "bisect:{count}"),
        }
    }
}

impl BakeSettings {
    /// A preview in seconds: one page of 512, 8 bits, 64 rays of sky.
    pub fn draft(sun: SunRequest) -> Self {
        Self {
            density: Density::Pages(1),
            page_size_texels: 512,
            bits: Bits::Eight,
            layer_cap: 2,
            ambient: Some(AmbientRequest { bits: Bits::Eight, ..AmbientRequest::with_rays(64) }),
            max_memory_bytes: 4 << 30,
            ..Self::standard(sun)
        }
    }

    /// For a game level: one page of 2048, 16 bits, 128 rays of sky.
    pub fn standard(sun: SunRequest) -> Self {
        Self {
            sun,
            lamp: None,
            objects: ObjectWishes::default(),
            density: Density::Pages(1),
            page_size_texels: 2048,
            padding_texels: 2,
            bits: Bits::Sixteen,
            layer_cap: 4,
            lane_count: 1,
            smooth_terminator: true,
            bakes_intervals: true,
            tracks: TrackChoice::Off,
            ambient: Some(AmbientRequest::with_rays(128)),
            engine: EngineChoice::Exact,
            loss_map: false,
            edge_seconds: 1.0,
            threads: 0,
            max_memory_bytes: 8 << 30,
        }
    }

    /// For the final result: one page of 4096, 16 bits, up to 8 layers, 512 rays of sky.
    pub fn final_quality(sun: SunRequest) -> Self {
        let ambient = Some(AmbientRequest::with_rays(512));
        Self { page_size_texels: 4096, layer_cap: 8, ambient, max_memory_bytes: 16 << 30, ..Self::standard(sun) }
    }
}
