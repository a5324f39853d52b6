//! Shadow maps: depths as the sun sees them, with which what the camera sees is compared (Williams, "Casting curved shadows on
//! curved surfaces", SIGGRAPH 1978), and what has been made of them since.
//!
//! Everything here is geometry on the CPU, in `f64`; the passes are in [`crate::gpu`]. It reads in this order:
//!
//! ```text
//! ground       the lowest large level plane               } once per
//! extents      what casts and what receives               } stage
//! projection   a map's matrix
//! cascades, polyhedron, perspective     maps of a view    } once per view
//! bias         what keeps a surface from shading itself
//! ```
//!
//! A map holds what lies under some caster, seen along the light, and nothing else: a small house in a large desert gets all
//! texels. Both sides of every solid triangle cast, as they do for rays. What falls on no map is lit.

pub mod bias;
pub mod cascades;
pub mod extents;
pub mod ground;
pub mod perspective;
pub mod polyhedron;
pub mod projection;

pub use bias::Bias;
pub use extents::{Extents, Near, ShadowScene};
pub use ground::Ground;
pub use projection::{LightAxes, LightBounds, MapProjection};

use crate::{Filter, View};
use glam::DVec3;
use std::fmt;

/// Most maps of a view: the faces of a cube.
pub const MOST_MAPS: usize = sunbake_shaders::MOST_SHADOW_VIEWS;

/// A kind of shadow map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub enum Variant {
    /// One orthographic map, compared texel by texel, with one number for a bias.
    Plain,
    /// The same, compared by the sampler.
    Compare,
    /// Sixteen comparisons over four by four texels (Bunnell and Pellacini, *GPU Gems* chapter 11).
    Pcf16,
    /// Four of the sixteen, dithered over two by two pixels (the same).
    Pcf4,
    /// A filter as wide as the penumbra (Fernando, "Percentage-closer soft shadows", SIGGRAPH 2005).
    Pcss,
    /// A map for each slice of the view, each filtered by sixteen comparisons: what needs no tuning, however large the scene.
    #[default]
    Cascades,
    /// A map of the scene as the camera bends it (*GPU Gems* chapter 14).
    Perspective,
    /// The same, as faces of a cube around the sun.
    Cube,
    /// On the ground a blurred picture of what casts, without depth (*GPU Gems* chapter 11); elsewhere as [`Self::Compare`].
    Ground,
    /// Casters laid flat on the ground (Blinn, "Me and my (fake) shadow", 1988); no shadows elsewhere.
    Planar,
}

impl Variant {
    /// All of them.
    pub const ALL: [Self; 10] = [
        Self::Plain,
        Self::Compare,
        Self::Pcf16,
        Self::Pcf4,
        Self::Pcss,
        Self::Cascades,
        Self::Perspective,
        Self::Cube,
        Self::Ground,
        Self::Planar,
    ];

    /// Whether its edges are meant to be soft, so that it is to be held against soft truth.
    pub fn is_soft(self) -> bool {
        matches!(self, Self::Pcf16 | Self::Pcf4 | Self::Pcss | Self::Cascades | Self::Ground)
    }

    /// Whether its maps change as the camera moves.
    pub fn follows_view(self) -> bool {
        matches!(self, Self::Cascades | Self::Perspective | Self::Cube)
    }

    /// How far its filter reaches from the place that is looked up along either axis, in texels; the penumbra's own width comes on
    /// top.
    pub fn reach_texels(self) -> f64 {
        match self {
            Self::Plain | Self::Planar => 0.5,
            Self::Compare | Self::Perspective | Self::Cube => 1.0,
            Self::Pcf16 | Self::Pcf4 | Self::Pcss | Self::Cascades => 2.5,
            Self::Ground => 5.5,
        }
    }

    /// The bias that it is drawn with unless told otherwise.
    pub fn bias(self) -> Bias {
        match self {
            Self::Plain => Bias::CONSTANT,
            Self::Compare | Self::Ground => Bias::SAMPLED,
            _ => Bias::RECOMMENDED,
        }
    }
}

impl fmt::Display for Variant {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::Plain => "map:plain",
            Self::Compare => "map:compare",
            Self::Pcf16 => "map:pcf16",
            Self::Pcf4 => "map:pcf4",
            Self::Pcss => "map:pcss",
            Self::Cascades => "map:cascades",
            Self::Perspective => "map:perspective",
            Self::Cube => "map:cube",
            Self::Ground => "map:ground",
            Self::Planar => "map:planar",
        })
    }
}

