//! Shaders of shadow maps, and of surfaces that read them.

use crate::compose::{end_of_lit, on_surface, wgsl};
use crate::uniforms::MOST_SHADOW_MAPS;
use crate::vertex::{DEPTH_VERTEX_WGSL, surface_vertex_wgsl};
use crate::{Filter, PageVariant, SurfaceVariant};
use std::fmt::Write;

/// How many comparisons are made around a point of the map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum ShadowFilter {
    /// One comparison.
    One,
    /// Sixteen comparisons over four by four texels.
    Sixteen,
    /// Four of the sixteen; which four differs between neighbouring pixels.
    Four,
    /// A filter as wide as the penumbra.
    Penumbra,
}

/// What compares the stored depth with the receiver's.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum ShadowTap {
    /// The shader.
    Manual,
    /// A comparison sampler that does not filter.
    Nearest,
    /// A comparison sampler that filters.
    Filtered,
    /// The shader, which compares and filters the four texels that a sampler gathers.
    Gathered,
}

/// Which map a point is looked up on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum ShadowMapChoice {
    /// There is only one.
    One,
    /// The first that holds it.
    First,
    /// The first that holds it, blended towards its border with the next.
    Blended,
}

/// The bias of a receiver, as in the runtime's `Bias`, and how far its filter reaches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShadowBias {
    /// Along the light, metres.
    pub constant_m: f32,
    /// Along the light, texels.
    pub constant_texels: f32,
    /// Along the light, as a multiple of how much the receiver's plane rises within reach.
    pub slope: f32,
    /// Along the normal, as a multiple of the distance between the plane and the corner of a texel.
    pub normal: f32,
    /// The reach, in texels.
    pub reach: f32,
    /// The reach where a texel is not compared with the receiver's plane, in texels.
    pub reach_off_plane: f32,
    /// Whether texels are compared with the receiver's plane at their own centre.
    pub has_plane: bool,
}

/// Where a surface's shader finds the sun's visibility.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ShadowSource {
    /// The sun is down: 0.
    Down,
    /// Nothing hides the sun.
    Open,
    /// Shadow maps.
    Maps {
        /// Number and pattern of comparisons.
        filter: ShadowFilter,
        /// What compares depths.
        tap: ShadowTap,
        /// Which of several maps is read.
        choice: ShadowMapChoice,
        /// What keeps a surface from shading itself.
        bias: ShadowBias,
        /// Margin at the border of a map, where another map is used, in texels.
        margin_texels: f32,
    },
    /// A blurred mask of casters, as the sun sees it.
    Mask,
    /// A mask of casters projected flat onto the ground, as the camera sees it.
    Flat,
}

/// The depths of a map: entry points `depth_vertex`, or for surfaces with alpha masks `surface_vertex` and
/// `depth_fragment`.
pub fn shadow_depth_shader(surface: SurfaceVariant) -> String {
    let mut text = [wgsl!("frame/frame"), wgsl!("shadow_maps/map"), wgsl!("shadow_maps/map_projection")].concat();
    if surface.has_alpha_mask {
        crate::compose::push_alpha_mask(&mut text, surface, &surface_vertex_wgsl(surface, None));
        text.push_str(wgsl!("frame/depth_fragment"));
    } else {
        text.push_str(DEPTH_VERTEX_WGSL);
    }
    text
}

/// A mask of casters on the ground, on a map or projected flat as the camera sees it: entry points `mask_vertex`, or
/// for surfaces with alpha masks `surface_vertex`, and `mask_fragment`.
pub fn shadow_mask_shader(surface: SurfaceVariant, is_flat: bool) -> String {
    let place = if is_flat { wgsl!("shadow_maps/flat_projection") } else { wgsl!("shadow_maps/map_projection") };
    let mut text = [wgsl!("frame/frame"), wgsl!("shadow_maps/map"), place, wgsl!("shadow_maps/ground_height")].concat();
    if surface.has_alpha_mask {
        let height = ("height_m", "height_above_ground(vertex.position_m)");
        crate::compose::push_alpha_mask(&mut text, surface, &surface_vertex_wgsl(surface, Some(height)));
    } else {
        text.push_str(&[wgsl!("shadow_maps/mask_vertex"), wgsl!("surface/alpha_mask_none")].concat());
    }
    text.push_str(wgsl!("shadow_maps/mask_fragment"));
    text
}

/// A blur: entry points `screen_vertex`, `blur_across_fragment` and `blur_down_fragment`.
pub fn blur_shader() -> String {
    [wgsl!("frame/screen_vertex"), wgsl!("shadow_maps/blur_fragment")].concat()
}

