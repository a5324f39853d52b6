//! Composes shaders: constants, then files in reading order.

use crate::uniforms::{WRAP_CLAMP, WRAP_MIRROR, WRAP_REPEAT};
use crate::vertex::{DEPTH_VERTEX_WGSL, surface_vertex_wgsl};
use std::fmt::Write;

macro_rules! wgsl {
    ($name:literal) => {
        include_str!(concat!("wgsl/", $name, ".wgsl"))
    };
}
pub(crate) use wgsl;

/// What a surface needs of its program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub struct SurfaceVariant {
    /// Its material has a base colour texture.
    pub is_textured: bool,
    /// Its mesh has vertex colours.
    pub has_vertex_color: bool,
    /// It has an alpha mask.
    pub has_alpha_mask: bool,
    /// Its faces are facets of something smooth: light ends where the shading normal says.
    pub is_smooth: bool,
    /// Its vertices say how far that is from the faces, as shadow maps need it.
    pub has_lift: bool,
}

/// How stored times become a pixel's visibility.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Filter {
    /// The texel under the pixel, unfiltered: blocky, as in *GPU Gems* chapter 13.
    Nearest,
    /// Four texels, each evaluated, then blended.
    #[default]
    Bilinear,
}

/// A lane across the sun's disc, as a page stores it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LaneVariant {
    /// Number of layers; 0 where no texel of the page ever sees this lane.
    pub layer_count: u32,
    /// Its share of the sun's light, from 0 to 1.
    pub weight: f32,
    /// Its chord across the disc, as a share of the diameter. Its window is narrower by this factor.
    pub chord: f32,
}

/// What an atlas page needs of the programs that read it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PageVariant {
    /// 255 or 65535.
    pub max_code: u16,
    /// In the order of their layers. Empty where the set has no sun, or where no texel of the page ever sees it.
    pub lanes: Vec<LaneVariant>,
    /// Whether the sun has no width, so that it is visible or not.
    pub is_point_sun: bool,
    /// Layers of the lamp's textures. 0 where the set has no lamp, or where no texel of the page ever sees it.
    pub lamp_layer_count: u32,
    /// How ambient light is computed.
    pub ambient: AmbientModel,
    /// Whether maps of ambient light have a slice for the backs of surfaces.
    pub has_backs: bool,
    /// Whether something stands between neighbouring texels, so that filters must not blend across it.
    pub has_walls: bool,
}

/// How ambient light on a page's surfaces is computed. Each model reads more than the one before.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub enum AmbientModel {
    /// Sky and ground by the normal alone: `(1 + n.y) / 2` of the sky. Reads no map.
    #[default]
    Hemisphere,
    /// The same, times ambient occlusion.
    Occlusion,
    /// The same with the bent normal instead of the normal.
    Bent,
    /// The sky of the moment in spherical harmonics, times each texel's visibility of it.
    Sky,
}

impl PageVariant {
    /// Layers of the page's `rise` texture, and of its `fall` texture. 0: no texture, no binding and no loop.
    pub fn layer_count(&self) -> u32 {
        self.lanes.iter().map(|lane| lane.layer_count).sum()
    }

    /// Whether any map of texels is read.
    pub fn reads_texels(&self) -> bool {
        self.layer_count() > 0 || self.lamp_layer_count > 0 || self.ambient != AmbientModel::Hemisphere
    }
}

/// The depth pass: entry points `depth_vertex`, or for surfaces with alpha masks `surface_vertex` and `depth_fragment`.
pub fn depth_shader(surface: SurfaceVariant) -> String {
    let mut text = [wgsl!("frame/frame"), wgsl!("frame/camera_projection")].concat();
    if surface.has_alpha_mask {
        push_alpha_mask(&mut text, surface, &surface_vertex_wgsl(surface, None));
        text.push_str(wgsl!("frame/depth_fragment"));
    } else {
        text.push_str(DEPTH_VERTEX_WGSL);
    }
    text
}

/// The lit pass: entry points `surface_vertex` and `lit_fragment`.
pub fn lit_shader(surface: SurfaceVariant, page: &PageVariant, filter: Filter) -> String {
    let mut text = shading(surface, page, filter);
    end_of_lit(&mut text, page, filter);
    text
}

/// The rest of the lit pass, after the sun's visibility.
pub(crate) fn end_of_lit(text: &mut String, page: &PageVariant, filter: Filter) {
    push_ambient(text, page);
    text.push_str(wgsl!("surface/shade"));
    push_lamp(text, page, filter);
    text.push_str(if page.lamp_layer_count > 0 { wgsl!("lamp/shade") } else { wgsl!("lamp/shade_none") });
    text.push_str(wgsl!("surface/surface"));
    text.push_str(wgsl!("surface/lit_fragment"));
}

/// The visibility pass: entry points `surface_vertex` and `visibility_fragment`.
pub fn visibility_shader(surface: SurfaceVariant, page: &PageVariant, filter: Filter) -> String {
    let mut text = shading(surface, page, filter);
    text.push_str(wgsl!("surface/visibility_fragment"));
    text
}

/// The visibility pass of a lamp: entry points `surface_vertex` and `lamp_visibility_fragment`.
pub fn lamp_visibility_shader(surface: SurfaceVariant, page: &PageVariant, filter: Filter) -> String {
    let mut text = on_surface(surface, page);
    push_lamp(&mut text, page, filter);
    text.push_str(wgsl!("lamp/visibility_fragment"));
    text
}

/// The background: entry points `screen_vertex` and `sky_fragment`.
pub fn sky_shader() -> String {
    [
        &constants(),
        wgsl!("frame/frame"),
        wgsl!("frame/sky_color"),
        wgsl!("frame/screen_vertex"),
        wgsl!("frame/sky_fragment"),
    ]
    .concat()
}