/// How a stage is to be lit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapSettings {
    /// What kind of map.
    pub variant: Variant,
    /// Edge of each map, 16 to 16384. Bytes, and the time that a map takes to draw, grow with the square.
    pub size_texels: u32,
    /// Most cascades, 2 to 4 (others are taken for the nearest of these): each costs a map.
    pub cascades: usize,
    /// What keeps a surface from shading itself.
    pub bias: Bias,
    /// How a lamp's stored times are filtered, which are drawn beside the sun.
    pub lamp_filter: Filter,
    /// Whether passes are timed, where the GPU can.
    pub is_timed: bool,
    /// What may be left out, or done by the GPU's own means. All on, unless something is to be measured or tested.
    pub means: Means,
}

/// What may be left out, or done by the GPU's own means.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Means {
    /// Casters above the map are drawn at depth 0 by the GPU; else depths begin above them.
    pub depth_clamp: bool,
    /// Comparisons of a sampler are filtered where it can.
    pub filtering: bool,
    /// Maps are kept while neither the sun nor what they depend on moves.
    pub cache: bool,
    /// No comparison is made: all that faces the sun is lit. Tells what a filter takes.
    pub sampling: bool,
}

impl Default for Means {
    fn default() -> Self {
        Self { depth_clamp: true, filtering: true, cache: true, sampling: true }
    }
}

impl MapSettings {
    /// A variant as it is drawn unless told otherwise.
    pub fn new(variant: Variant) -> Self {
        Self {
            variant,
            size_texels: 2048,
            cascades: 4,
            bias: variant.bias(),
            lamp_filter: Filter::default(),
            is_timed: false,
            means: Means::default(),
        }
    }

    /// Whether the shader filters what it gathers, each texel against the receiver's plane; else what compares is a sampler (or, of
    /// [`Variant::Plain`], the shader).
    pub fn gathers(&self) -> bool {
        self.bias.has_plane && self.means.filtering && !matches!(self.variant, Variant::Plain | Variant::Planar)
    }

    /// How far from the place that is looked up what is found may lie, in texels: the filter's reach, what moves the receiver, and
    /// the rounding of what casts to texels.
    pub fn reach_texels(&self) -> f64 {
        let to_corner = std::f64::consts::SQRT_2;
        to_corner * (self.variant.reach_texels() + self.bias.normal + 0.5) + self.bias.constant_texels
    }

    /// Texels kept around what a map must hold: what a filter, the normal offset and rounding reach over its border.
    pub fn margin_texels(&self) -> f64 {
        let most = f64::from(self.size_texels) / 4.0;
        // The same for all that compare once, so that they have one map.
        let reach = self.reach_texels().max(Self { variant: Variant::Compare, ..*self }.reach_texels());
        (reach + 1.0).ceil().min(most)
    }

    /// The maps of a view under a sun; none where nothing can be in shadow.
    pub fn maps(
        &self,
        scene: &ShadowScene,
        extents: &Extents,
        view: &View,
        sun_radius_rad: f64,
        has_depth_clamp: bool,
    ) -> Vec<MapProjection> {
        let Some(receiver_box_m) = scene.receiver_box_m else { return Vec::new() };
        let near = if has_depth_clamp && self.variant != Variant::Pcss { Near::Receivers } else { Near::Casters };
        let (size_texels, margin_texels) = (self.size_texels, self.margin_texels());
        match self.variant {
            Variant::Planar => Vec::new(),
            Variant::Cascades => {
                cascades::cascades(view, extents, scene, self.cascades.clamp(2, 4), size_texels, margin_texels, near)
            }
            Variant::Perspective | Variant::Cube => {
                let samples_m = &scene.samples_m;
                let seen =
                    perspective::Seen { view, extents, receiver_box_m, samples_m, size_texels, margin_texels, near };
                perspective::perspective(&seen, self.variant == Variant::Cube)
            }
            _ => {
                let mut bounds = extents.shaded(near);
                if let (Variant::Pcss, Some(bounds)) = (self.variant, &mut bounds) {
                    // Penumbras reach beyond what lies under a caster.
                    let aside_m = bounds.size().z * sun_radius_rad.tan();
                    bounds.low -= DVec3::new(aside_m, aside_m, 0.0);
                    bounds.high += DVec3::new(aside_m, aside_m, 0.0);
                }
                let map = |b| MapProjection::orthographic(extents.axes, &b, size_texels, margin_texels);
                bounds.map(map).into_iter().collect()
            }
        }
    }
}

/// How far across the light edges may be off at a point, in metres: as far as [`MapSettings::reach_texels`] on the maps that the
/// point is looked up on. Nothing where it is on none.
pub fn reach_m(settings: &MapSettings, maps: &[MapProjection], point_m: DVec3) -> f64 {
    let holding = maps.iter().filter(|map| map.holds(point_m, 0.0));
    // Near its border a cascade gives way to the next.
    let looked_up = if settings.variant == Variant::Cascades { 2 } else { 1 };
    let texel_m = holding.take(looked_up).map(|map| map.texel_m(point_m)).fold(0.0, f64::max);
    settings.reach_texels() * texel_m
}