/// The lit pass under shadow maps: entry points `surface_vertex` and `lit_fragment`. The lamp is read from the page's
/// maps.
pub fn mapped_lit_shader(surface: SurfaceVariant, page: &PageVariant, filter: Filter, sun: &ShadowSource) -> String {
    let mut text = on_surface(surface, page, filter);
    push_sun(&mut text, surface, sun);
    end_of_lit(&mut text, surface.look, page, filter);
    text
}

/// The visibility pass under shadow maps: entry points `surface_vertex` and `visibility_fragment`.
pub fn mapped_visibility_shader(surface: SurfaceVariant, sun: &ShadowSource) -> String {
    let mut text = on_surface(surface, &PageVariant::default(), Filter::default());
    push_sun(&mut text, surface, sun);
    text.push_str(wgsl!("surface/visibility_fragment"));
    text
}

fn push_sun(text: &mut String, surface: SurfaceVariant, sun: &ShadowSource) {
    match sun {
        ShadowSource::Down => text.push_str(wgsl!("baked/sun_none")),
        ShadowSource::Open => text.push_str(wgsl!("shadow_maps/sun_open")),
        ShadowSource::Flat => text.push_str(wgsl!("shadow_maps/sun_flat_mask")),
        ShadowSource::Mask => {
            let bias = ShadowBias {
                constant_m: 0.0,
                constant_texels: 0.0,
                slope: 0.0,
                normal: 0.0,
                reach: 0.0,
                reach_off_plane: 0.0,
                has_plane: false,
            };
            push_receiver(text, &bias, 0.0);
            text.push_str(wgsl!("shadow_maps/sun_ground_mask"));
        }
        ShadowSource::Maps { filter, tap, choice, bias, margin_texels } => {
            push_receiver(text, bias, *margin_texels);
            text.push_str(match tap {
                ShadowTap::Manual => wgsl!("shadow_maps/tap_manual"),
                ShadowTap::Nearest => wgsl!("shadow_maps/tap_compare_nearest"),
                ShadowTap::Filtered => wgsl!("shadow_maps/tap_compare"),
                ShadowTap::Gathered => wgsl!("shadow_maps/tap_gather"),
            });
            text.push_str(match filter {
                ShadowFilter::One => wgsl!("shadow_maps/filter_one"),
                ShadowFilter::Sixteen => wgsl!("shadow_maps/filter_16"),
                ShadowFilter::Four => wgsl!("shadow_maps/filter_4"),
                ShadowFilter::Penumbra => wgsl!("shadow_maps/filter_pcss"),
            });
            text.push_str(wgsl!("shadow_maps/lit_on_map"));
            text.push_str(match choice {
                ShadowMapChoice::One => wgsl!("shadow_maps/maps_one"),
                ShadowMapChoice::First => wgsl!("shadow_maps/maps_first"),
                ShadowMapChoice::Blended => wgsl!("shadow_maps/maps_blended"),
            });
            let has_lift = surface.has_lift;
            text.push_str(if has_lift { wgsl!("shadow_maps/place_smooth") } else { wgsl!("shadow_maps/place_flat") });
            let is_disc = *filter == ShadowFilter::Penumbra;
            text.push_str(if is_disc { wgsl!("shadow_maps/sun_disc") } else { wgsl!("shadow_maps/sun") });
        }
    }
}

fn push_receiver(text: &mut String, bias: &ShadowBias, margin_texels: f32) {
    let numbers = [
        ("BIAS_CONSTANT_M", bias.constant_m),
        ("BIAS_CONSTANT_TEXELS", bias.constant_texels),
        ("BIAS_SLOPE", bias.slope),
        ("BIAS_NORMAL", bias.normal),
        ("BIAS_REACH", bias.reach),
        ("BIAS_REACH_OFF_PLANE", bias.reach_off_plane),
        ("MAP_MARGIN_TEXELS", margin_texels),
    ];
    // Writing to a string cannot fail.
    let _ = writeln!(text, "const MOST_SHADOW_MAPS: u32 = {MOST_SHADOW_MAPS}u;");
    let _ = writeln!(text, "const BIAS_HAS_PLANE: bool = {};", bias.has_plane);
    for (name, value) in numbers {
        let _ = writeln!(text, "const {name}: f32 = {value:?};");
    }
    text.push_str(&[wgsl!("shadow_maps/map"), wgsl!("shadow_maps/maps"), wgsl!("shadow_maps/receiver")].concat());
}

/// Tells whether a comparison sampler filters: entry points `probe_vertex`, which draws a depth of 1, and `probe`,
/// which writes what is read halfway between that texel and one of depth 0.
pub fn shadow_probe_shader() -> String {
    wgsl!("shadow_maps/probe").to_owned()
}