fn constants() -> String {
    format!(
        "const WRAP_REPEAT: u32 = {WRAP_REPEAT}u;\nconst WRAP_MIRROR: u32 = {WRAP_MIRROR}u;\nconst WRAP_CLAMP: u32 = \
         {WRAP_CLAMP}u;\n"
    )
}

/// How every program that lights a surface begins.
pub(crate) fn on_surface(surface: SurfaceVariant, page: &PageVariant) -> String {
    let mut text = [wgsl!("frame/frame"), wgsl!("frame/camera_projection")].concat();
    push_alpha_mask(&mut text, surface, &surface_vertex_wgsl(surface, None));
    text.push_str(wgsl!("surface/facing"));
    text.push_str(if surface.is_smooth { wgsl!("surface/gate_smooth") } else { wgsl!("surface/gate_flat") });
    push_evaluation(&mut text, page);
    text
}

/// What evaluates a page's maps: the texels around a page coordinate, and the lit share of stored times.
fn push_evaluation(text: &mut String, page: &PageVariant) {
    let (has_sun, has_lamp) = (page.layer_count() > 0, page.lamp_layer_count > 0);
    if page.reads_texels() {
        text.push_str(wgsl!("baked/footprint"));
        text.push_str(if page.has_walls { wgsl!("baked/blend_beside_walls") } else { wgsl!("baked/blend") });
    }
    if has_sun || has_lamp {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "const MAX_CODE: f32 = {:?};", f32::from(page.max_code));
    }
    if has_sun && page.is_point_sun {
        text.push_str(wgsl!("baked/hard_visibility"));
    }
    if has_lamp || (has_sun && !page.is_point_sun) {
        text.push_str(wgsl!("baked/soft_visibility"));
    }
}

/// Ambient light.
fn push_ambient(text: &mut String, page: &PageVariant) {
    text.push_str(if page.has_backs { wgsl!("ambient/side_two") } else { wgsl!("ambient/side_one") });
    if matches!(page.ambient, AmbientModel::Occlusion | AmbientModel::Bent) {
        text.push_str(wgsl!("ambient/visibility"));
    }
    text.push_str(match page.ambient {
        AmbientModel::Hemisphere => wgsl!("ambient/hemisphere"),
        AmbientModel::Occlusion => wgsl!("ambient/occlusion"),
        AmbientModel::Bent => wgsl!("ambient/bent"),
        AmbientModel::Sky => wgsl!("ambient/sky"),
    });
}

/// The visible share of the lamp.
fn push_lamp(text: &mut String, page: &PageVariant, filter: Filter) {
    if page.lamp_layer_count == 0 {
        text.push_str(wgsl!("lamp/none"));
        return;
    }
    text.push_str(&[wgsl!("lamp/lamp"), wgsl!("lamp/maps"), wgsl!("lamp/baked_texel")].concat());
    text.push_str(match filter {
        Filter::Nearest => wgsl!("lamp/baked_nearest"),
        Filter::Bilinear => wgsl!("lamp/baked_bilinear"),
    });
    text.push_str(wgsl!("lamp/to_lamp"));
    text.push_str(wgsl!("lamp/baked"));
}

fn shading(surface: SurfaceVariant, page: &PageVariant, filter: Filter) -> String {
    let mut text = on_surface(surface, page);
    if page.layer_count() == 0 {
        text.push_str(wgsl!("baked/sun_none"));
        return text;
    }
    text.push_str(wgsl!("baked/sun_maps"));
    text.push_str(&disc_visibility(&page.lanes, page.is_point_sun));
    text.push_str(match filter {
        Filter::Nearest => wgsl!("baked/sun_nearest"),
        Filter::Bilinear => wgsl!("baked/sun_bilinear"),
    });
    text.push_str(if page.is_point_sun { wgsl!("baked/sun_point") } else { wgsl!("baked/sun") });
    text
}

/// A vertex stage with its varyings, and the surface's colour and alpha mask.
pub(crate) fn push_alpha_mask(text: &mut String, surface: SurfaceVariant, vertex: &str) {
    text.push_str(&constants());
    text.push_str(vertex);
    text.push_str(if surface.is_textured {
        wgsl!("surface/texture_color")
    } else {
        wgsl!("surface/texture_color_none")
    });
    text.push_str(if surface.has_vertex_color {
        wgsl!("surface/vertex_color")
    } else {
        wgsl!("surface/vertex_color_none")
    });
    if surface.has_alpha_mask {
        text.push_str(wgsl!("surface/alpha_mask"));
        text.push_str(if surface.is_textured {
            wgsl!("surface/texel_alpha")
        } else {
            wgsl!("surface/texel_alpha_none")
        });
    } else {
        text.push_str(wgsl!("surface/alpha_mask_none"));
    }
}

/// The sum over lanes, written out: their number, layers, weights and chords are constants of the page.
fn disc_visibility(lanes: &[LaneVariant], is_point_sun: bool) -> String {
    let mut text = String::from("fn disc_visibility(texel: vec2<i32>) -> f32 {\n    var visibility = 0.0;\n");
    let mut first = 0;
    for lane in lanes.iter().filter(|lane| lane.layer_count > 0) {
        let end = first + lane.layer_count;
        let (weight, chord) = (lane.weight, lane.chord);
        let (kind, width) =
            if is_point_sun { ("hard", String::new()) } else { ("soft", format!(", frame.width_t * {chord:?}")) };
        let _ = writeln!(
            text,
            "    visibility += {weight:?} * {kind}_visibility(rise_map, fall_map, texel, vec2<i32>({first}, {end}), \
             frame.t{width});"
        );
        first = end;
    }
    text.push_str("    return visibility;\n}\n");
    text
}
