//! Shadow maps: depths as seen from the sun, with which the surfaces that the camera sees are compared (Williams,
//! "Casting curved shadows on curved surfaces", SIGGRAPH 1978), and later variants.
//!
//! This module is geometry on the CPU, in `f64`; the passes are in [`crate::gpu`]. Read it in this order:
//!
//! ```text
//! ground       the lowest large level plane               } once per
//! extents      casters and receivers                      } stage
//! projection   a map's matrix
//! cascades, perspective (warp, polyhedron)  maps of a view   once per view
//! bias         what keeps a surface from shading itself
//! ```
//!
//! A map holds only what lies under some caster, seen along the light: a small house in a large desert gets all texels.
//! Both sides of every solid triangle cast, as they do for rays. Points outside of every map are lit.

pub mod bias;
pub mod cascades;
pub mod extents;
pub mod ground;
mod lifts;
mod map_request;
pub mod perspective;
pub mod polyhedron;
pub mod projection;
mod warp;

pub use bias::Bias;
pub use extents::{Extents, Near, ShadowScene};
pub use ground::Ground;
pub use lifts::free_edge_lifts_m;
pub use projection::{LightAxes, LightBounds, MapProjection};

use crate::{Filter, View};
use glam::DVec3;
use std::fmt;

/// Most maps of a view: the faces of a cube.
pub const MOST_MAPS: usize = sunbake_shaders::MOST_SHADOW_MAPS;

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
    /// A map for each slice of the view, each filtered by sixteen comparisons: what needs no tuning, however large the
    /// scene.
    #[default]
    Cascades,
    /// A map in the space after the camera's projection (*GPU Gems* chapter 14).
    Perspective,
    /// The same, as faces of a cube around the sun.
    Cube,
    /// On the ground a blurred picture of casters, without depth (*GPU Gems* chapter 11); elsewhere as
    /// [`Self::Compare`].
    Ground,
    /// Casters laid flat on the ground (Blinn, "Me and my (fake) shadow", 1988); no shadows elsewhere.
    Planar,
}

impl Variant {
    /// Every variant.
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

    /// Whether its edges are meant to be soft. It is compared with soft truth then.
    pub fn is_soft(self) -> bool {
        matches!(self, Self::Pcf16 | Self::Pcf4 | Self::Pcss | Self::Cascades | Self::Ground)
    }

    /// Whether its maps change as the camera moves.
    pub fn follows_view(self) -> bool {
        matches!(self, Self::Cascades | Self::Perspective | Self::Cube)
    }

    /// How far its filter reaches from the point that is looked up, along either axis, in texels. The penumbra's own
    /// width is added.
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

/// How shadow maps are drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapSettings {
    /// The kind of map.
    pub variant: Variant,
    /// Edge of each map, 16 to 16384. Bytes, and the time that a map takes to draw, grow with the square.
    pub size_texels: u32,
    /// Most cascades, 2 to 4; other values are clamped. Each costs a map.
    pub cascades: usize,
    /// What keeps a surface from shading itself.
    pub bias: Bias,
    /// How a lamp's stored times are filtered. A lamp's shadows come from the bake.
    pub lamp_filter: Filter,
    /// Whether passes are timed, where the GPU can.
    pub is_timed: bool,
    /// All are on, except for measurements and tests.
    pub optimizations: MapOptimizations,
}

/// Features that make shadow maps faster or smoother. Measurements and tests turn some off.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MapOptimizations {
    /// Casters above the map are drawn at depth 0 by the GPU's depth clamp. Off: depths begin above them.
    pub depth_clamp: bool,
    /// A sampler's comparisons are filtered, where the GPU can.
    pub filtering: bool,
    /// Maps are kept while neither the sun nor what they depend on moves.
    pub cache: bool,
    /// Depths are compared. Off: every surface that faces the sun is lit, to measure what comparing costs.
    pub sampling: bool,
}

impl Default for MapOptimizations {
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
            optimizations: MapOptimizations::default(),
        }
    }

    /// Whether the shader gathers depths and filters them itself, each texel against the receiver's plane. Otherwise a
    /// sampler compares (or, for [`Variant::Plain`], the shader).
    pub fn gathers(&self) -> bool {
        self.bias.has_plane && self.optimizations.filtering && !matches!(self.variant, Variant::Plain | Variant::Planar)
    }

    /// How far a shadow's edge may be displaced, in texels: the filter's reach, the receiver's offset, and rounding of
    /// casters to texels.
    pub fn reach_texels(&self) -> f64 {
        let to_corner = std::f64::consts::SQRT_2;
        to_corner * (self.variant.reach_texels() + self.bias.normal + 0.5) + self.bias.constant_texels
    }

    /// Texels kept around what a map must hold, for filter, normal offset and rounding.
    pub fn margin_texels(&self) -> f64 {
        let most = f64::from(self.size_texels) / 4.0;
        // The same for all variants that compare once, so that they can share a map.
        let reach = self.reach_texels().max(Self { variant: Variant::Compare, ..*self }.reach_texels());
        (reach + 1.0).ceil().min(most)
    }

    /// The maps of a view under a sun. Empty where nothing can be in shadow.
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
                let request = map_request::MapRequest {
                    view,
                    extents,
                    receiver_box_m,
                    samples_m,
                    size_texels,
                    margin_texels,
                    near,
                };
                perspective::perspective(&request, self.variant == Variant::Cube)
            }
            _ => {
                let mut bounds = extents.shaded(near);
                if let (Variant::Pcss, Some(bounds)) = (self.variant, &mut bounds) {
                    // Penumbras reach beyond what lies under a caster.
                    let penumbra_m = bounds.size().z * sun_radius_rad.tan();
                    bounds.low -= DVec3::new(penumbra_m, penumbra_m, 0.0);
                    bounds.high += DVec3::new(penumbra_m, penumbra_m, 0.0);
                }
                let map = |b| MapProjection::orthographic(extents.axes, &b, size_texels, margin_texels);
                bounds.map(map).into_iter().collect()
            }
        }
    }
}

/// How far across the light a shadow's edge may be displaced at a point, in metres: [`MapSettings::reach_texels`] on
/// the maps that are looked up there. 0 where the point is on no map.
pub fn reach_m(settings: &MapSettings, maps: &[MapProjection], point_m: DVec3) -> f64 {
    let holding = maps.iter().filter(|map| map.holds(point_m, 0.0));
    // Near its border a cascade is blended with the next.
    let looked_up = if settings.variant == Variant::Cascades { 2 } else { 1 };
    let texel_m = holding.take(looked_up).map(|map| map.texel_m(point_m)).fold(0.0, f64::max);
    settings.reach_texels() * texel_m
}
