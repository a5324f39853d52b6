//! Shaders of shadow maps, and of surfaces that are lit by them.

use crate::compose::{end_of_lit, on_surface, wgsl};
use crate::uniforms::MOST_SHADOW_VIEWS;
use crate::vertex::{DEPTH_VERTEX_WGSL, surface_vertex_wgsl};
use crate::{Filter, PageVariant, SurfaceVariant};
use std::fmt::Write;

/// What becomes of the depths around a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum ShadowFilter {
    /// One comparison.
    One,
    /// Sixteen over four by four texels.
    Sixteen,
    /// Four of these.
    Four,
    /// As many as the penumbra is wide.
    Penumbra,
}

/// What compares.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum ShadowTap {
    /// The shader.
    Manual,
    /// A sampler that does not filter.
    Nearest,
    /// A sampler that filters.
    Filtered,
    /// The shader, which filters what a sampler gathers.
    Gathered,
}

/// Which map a place is looked up on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum ShadowViews {
    /// There is one.
    One,
    /// The first that holds it.
    First,
    /// The first that holds it, and towards its border the next.
    Blended,
}

/// What moves a receiver, in the terms of the runtime's `Bias`, and how far its filter reaches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShadowBias {
    /// Along the light, metres.
    pub constant_m: f32,
    /// Along the light, texels.
    pub constant_texels: f32,
    /// Along the light, times the rise of the plane.
    pub slope: f32,
    /// Along the normal, times the distance of a corner from the plane.
    pub normal: f32,
    /// How far away the rise and the corner are, in texels.
    pub reach: f32,
    /// Whether texels are compared with the plane.
    pub has_plane: bool,
}

/// What lights a surface that a map's shadows fall on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ShadowSource {
    /// Nothing: the sun is down.
    Down,
    /// The sun, which nothing hides.
    Open,
    /// What maps tell.
    Maps {
        /// What becomes of depths.
        filter: ShadowFilter,
        /// What compares.
        tap: ShadowTap,
        /// Which map.
        views: ShadowViews,
        /// What moves a receiver.
        bias: ShadowBias,
        /// From how near to its border a map of several is not looked up, in texels.
        margin_texels: f32,
    },
    /// A blurred picture of what casts, on a map's place.
    Mask,
    /// A picture of what casts, laid flat, as the camera sees it.
    Flat,
}

/// The depths of a map: entry points `depth_vertex`, or for surfaces with holes `surface_vertex` and `depth_fragment`.
pub fn shadow_depth_shader(surface: SurfaceVariant) -> String {
    let mut text = [wgsl!("frame"), wgsl!("shadow_view"), wgsl!("place_in_map")].concat();
    if surface.is_cut {
        crate::compose::push_alpha_mask(&mut text, surface, &surface_vertex_wgsl(surface, None));
        text.push_str(wgsl!("depth_fragment"));
    } else {
        text.push_str(DEPTH_VERTEX_WGSL);
    }
    text
}

/// A picture of what casts on the ground, on a map or laid flat as the camera sees it: entry points `mask_vertex`, or for surfaces
/// with holes `surface_vertex`, and `mask_fragment`.
pub fn shadow_mask_shader(surface: SurfaceVariant, is_flat: bool) -> String {
    let place = if is_flat { wgsl!("place_flat") } else { wgsl!("place_in_map") };
    let mut text = [wgsl!("frame"), wgsl!("shadow_view"), place, wgsl!("ground_height")].concat();
    if surface.is_cut {
        let height = ("height_m", "height_above_ground(vertex.position_m)");
        crate::compose::push_alpha_mask(&mut text, surface, &surface_vertex_wgsl(surface, Some(height)));
    } else {
        text.push_str(&[wgsl!("mask_vertex"), wgsl!("alpha_none")].concat());
    }
    text.push_str(wgsl!("mask_fragment"));
    text
}

/// A blur: entry points `screen_vertex`, `blur_across_fragment` and `blur_down_fragment`.
pub fn blur_shader() -> String {
    [wgsl!("screen"), wgsl!("blur_fragment")].concat()
}

/// The lit pass under a sun that maps tell of: entry points `surface_vertex` and `lit_fragment`. A lamp's times are the page's.
pub fn mapped_lit_shader(surface: SurfaceVariant, page: &PageVariant, filter: Filter, sun: &ShadowSource) -> String {
    let mut text = on_surface(surface, page);
    push_sun(&mut text, sun);
    end_of_lit(&mut text, page, filter);
    text
}

/// The visibility pass under a sun that maps tell of: entry points `surface_vertex` and `visibility_fragment`.
pub fn mapped_visibility_shader(surface: SurfaceVariant, sun: &ShadowSource) -> String {
    let mut text = on_surface(surface, &PageVariant::default());
    push_sun(&mut text, sun);
    text.push_str(wgsl!("visibility_fragment"));
    text
}

fn push_sun(text: &mut String, sun: &ShadowSource) {
    match sun {
        ShadowSource::Down => text.push_str(wgsl!("sun_none")),
        ShadowSource::Open => text.push_str(wgsl!("sun_open")),
        ShadowSource::Flat => text.push_str(wgsl!("sun_flat_mask")),
        ShadowSource::Mask => {
            let bias = ShadowBias {
                constant_m: 0.0,
                constant_texels: 0.0,
                slope: 0.0,
                normal: 0.0,
                reach: 0.0,
                has_plane: false,
            };
            push_receiver(text, &bias, 0.0);
            text.push_str(wgsl!("sun_ground_mask"));
        }
        ShadowSource::Maps { filter, tap, views, bias, margin_texels } => {
            push_receiver(text, bias, *margin_texels);
            text.push_str(match tap {
                ShadowTap::Manual => wgsl!("shadow_tap_manual"),
                ShadowTap::Nearest => wgsl!("shadow_tap_compare_nearest"),
                ShadowTap::Filtered => wgsl!("shadow_tap_compare"),
                ShadowTap::Gathered => wgsl!("shadow_tap_gather"),
            });
            text.push_str(match filter {
                ShadowFilter::One => wgsl!("shadow_filter_one"),
                ShadowFilter::Sixteen => wgsl!("shadow_filter_16"),
                ShadowFilter::Four => wgsl!("shadow_filter_4"),
                ShadowFilter::Penumbra => wgsl!("shadow_filter_pcss"),
            });
            text.push_str(match views {
                ShadowViews::One => wgsl!("shadow_views_one"),
                ShadowViews::First => wgsl!("shadow_views_first"),
                ShadowViews::Blended => wgsl!("shadow_views_blended"),
            });
            let is_disc = *filter == ShadowFilter::Penumbra;
            text.push_str(if is_disc { wgsl!("sun_mapped_disc") } else { wgsl!("sun_mapped") });
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
        ("MAP_MARGIN_TEXELS", margin_texels),
    ];
    // Writing to a string cannot fail.
    let _ = writeln!(text, "const MOST_SHADOW_VIEWS: u32 = {MOST_SHADOW_VIEWS}u;");
    let _ = writeln!(text, "const BIAS_HAS_PLANE: bool = {};", bias.has_plane);
    for (name, value) in numbers {
        let _ = writeln!(text, "const {name}: f32 = {value:?};");
    }
    text.push_str(&[wgsl!("shadow_view"), wgsl!("shadow_maps"), wgsl!("shadow_receiver")].concat());
}

/// Tells whether a sampler filters what it compares: entry points `probe_vertex`, which draws a depth of 1, and `probe`, which
/// writes what is read between that texel and one of depth 0.
pub fn shadow_probe_shader() -> String {
    wgsl!("shadow_probe").to_owned()
}
